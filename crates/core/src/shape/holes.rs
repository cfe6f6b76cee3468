//! Polygons with holes: the first ring bounds a surface, each other ring removes what lies in it (RFC 7946, 3.1.6).
//!
//! By parity alone a hole beyond the exterior would add its inside, and a hole given twice would remove nothing.
//! Parity still joins holes that are apart, so that a thousand lakes are one polygon, not a thousand areas.

use alloc::vec::Vec;

use super::Polygon;
use crate::error::Error;

/// The most polygons of holes that are searched for room. Holes that overlap more often have one each.
const MOST_SEARCHED: usize = 64;

impl Polygon {
    /// The polygon of the first ring, and the polygons of the other rings, its holes: together they have the points
    /// that lie in any hole. Each ring by itself is a polygon of [`new`](Self::new).
    ///
    /// # Errors
    /// As [`new`](Self::new).
    ///
    /// ```
    /// use strew_core::{Area, Polygon};
    ///
    /// let land = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]];
    /// let lake = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]];
    /// // The lake is there twice.
    /// let (land, lakes) = Polygon::with_holes(&[land, lake, lake])?;
    /// let dry = Area::from(land).without(lakes.into_iter().map(Area::from));
    /// assert!(dry.contains([0.5, 2.0]) && !dry.contains([2.0, 2.0]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn with_holes(rings: &[impl AsRef<[[f64; 2]]>]) -> Result<(Self, Vec<Self>), Error> {
        let (exterior, holes) = rings.split_at(rings.len().min(1));
        let exterior = Self::new(exterior)?;
        let mut all = Vec::with_capacity(holes.len());
        for (which, ring) in (1..).zip(holes) {
            let mut own = Self::empty()?;
            own.add(which, ring.as_ref())?;
            all.push((own.min, own.max, which, ring.as_ref()));
        }
        all.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        let mut groups: Vec<Group> = Vec::new();
        for (min, max, which, ring) in all {
            if min[1] == max[1] {
                continue;
            }
            let mut searched = groups.iter_mut().take(MOST_SEARCHED);
            match searched.find_map(|group| group.add(min, max)) {
                Some(holes) => holes.add(which, ring)?,
                None => {
                    let mut holes = Self::empty()?;
                    holes.add(which, ring)?;
                    let levels = [(min, max)].into();
                    groups.push(Group { holes, levels });
                }
            }
        }
        let groups = groups.into_iter().map(|group| group.holes);
        Ok((exterior, groups.collect()))
    }
}

/// Holes whose boxes are apart, gathered by ascending x.
struct Group {
    holes: Polygon,
    /// The lower and upper corners of the last boxes at each level, by ascending y; no two share a level.
    levels: Vec<([f64; 2], [f64; 2])>,
}

impl Group {
    /// Adds the box of a further hole, if it is apart from all others.
    fn add(&mut self, min: [f64; 2], max: [f64; 2]) -> Option<&mut Polygon> {
        let first = self.levels.partition_point(|(_, top)| top[1] <= min[1]);
        let beside = self.levels.get(first..).unwrap_or_default();
        let beside = beside.iter().take_while(|(low, _)| low[1] < max[1]);
        let mut count = 0;
        for (_, top) in beside {
            // A polygon lacks its upper sides, so boxes that touch are apart.
            if top[0] > min[0] {
                return None;
            }
            count += 1;
        }
        self.levels.splice(first..first + count, [(min, max)]);
        Some(&mut self.holes)
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;
    use crate::shape::Area;

    fn ring() -> impl Strategy<Value = Vec<[f64; 2]>> {
        let corner = (-6i32..=6, -6i32..=6).prop_map(|(x, y)| [f64::from(x), f64::from(y)]);
        let ring = prop::collection::vec(corner, 3..7);
        ring.prop_filter("different", |ring| Polygon::new(&[ring]).is_ok())
    }

    proptest! {
        /// RFC 7946, 3.1.6, with rings as they come: bow-ties, holes beyond the exterior, holes in holes, equal holes.
        #[test]
        fn the_exterior_bounds_and_every_hole_removes(
            mut rings in prop::collection::vec(ring(), 1..8), again in 0usize..8,
            probes in prop::collection::vec((-14i32..=14, -14i32..=14), 60),
        ) {
            let twice = rings[again % rings.len()].clone();
            rings.push(twice);
            let (exterior, holes) = Polygon::with_holes(&rings).expect("valid");
            let area = Area::from(exterior).without(holes.into_iter().map(Area::from));
            for (x, y) in probes {
                let p = [f64::from(x) / 2.0, f64::from(y) / 2.0];
                let is_in = |ring: &Vec<[f64; 2]>| Polygon::new(&[ring]).expect("valid").contains(p);
                let expected = is_in(&rings[0]) && !rings[1..].iter().any(is_in);
                prop_assert_eq!(area.contains(p), expected, "{:?}", p);
            }
        }
    }

    #[test]
    fn holes_that_are_apart_are_one_polygon() {
        let square = |x: f64, y: f64| vec![[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
        let land = vec![[0.0, 0.0], [90.0, 0.0], [90.0, 90.0], [0.0, 90.0]];
        let lakes = (0..900).map(|i| square(f64::from(i % 30) * 2.0, f64::from(i / 30)));
        let mut rings: Vec<_> = [land].into_iter().chain(lakes).collect();
        let groups = |rings: &[Vec<_>]| Polygon::with_holes(rings).expect("valid").1;
        assert_eq!(groups(&rings).len(), 1);
        rings.extend_from_within(1..);
        assert_eq!(groups(&rings).len(), 2);
        rings.push(square(0.5, 0.5));
        assert_eq!(groups(&rings).len(), 3);
    }
}
