//! Areas without the places of some points.
//!
//! A point is left out by a hole in the area that holds its reported coordinates and no others. The area then
//! decides everything, as it does for polygons.

use strew_core::{Area, PointId, PointSet, Polygon};

use super::{Except, Fault, MOST_HOLES};

impl Except {
    /// An area without the places of the points that are left out. `step` is at most a quarter of the distance that
    /// coordinates of two points can have along an axis near the origin, in world units.
    ///
    /// `field` is named in faults, `room` is the number of holes that are left, and is lowered.
    pub fn cut(
        &self,
        field: &str,
        points: &PointSet,
        area: Area,
        step: f64,
        room: &mut usize,
    ) -> Result<Area, Fault> {
        // An area out of reach is refused when it is planned.
        let Ok([columns, rows]) = points.addresses(area.clone()) else {
            return Ok(area);
        };
        let mut rings: Vec<[[f64; 2]; 4]> = vec![];
        for part in &self.parts {
            let ids = &part.plane;
            let start = ids.partition_point(|id| id.x < columns.start);
            let end = ids.partition_point(|id| id.x < columns.end);
            let near = ids[start..end.max(start)].iter();
            let near = near.filter(|id| rows.contains(&id.y));
            let places = near.filter_map(|id| place(points, *id));
            rings.extend(places.take(*room + 1).map(|at| ring(at, step)));
            // A point of two lists would have two holes, of which a polygon makes none.
            rings.sort_unstable_by(|a, b| {
                let by_x = a[0][0].total_cmp(&b[0][0]);
                by_x.then(a[0][1].total_cmp(&b[0][1]))
            });
            rings.dedup();
            if rings.len() > *room {
                let detail = "more of its ids than may be left out at once lie in the region";
                let allowed = format!(
                    "at most {MOST_HOLES} in a region, of all layers: request smaller ones"
                );
                return Err(Fault::new(field, self.names.join(","), detail, allowed));
            }
        }
        *room -= rings.len();
        if rings.is_empty() {
            return Ok(area);
        }
        let holes = Polygon::new(&rings).map_err(|error| {
            Fault::new(field, "", error.to_string(), "points at finite coordinates")
        })?;
        Ok(area.without([holes.into()]))
    }
}

/// The place of a set's point, if the set has it.
fn place(points: &PointSet, id: PointId) -> Option<[f64; 2]> {
    points.point(id).map(|member| member.at())
}

/// The corners of a hole that holds one place.
fn ring([x, y]: [f64; 2], step: f64) -> [[f64; 2]; 4] {
    // Next to zero, numbers are finer than any product of two of them can resolve.
    let beyond = |v: f64| v.next_up().max(v + step);
    let [right, top] = [x, y].map(beyond);
    [[x, y], [right, y], [right, top], [x, top]]
}
