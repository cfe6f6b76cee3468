//! Distances to points, lines and polygons.

use alloc::{format, vec::Vec};

use super::{
    definition::Canon,
    scale::{check_numbers, unit},
};
use crate::{
    error::{Error, ErrorKind},
    shape::Region,
};

/// The points, lines and outlines from which a field of [distance](super::FieldSpec::distance) is measured. They have
/// at most [`MAX_VERTICES`](super::FieldSpec::MAX_VERTICES) vertices in all.
///
/// ```
/// use strew_core::{Field, field::{FieldSpec, Marks}};
///
/// // A forest keeps 5 off a road and is full from 20 on.
/// let road = Marks::Lines(vec![vec![[0.0, 0.0], [100.0, 0.0], [200.0, 50.0]]]);
/// let forest = FieldSpec::distance(road, [5.0, 20.0], [0.0, 1.0])?;
/// assert_eq!([3.0, 12.5, 99.0].map(|y| forest.share([50.0, y])), [0.0, 0.5, 1.0]);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Marks {
    /// Distances to the nearest point.
    Points(Vec<[f64; 2]>),
    /// Distances to the nearest line; a line is at least two vertices.
    Lines(Vec<Vec<[f64; 2]>>),
    /// Distances to the nearest side of a ring, below 0 inside. A place is inside if a ray from it crosses
    /// the rings an odd number of times, so rings within rings are holes. A ring is at least three
    /// vertices; the last may repeat the first.
    Polygons(Vec<Vec<[f64; 2]>>),
}

impl Marks {
    /// The number of vertices.
    #[must_use]
    pub fn vertices(&self) -> usize {
        match self {
            Self::Points(all) => all.len(),
            Self::Lines(all) | Self::Polygons(all) => all.iter().map(Vec::len).sum(),
        }
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        let (name, least, all) = match self {
            Self::Points(all) => {
                if all.is_empty() {
                    return Err(Error::new(
                        ErrorKind::Field,
                        "points",
                        "empty",
                        "at least one",
                    ));
                }
                return check_numbers("points", all.as_flattened());
            }
            Self::Lines(all) => ("lines", 2, all),
            Self::Polygons(all) => ("polygons", 3, all),
        };
        if all.is_empty() {
            return Err(Error::new(ErrorKind::Field, name, "empty", "at least one"));
        }
        for (i, part) in all.iter().enumerate() {
            if part.len() < least {
                let value = format!("{} vertices in number {i}", part.len());
                let allowed = format!("at least {least} in each");
                return Err(Error::new(ErrorKind::Field, name, value, allowed));
            }
            check_numbers(name, part.as_flattened())?;
        }
        Ok(())
    }

    pub(super) fn describe(&self, canon: &mut Canon) {
        match self {
            Self::Points(all) => {
                canon.number(0);
                canon.places(all);
            }
            Self::Lines(all) | Self::Polygons(all) => {
                canon.number(if matches!(self, Self::Lines(_)) { 1 } else { 2 });
                canon.number(all.len() as u64);
                all.iter().for_each(|part| canon.places(part));
            }
        }
    }
}

/// A straight piece between two places, which may be equal.
#[derive(Clone, Copy, Debug)]
struct Side {
    a: [f64; 2],
    b: [f64; 2],
}

/// The most sides of a leaf.
const LEAF: usize = 4;

/// More than the depth of the tree.
const STACK: usize = 40;

/// A part of the sides and the box around them.
#[derive(Clone, Copy, Debug)]
struct Node {
    min: [f64; 2],
    max: [f64; 2],
    /// The first of its sides, and their number; or the second of its two children, and 0. The first
    /// child comes right after the node.
    first: u32,
    count: u32,
}

/// Marks, ready for looking up distances: a tree of boxes.
#[derive(Clone, Debug)]
pub(super) struct Measure {
    sides: Vec<Side>,
    nodes: Vec<Node>,
    /// Whether places can be inside.
    is_signed: bool,
    /// An allowance for rounding, added to squares before boxes are left out.
    slack: f64,
}

impl Measure {
    pub(super) fn new(marks: &Marks) -> Self {
        let mut sides = Vec::with_capacity(marks.vertices());
        match marks {
            Marks::Points(all) => sides.extend(all.iter().map(|&a| Side { a, b: a })),
            Marks::Lines(all) => {
                let lines = all.iter().flat_map(|line| line.windows(2));
                sides.extend(lines.map(|w| Side { a: w[0], b: w[1] }));
            }
            Marks::Polygons(all) => {
                for ring in all {
                    let next = ring.iter().cycle().skip(1);
                    sides.extend(ring.iter().zip(next).map(|(&a, &b)| Side { a, b }));
                }
            }
        }
        let most = sides
            .iter()
            .flat_map(|side| [side.a, side.b])
            .flatten()
            .fold(0.0, |most: f64, v| most.max(v.abs()));
        let mut nodes = Vec::new();
        let number = sides.len();
        build(&mut sides, 0, number, &mut nodes);
        Self {
            sides,
            nodes,
            is_signed: matches!(marks, Marks::Polygons(_)),
            slack: 1e-15 * most * most,
        }
    }

    /// The distance of a place, below 0 inside of polygons.
    pub(super) fn distance(&self, at: [f64; 2]) -> f64 {
        let distance = libm::sqrt(self.squared(at));
        if self.is_signed && self.is_inside(at) {
            -distance
        } else {
            distance
        }
    }

    /// The number of nodes and sides that a distance looks at.
    pub(super) fn looks(&self, at: [f64; 2]) -> usize {
        let mut looks = 0;
        self.nearest(at, |more| looks += more);
        looks
    }

    fn squared(&self, at: [f64; 2]) -> f64 {
        self.nearest(at, |_| {})
    }

    /// The squared distance; `looked` is called with numbers of nodes and sides that were looked at.
    #[inline(always)]
    fn nearest(&self, at: [f64; 2], mut looked: impl FnMut(usize)) -> f64 {
        let mut best = f64::INFINITY;
        let mut open = [0u32; STACK];
        let mut number = 1;
        while number > 0 {
            number -= 1;
            let index = open[number] as usize;
            let node = &self.nodes[index];
            looked(1 + node.count as usize);
            // Never leaves out what is nearest, so the tree does not matter to the result.
            if node.squared(at) > best * (1.0 + 1e-9) + self.slack {
                continue;
            }
            if node.count > 0 {
                for side in &self.sides[node.first as usize..][..node.count as usize] {
                    best = best.min(side.squared(at));
                }
                continue;
            }
            let children = [index + 1, node.first as usize];
            let [one, two] = children.map(|child| self.nodes[child].squared(at));
            let [near, far] = if one <= two { [0, 1] } else { [1, 0] };
            open[number] = children[far] as u32;
            open[number + 1] = children[near] as u32;
            number += 2;
        }
        best
    }

    fn is_inside(&self, at: [f64; 2]) -> bool {
        let mut crossings = 0u32;
        let mut open = [0u32; STACK];
        let mut number = 1;
        while number > 0 {
            number -= 1;
            let index = open[number] as usize;
            let node = &self.nodes[index];
            if at[1] < node.min[1] || node.max[1] < at[1] || node.max[0] < at[0] {
                continue;
            }
            if node.count > 0 {
                let sides = &self.sides[node.first as usize..][..node.count as usize];
                crossings += sides.iter().filter(|side| side.crosses(at)).count() as u32;
                continue;
            }
            open[number] = (index + 1) as u32;
            open[number + 1] = node.first;
            number += 2;
        }
        crossings % 2 == 1
    }

    /// Bounds of the distance over a box: it changes no faster than the place.
    pub(super) fn bounds(&self, within: &Region) -> [f64; 2] {
        let (min, max) = (within.min(), within.max());
        let center = [0, 1].map(|i| 0.5 * min[i] + 0.5 * max[i]);
        let half = [0, 1].map(|i| max[i] - center[i]);
        let half = libm::sqrt(half[0] * half[0] + half[1] * half[1]);
        let distance = self.distance(center);
        let size = center[0].abs().max(center[1].abs()) + distance.abs() + half;
        let room = 1e-12 * size + 2.0 * libm::sqrt(self.slack) * 1e-6;
        [distance - half - room, distance + half + room]
    }
}

impl Node {
    #[inline(always)]
    fn squared(&self, at: [f64; 2]) -> f64 {
        let [x, y] = [0, 1].map(|i| (self.min[i] - at[i]).max(at[i] - self.max[i]).max(0.0));
        x * x + y * y
    }
}

impl Side {
    #[inline(always)]
    fn squared(&self, [x, y]: [f64; 2]) -> f64 {
        let ([ax, ay], [bx, by]) = (self.a, self.b);
        let (dx, dy) = (bx - ax, by - ay);
        let square = dx * dx + dy * dy;
        let along = (x - ax) * dx + (y - ay) * dy;
        let t = if square > 0.0 {
            unit(along / square)
        } else {
            0.0
        };
        let (x, y) = (x - (ax + t * dx), y - (ay + t * dy));
        x * x + y * y
    }

    /// Whether a ray from a place to greater x crosses the side.
    #[inline(always)]
    fn crosses(&self, [x, y]: [f64; 2]) -> bool {
        let (low, high) = if self.a[1] <= self.b[1] {
            (self.a, self.b)
        } else {
            (self.b, self.a)
        };
        if y < low[1] || high[1] <= y || low[0].max(high[0]) < x {
            return false;
        }
        x < low[0].min(high[0])
            || (x - low[0]) * (high[1] - low[1]) < (high[0] - low[0]) * (y - low[1])
    }
}

/// Builds the node of some sides and those below it.
fn build(sides: &mut [Side], first: usize, end: usize, nodes: &mut Vec<Node>) {
    let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for place in sides[first..end].iter().flat_map(|side| [side.a, side.b]) {
        for i in 0..2 {
            min[i] = min[i].min(place[i]);
            max[i] = max[i].max(place[i]);
        }
    }
    let at = nodes.len();
    let count = end - first;
    nodes.push(Node {
        min,
        max,
        first: first as u32,
        count: if count <= LEAF { count as u32 } else { 0 },
    });
    if count <= LEAF {
        return;
    }
    let axis = usize::from(max[1] - min[1] > max[0] - min[0]);
    let middle = first + count / 2;
    let key = |side: &Side| 0.5 * side.a[axis] + 0.5 * side.b[axis];
    sides[first..end].select_nth_unstable_by(count / 2, |a, b| key(a).total_cmp(&key(b)));
    build(sides, first, middle, nodes);
    nodes[at].first = nodes.len() as u32;
    build(sides, middle, end, nodes);
}
