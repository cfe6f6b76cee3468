//! Rows: the input of all formats with columns.
//!
//! An answer has one part, or one for each layer. [`Rows`] walks them one after another and returns batches of points
//! with the values of every further column. Formats see nothing else, so that a new column or a new kind of part shows
//! in all of them at once.

use std::{ops::Range, sync::Arc, vec};

use strew_core::{Plan, Point, space};
use strew_error::Fault;

use super::{
    part::{Current, Part},
    schema::{Schema, Values},
};
use crate::{
    place::{Coordinates, Height, Located, Mark, Place},
    within::Within,
};

/// Some rows.
#[derive(Clone, Copy, Debug)]
pub struct Batch<'a> {
    /// The points; there is at least one.
    pub points: &'a [Point],
    /// The coordinates as `f32`; empty except for [`Coordinates::Near`].
    pub near: &'a [[f32; 2]],
    /// The heights of points in space; empty in the plane. Their column has the same coordinates.
    pub heights: &'a [Height],
    /// The values of each column of the schema.
    pub columns: &'a [Values],
}

/// One row of a batch.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    /// Id and coordinates.
    pub point: &'a Point,
    /// The height of a point in space.
    pub height: Option<&'a Height>,
    /// The number of the row in the columns.
    pub index: usize,
    /// The values of each column of the schema.
    pub columns: &'a [Values],
}

impl<'a> Batch<'a> {
    /// The rows, one by one.
    pub fn rows(self) -> impl Iterator<Item = Row<'a>> {
        self.rows_in(0..self.points.len())
    }

    /// Some of the rows, one by one.
    pub fn rows_in(self, part: Range<usize>) -> impl Iterator<Item = Row<'a>> {
        let points = self.points[part.clone()].iter();
        points.zip(part).map(move |(point, index)| Row {
            point,
            height: self.heights.get(index),
            index,
            columns: self.columns,
        })
    }
}

/// The rows of an answer, in order, a batch at a time.
#[derive(Debug)]
pub struct Rows {
    schema: Arc<Schema>,
    count: u128,
    coordinates: Coordinates,
    parts: vec::IntoIter<(usize, Part)>,
    current: Option<Current>,
    /// For each part, where coordinates are rounded.
    within: Vec<Within>,
    points: Vec<Point>,
    near: Vec<[f32; 2]>,
    heights: Vec<Height>,
    columns: Vec<Values>,
}

impl Rows {
    /// The rows of some parts, one part after another.
    pub fn new(parts: Vec<Part>, coordinates: Coordinates) -> Self {
        let described: Vec<_> = parts
            .iter()
            .map(|part| (part.layer.as_deref(), part.own_columns()))
            .collect();
        let heights = Part::heights(&parts).map(|bounds| {
            // The bounds are relative to the same place as the column.
            let lowest = coordinates.origin().map_or(0.0, Place::z);
            bounds.map(|z| z - lowest)
        });
        let schema = Schema::with_heights(&described, heights);
        Self {
            columns: schema.empty_values(),
            schema: Arc::new(schema),
            count: parts.iter().map(|part| part.plan.count()).sum(),
            coordinates,
            parts: parts
                .into_iter()
                .enumerate()
                .collect::<Vec<_>>()
                .into_iter(),
            current: None,
            within: vec![],
            points: vec![],
            near: vec![],
            heights: vec![],
        }
    }

    /// The rows for a format that rounds coordinates: those that would be rounded out of the box around the points of
    /// their part are moved to the nearest decimal within. Call it before the first batch.
    ///
    /// # Errors
    /// A fault of `decimals` if there is no such number.
    pub(super) fn rounded(mut self, decimals: u8) -> Result<Self, Fault> {
        let origin = self.coordinates.origin().unwrap_or(Place::Plane([0.0; 2]));
        let within = |part: &Part| Within::new(&*part.plan, origin, decimals);
        self.within = self.parts().map(within).collect::<Result<_, _>>()?;
        Ok(self)
    }

    /// The columns besides id, x and y.
    pub const fn schema(&self) -> &Arc<Schema> {
        &self.schema
    }

    /// The number of rows, including those that were returned already.
    pub const fn count(&self) -> u128 {
        self.count
    }

    /// The parts that are not begun; all of them before the first batch.
    pub(super) fn parts(&self) -> impl Iterator<Item = &Part> {
        self.parts.as_slice().iter().map(|(_, part)| part)
    }

    /// The rows from the beginning. Call it before the first batch.
    pub(super) fn again(&self) -> Self {
        Self::new(self.parts().cloned().collect(), self.coordinates)
    }

    /// The origin and the precision of the coordinates.
    pub const fn coordinates(&self) -> Coordinates {
        self.coordinates
    }

    /// The only plan of the plane, if its coordinates, as the kernel makes them, are the whole answer. Call it before the first
    /// batch.
    pub fn plain_plan(&self) -> Option<&Plan> {
        let [(_, part)] = self.parts.as_slice() else {
            return None;
        };
        let plan = part.plan.plane()?;
        let as_made = match self.coordinates {
            Coordinates::World => true,
            Coordinates::Relative(_) => false,
            Coordinates::Near(origin) => origin == Place::Plane(plan.origin()),
        };
        (as_made && self.schema.columns().is_empty()).then_some(plan)
    }

    /// The only plan in space, if its coordinates, as the kernel makes them, are the whole answer. Call it before the
    /// first batch.
    pub(super) fn plain_volume(&self) -> Option<&space::Plan> {
        let [(_, part)] = self.parts.as_slice() else {
            return None;
        };
        let plan = part.plan.space()?;
        let as_made = match self.coordinates {
            Coordinates::World => true,
            Coordinates::Relative(_) => false,
            Coordinates::Near(origin) => origin == Place::Space(plan.origin()),
        };
        // Their heights are the one column.
        (as_made && self.schema.columns().len() == 1).then_some(plan)
    }

    /// The number of the part of the last rows, and the place after them in it, if it goes on.
    pub fn mark(&self) -> Option<(usize, Option<Mark>)> {
        let current = self.current.as_ref()?;
        Some((current.number, current.blocks.mark()))
    }

    /// The next rows, at most `most` (and at least one); `None` after the last. All rows of a batch are of one part.
    pub fn next(&mut self, most: usize) -> Option<Batch<'_>> {
        let most = most.max(1);
        if self.points.len() < most {
            let left = usize::try_from(self.count).unwrap_or(usize::MAX).max(1);
            self.points.resize(most.min(left), Point::default());
        }
        let most = most.min(self.points.len());
        let filled = loop {
            if let Some(current) = &mut self.current {
                let filled = current
                    .blocks
                    .fill(&mut self.points[..most], &mut self.heights);
                if filled > 0 {
                    break filled;
                }
            }
            let (number, part) = self.parts.next()?;
            self.columns = self.schema.empty_values();
            self.current = Some(Current::new(number, part, &self.schema, self.coordinates));
        };
        let current = self.current.as_mut()?;
        let room = self.points.len();
        let points = &mut self.points[..filled];
        let heights = &mut self.heights[..];
        let within = self.within.get(current.number);
        current.fill_attributes(Located { points, heights });
        match self.coordinates {
            Coordinates::World => {}
            Coordinates::Relative(origin) => current.move_to(origin, points, heights),
            Coordinates::Near(origin) => {
                self.near.resize(room, [0.0; 2]);
                current.fill_near(points, heights, origin, &mut self.near[..filled]);
            }
        }
        if let Some(within) = within {
            for point in points.iter_mut() {
                (point.x, point.y) = (within.apply(0, point.x), within.apply(1, point.y));
            }
            for height in heights.iter_mut() {
                height.z = within.apply(2, height.z);
            }
        }
        current.fill_columns(Located { points, heights }, &mut self.columns);
        Some(Batch {
            points: &self.points[..filled],
            near: self.near.get(..filled).unwrap_or_default(),
            heights: &self.heights,
            columns: &self.columns,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LAYER, sample_rows::parts, schema::Kind};

    /// (layer, id, x, y, angle, variant), whatever the size of batches.
    type Told = Vec<(String, String, [f64; 2], [f32; 2], Option<f64>, String)>;

    fn told(coordinates: Coordinates, most: usize) -> Told {
        let mut rows = Rows::new(parts(), coordinates);
        let schema = rows.schema().clone();
        let names: Vec<&str> = schema.columns().iter().map(|c| &*c.name).collect();
        assert_eq!(names, [LAYER, "angle", "variant"]);
        let name = |column: usize, row: Row<'_>| match &schema.columns()[column].kind {
            Kind::Dictionary(names) => {
                let index = row.columns[column].index(row.index).expect("never missing");
                names[index as usize].clone()
            }
            Kind::Number => panic!("{column} is no dictionary"),
        };
        let mut told = vec![];
        while let Some(batch) = rows.next(most) {
            assert!((1..=most).contains(&batch.points.len()));
            for row in batch.rows() {
                told.push((
                    name(0, row),
                    row.point.id.to_string(),
                    [row.point.x, row.point.y],
                    batch.near.get(row.index).copied().unwrap_or_default(),
                    row.columns[1].number(row.index),
                    name(2, row),
                ));
            }
        }
        assert_eq!(told.len() as u128, rows.count());
        told
    }

    #[test]
    fn parts_come_one_after_another_with_their_own_values() {
        let world = told(Coordinates::World, 64);
        for most in [1, 7, 100_000] {
            assert_eq!(told(Coordinates::World, most), world, "at most {most}");
        }
        let trees = world.iter().take_while(|row| row.0 == "trees").count();
        let [all_trees, all_rocks] = [0, 1].map(|i| parts()[i].plan.count());
        assert_eq!(trees as u128, all_trees);
        assert_eq!((world.len() - trees) as u128, all_rocks);
        for (layer, id, _, _, angle, variant) in &world {
            let (x, y) = id.split_once(':').expect("an id");
            let [x, y] = [x, y].map(|text| text.parse::<i64>().expect("an integer"));
            let expected = match (&**layer, y.rem_euclid(2), y.rem_euclid(3)) {
                ("trees", 0, _) | ("rocks", _, 1) => "oak",
                ("trees", ..) => "birch",
                (_, _, 0) => "grey, \"old\"",
                _ => "flint",
            };
            assert_eq!(variant, expected, "{layer} {id}");
            assert_eq!(*angle, (layer == "trees").then_some(x as f64 / 2.0));
        }
    }

    #[test]
    fn coordinates_relative_to_a_point_stay_inside_the_region() {
        let world = told(Coordinates::World, 100);
        let origin = [-10.0, 5.0];
        let moved = Place::Plane(origin);
        let relative = told(Coordinates::Relative(moved), 100);
        let near = told(Coordinates::Near(moved), 100);
        for ((world, relative), near) in world.iter().zip(&relative).zip(&near) {
            for axis in 0..2 {
                let expected = world.2[axis] - origin[axis];
                assert!((relative.2[axis] - expected).abs() < 1e-14);
                assert!((f64::from(near.3[axis]) - expected).abs() < 4e-6);
                assert!(f64::from(near.3[axis]) < [40.0, 35.5][axis]);
            }
        }
        // The first layer's own corner is the origin: its numbers are the kernel's.
        let parts = parts();
        let plan = parts[0].plan.plane().expect("of the plane");
        let mut kernel = vec![[0.0; 2]; usize::try_from(plan.count()).expect("few")];
        plan.blocks_f32().fill(&mut kernel);
        let near: Vec<_> = near.iter().take(kernel.len()).map(|row| row.3).collect();
        assert_eq!(near, kernel);
    }
}
