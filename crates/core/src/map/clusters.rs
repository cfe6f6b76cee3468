//! Clusters: the connected groups of pattern points, their shapes, and where each shape is in index space.
//!
//! Two points are neighbors if they are at most a distance apart. Whether p + o is a point depends on the
//! index of p alone, so the cluster of p does, too: it is the same for all points of a block, if the map is
//! wide enough to see all of the cluster and the empty places around it. One search for each block finds all
//! shapes, and the areas of the blocks are the exact densities.

use alloc::{
    collections::{BTreeMap, BTreeSet},
    vec,
    vec::Vec,
};

use super::{
    MAX_RADIUS, Map, Shape,
    shape::{from_first, upright},
};
use crate::{
    error::{Error, ErrorKind, number},
    pattern::{Alpha, IndexOrigin, Pattern},
    stop::Stop,
};

/// The connected clusters of a pattern under a neighbor distance, exact for clusters up to a stated number
/// of points.
///
/// They are those of α as it is [held](Alpha). At a fraction whose denominator is no power of two, rounding adds
/// shapes of no weight, with less than one point in 10¹², where a neighbor is on the very edge of the set region.
///
/// ```
/// use strew_core::map::Clusters;
///
/// // Neighbors a knight's move apart.
/// let clusters = Clusters::new("(5-sqrt(3))/2".parse()?, 5f64.sqrt(), 16)?;
/// let (shapes, larger) = (clusters.shapes(), clusters.larger_share());
/// // Some points stand alone, and every point belongs to one cluster.
/// assert_eq!(shapes[0].points(), [(0, 0)]);
/// let share: f64 = shapes.iter().map(|shape| shape.share_of_points()).sum();
/// assert!((share + larger - 1.0).abs() < 1e-12);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Clusters {
    map: Map,
    most: usize,
    shapes: Vec<Shape>,
    classes: usize,
    /// The shape of the cluster around a point of each block, or [`LARGER`].
    of_block: Vec<u32>,
}

/// The number of blocks whose clusters have more points than stated.
const LARGER: u32 = u32::MAX;

impl Clusters {
    /// The largest neighbor distance, in grid units.
    pub const MAX_DISTANCE: f64 = 16.0;
    /// The largest size of clusters that can be distinguished, in points.
    pub const MAX_POINTS: usize = 64;

    /// The clusters of points that are at most `distance` grid units from a neighbor, from 1 to
    /// [`MAX_DISTANCE`](Self::MAX_DISTANCE). Clusters of more than `most` points are counted as larger ones.
    /// The time grows with the number of blocks that the clusters see, some 10⁴ for `most` = 16.
    ///
    /// # Errors
    /// [`ErrorKind::Clusters`] if `distance` is out of range, unless 1 ≤ `most` ≤ [`MAX_POINTS`](Self::MAX_POINTS), and
    /// if clusters of that number of points reach farther than a map of half-width [`MAX_RADIUS`](super::MAX_RADIUS).
    pub fn new(alpha: Alpha, distance: f64, most: usize) -> Result<Self, Error> {
        Self::until(alpha, distance, most, &Stop::default())
    }

    /// The clusters, unless the flag is raised before they are found.
    pub(crate) fn until(
        alpha: Alpha,
        distance: f64,
        most: usize,
        stop: &Stop,
    ) -> Result<Self, Error> {
        if !(1.0..=Self::MAX_DISTANCE).contains(&distance) {
            let allowed = alloc::format!("a number from 1 to {} grid units", Self::MAX_DISTANCE);
            let value = number(distance);
            return Err(Error::new(ErrorKind::Clusters, "distance", value, allowed));
        }
        if !(1..=Self::MAX_POINTS).contains(&most) {
            let allowed = alloc::format!("an integer from 1 to {}", Self::MAX_POINTS);
            return Err(Error::new(ErrorKind::Clusters, "most", most, allowed));
        }
        let offsets = disk(distance);
        let mut radius = libm::ceil(distance) as u32;
        loop {
            let map = Map::new(alpha, radius)?;
            let n = map.intervals();
            let mut reach = 0;
            // Blocks share their shapes: a list for each block would not fit into memory.
            let mut known: BTreeMap<Vec<(i64, i64)>, u32> = BTreeMap::new();
            let mut found = vec![];
            for block in 0..n * n {
                if stop.is_raised() {
                    let error = Error::new(ErrorKind::Stopped, "the search", "not finished", "");
                    return Err(error.because("stopped"));
                }
                let block = [block % n, block / n];
                let points = cluster(&map, block, &offsets, most, &mut reach);
                let next = known.len() as u32;
                found.push(points.map_or(LARGER, |points| *known.entry(points).or_insert(next)));
            }
            if reach <= i64::from(radius) {
                return Ok(Self::of_found(map, most, known, &found));
            }
            radius = u32::try_from(reach).unwrap_or(u32::MAX);
            if radius > MAX_RADIUS {
                let allowed = alloc::format!(
                    "a number of points whose clusters reach at most {MAX_RADIUS} grid units"
                );
                return Err(Error::new(ErrorKind::Clusters, "most", most, allowed));
            }
        }
    }

    /// The clusters by block, put in order.
    fn of_found(
        map: Map,
        most: usize,
        known: BTreeMap<Vec<(i64, i64)>, u32>,
        found: &[u32],
    ) -> Self {
        let n = map.intervals();
        let length = |i: usize| {
            let interval = map.interval(i);
            u128::from(interval.end - interval.start)
        };
        // The areas of the blocks of all points of the clusters.
        let mut areas = vec![0u128; known.len()];
        for (block, &shape) in found.iter().enumerate() {
            if let Some(area) = areas.get_mut(shape as usize) {
                *area += length(block % n) * length(block / n);
            }
        }
        let mut shapes: Vec<Shape> = vec![Shape::none(map.alpha()); known.len()];
        for (points, number) in known {
            let (i, count) = (number as usize, points.len() as u128);
            // Each point of a cluster sees all of it, so its blocks have the area of those of the first.
            shapes[i].area = areas[i] / count;
            shapes[i].points = points;
        }
        let leads: Vec<_> = shapes.iter().map(|shape| upright(&shape.points)).collect();
        let mut order: Vec<usize> = (0..shapes.len()).collect();
        order.sort_by(|&a, &b| {
            let (left, right) = (&shapes[a], &shapes[b]);
            (left.points.len().cmp(&right.points.len()))
                .then(right.area.cmp(&left.area))
                .then(leads[a].cmp(&leads[b]))
                .then(left.points.cmp(&right.points))
        });
        let mut classes = 0;
        for (i, &at) in order.iter().enumerate() {
            if i > 0 && leads[order[i - 1]] != leads[at] {
                classes += 1;
            }
            shapes[at].class = classes;
        }
        let mut numbers = vec![LARGER; shapes.len()];
        for (number, &at) in (0..).zip(&order) {
            numbers[at] = number;
        }
        let shapes: Vec<Shape> = order.into_iter().map(|at| shapes[at].clone()).collect();
        let of_block = found
            .iter()
            .map(|&shape| numbers.get(shape as usize).copied().unwrap_or(LARGER))
            .collect();
        Self {
            most,
            classes: if shapes.is_empty() { 0 } else { classes + 1 },
            of_block,
            shapes,
            map,
        }
    }

    /// The shapes of at most [`most`](Self::most) points, by the number of their points and then by density,
    /// densest first. Shapes of one [class](Shape::class) follow one another.
    #[must_use]
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The number of shapes up to the symmetries of the square.
    #[must_use]
    pub const fn classes(&self) -> usize {
        self.classes
    }

    /// The largest size of clusters that are distinguished, in points.
    #[must_use]
    pub const fn most(&self) -> usize {
        self.most
    }

    /// The share of points in clusters of more than [`most`](Self::most) points, from 0 to 1. It is 1 where
    /// the neighbor distance joins the whole pattern.
    #[must_use]
    pub fn larger_share(&self) -> f64 {
        let side = u128::from(self.map.alpha().set_side());
        let area = |shape: &Shape| shape.area * shape.points.len() as u128;
        let counted: u128 = self.shapes.iter().map(area).sum();
        (side * side - counted) as f64 / (side * side) as f64
    }

    /// The map that separates the shapes: each block belongs to one shape.
    #[must_use]
    pub const fn map(&self) -> &Map {
        &self.map
    }

    /// The position in [`shapes`](Self::shapes) of the shape of the cluster around a point of a block, given
    /// as its intervals of dX and dY; `None` for larger clusters and for blocks that the map does not have.
    #[must_use]
    pub fn shape_of(&self, [x, y]: [usize; 2]) -> Option<usize> {
        let n = self.map.intervals();
        let shape = (x < n && y < n).then(|| self.of_block[y * n + x])?;
        (shape != LARGER).then_some(shape as usize)
    }
}

/// The offsets within a distance of 0, which is not among them.
fn disk(distance: f64) -> Vec<(i64, i64)> {
    // Roots of integers are rounded in `f64`, and their squares may end below the integer.
    let squared = libm::floor(distance * distance * (1.0 + 1e-12)) as i64;
    let reach = libm::floor(distance) as i64;
    (-reach..=reach)
        .flat_map(|y| (-reach..=reach).map(move |x| (x, y)))
        .filter(|&(x, y)| (x, y) != (0, 0) && x * x + y * y <= squared)
        .collect()
}

/// The cluster around a point of a block, moved so that its first point is the origin, or `None` if it has
/// more than `most` points. `reach` rises to the largest coordinate that was looked at.
fn cluster(
    map: &Map,
    [x, y]: [usize; 2],
    offsets: &[(i64, i64)],
    most: usize,
    reach: &mut i64,
) -> Option<Vec<(i64, i64)>> {
    let origin = IndexOrigin {
        x: map.interval(x).start,
        y: map.interval(y).start,
    };
    let pattern = Pattern::with_origin(map.alpha(), origin);
    let mut points = BTreeSet::from([(0, 0)]);
    let mut open = vec![(0i64, 0i64)];
    while let Some((y, x)) = open.pop() {
        for &(i, j) in offsets {
            let (x, y) = (x + i, y + j);
            *reach = x.abs().max(y.abs()).max(*reach);
            if pattern.contains(x, y) && points.insert((y, x)) {
                if points.len() > most {
                    return None;
                }
                open.push((y, x));
            }
        }
    }
    Some(from_first(
        points.into_iter().map(|(y, x)| (x, y)).collect(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALPHAS: [&str; 5] = ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2", "1.3", "7/4"];

    fn clusters(alpha: &str, distance: f64, most: usize) -> Clusters {
        Clusters::new(alpha.parse().expect("valid"), distance, most).expect("in range")
    }

    #[test]
    fn clusters_of_a_window_are_those_of_their_blocks() {
        for (alpha, distance) in [
            ("(5-sqrt(3))/2", 5f64.sqrt()),
            ("(5-sqrt(3))/2", 3.2),
            ("sqrt(3)", 2f64.sqrt()),
            ("(1+sqrt(5))/2", 3.0),
            ("1.3", 5.0),
        ] {
            let found = clusters(alpha, distance, 24);
            let pattern = Pattern::new(alpha.parse().expect("valid"));
            let limit = libm::floor(distance * distance + 1e-9) as i64;
            // All clusters of the window, without index space.
            let all: Vec<(i64, i64)> = (-90..90)
                .flat_map(|y| (-90..90).map(move |x| (x, y)))
                .filter(|&(x, y)| pattern.contains(x, y))
                .collect();
            let mut open: BTreeSet<(i64, i64)> = all.iter().copied().collect();
            let mut compared = 0;
            while let Some(first) = open.pop_first() {
                let (mut members, mut next) = (vec![first], 0);
                while next < members.len() {
                    let (x, y) = members[next];
                    next += 1;
                    let near = |&(a, b): &(i64, i64)| (a - x).pow(2) + (b - y).pow(2) <= limit;
                    let here: Vec<_> = open
                        .range((x - 6, -99)..=(x + 6, 99))
                        .copied()
                        .filter(near)
                        .collect();
                    for point in here {
                        open.remove(&point);
                        members.push(point);
                    }
                }
                let inside = |&(x, y): &(i64, i64)| x.abs().max(y.abs()) < 80;
                if !members.iter().all(inside) {
                    continue;
                }
                for &(x, y) in &members {
                    let (dx, dy) = pattern.index(x, y);
                    let block =
                        [dx, dy].map(|index| found.map().interval_of(index).expect("a point"));
                    let expected = (members.len() <= 24).then(|| from_first(members.clone()));
                    let shape = found
                        .shape_of(block)
                        .map(|at| found.shapes()[at].points.clone());
                    assert_eq!(shape, expected, "{alpha} {distance} {x}:{y}");
                    compared += 1;
                }
            }
            assert!(
                compared > 0 || found.larger_share() > 0.9,
                "{alpha} {distance}"
            );
        }
    }

    #[test]
    fn areas_add_up_exactly_and_classes_have_equal_densities() {
        for alpha in ALPHAS {
            for distance in [1.0, 2f64.sqrt(), 2.0, 5f64.sqrt(), 3.0, 10f64.sqrt()] {
                let found = clusters(alpha, distance, 16);
                let n = found.map().intervals();
                let length = |i: usize| found.map().interval(i).end - found.map().interval(i).start;
                for (number, shape) in found.shapes().iter().enumerate() {
                    let blocks =
                        (0..n * n).filter(|b| found.shape_of([b % n, b / n]) == Some(number));
                    let area: u128 = blocks
                        .map(|b| u128::from(length(b % n)) * u128::from(length(b / n)))
                        .sum();
                    assert_eq!(
                        area,
                        shape.area() * shape.points().len() as u128,
                        "{alpha} {shape:?}"
                    );
                }
                for pair in found.shapes().windows(2) {
                    let same = upright(&pair[0].points) == upright(&pair[1].points);
                    assert_eq!(
                        same,
                        pair[0].class() == pair[1].class(),
                        "{alpha} {distance}"
                    );
                    assert!(
                        !same || pair[0].area() == pair[1].area(),
                        "{alpha} {distance}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_lone_shape_has_the_density_of_its_arrangement() {
        let mut compared = 0;
        for alpha in ALPHAS {
            for distance in [1.0, 2f64.sqrt(), 2.0, 5f64.sqrt(), 8f64.sqrt()] {
                let found = clusters(alpha, distance, 64);
                // If no cluster has more points, the points of a largest one are no part of others.
                let largest = found
                    .shapes()
                    .iter()
                    .map(|shape| shape.points().len())
                    .max();
                let lone = |shape: &&Shape| Some(shape.points().len()) == largest;
                for shape in found.shapes().iter().filter(lone) {
                    if found.larger_share() == 0.0 {
                        assert_eq!(shape.area(), shape.arrangement().area());
                        compared += 1;
                    }
                }
            }
        }
        assert!(compared > 8, "{compared}");
    }

    #[test]
    fn wrong_input_is_refused() {
        let alpha = "sqrt(3)".parse().expect("valid");
        for (distance, most, field) in [
            (f64::NAN, 4, "distance"),
            (0.9, 4, "distance"),
            (16.1, 4, "distance"),
            (2.0, 0, "most"),
            (2.0, 65, "most"),
        ] {
            let error = Clusters::new(alpha, distance, most).expect_err(field);
            assert_eq!((error.kind(), error.field()), (ErrorKind::Clusters, field));
        }
    }
}
