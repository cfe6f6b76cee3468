//! Tests whether places are clear of other sets, which keep clear of further sets themselves: in the plane and in space.
//!
//! # The problem
//!
//! A set that keeps clear of another one loses every point that has a point of the other set nearer than the distance.
//! [`OtherSet::visit`] finds those near a place. A request tests thousands of neighboring places, and would find the same
//! points again and again.
//!
//! # The idea
//!
//! [`Clear`] lists each of the sets once, however many others keep clear of it, and remembers what it made. The world is
//! cut into tiles for each set. The points of a set in a tile are made when enough places in or beside it were tested, and
//! whether one of them stays is decided once, when it first lies near a tested place. So a chain of sets costs the sum of
//! its members, not their product.
//!
//! It is not known beforehand how many places near a tile will be tested. So each looks at the points around itself, until
//! [`OtherSet::searches`] of these have cost as much as the tile would; then the tile is made. It thus costs at most twice
//! the cheaper of both ways, whatever the places are. Numbers are counted, not times, so they are the same on every machine.
//!
//! # Invariants
//!
//! - A test compares squared distances in `f64` on the coordinates of points, whichever way found them. So the answers do
//!   not show which way decided.
//! - Cells and tiles round, but monotonically: the cell of a coordinate never falls where the coordinate grows. So those
//!   between x − `room` and x + `room` hold every point between, however each of them was rounded.
//! - A set holds at most [`most`] points. Beyond that all its tiles are dropped and begin anew.

use alloc::{collections::BTreeMap, vec, vec::Vec};
use core::{array::from_fn, fmt::Debug};

use crate::{
    error::{Error, ErrorKind, number},
    shape::Region,
    stop::Stop,
};

/// A tile without points counts as this many.
const EMPTY: usize = 16;

/// The most mean spacings of another set that may be kept. Hardly a place is farther than one from the next point, so a
/// larger distance would leave nothing.
const MOST_SPACINGS: f64 = 16.0;

/// The most points that are kept of a set; beyond that its tiles are dropped and made again.
const fn most<const D: usize>() -> usize {
    1 << (13 + 2 * D)
}

/// A set that others keep clear of.
pub(crate) trait OtherSet<const D: usize>: Clone + Debug {
    /// The mean spacing of its points at full density.
    fn spacing(&self) -> f64;

    /// The mean spacing of those that it has.
    fn spacing_kept(&self) -> f64;

    /// The sides of tiles.
    fn sides(&self) -> [f64; D];

    /// How many looks at the points within a distance of a place cost as much as a tile.
    fn searches(&self, distance: f64) -> u32;

    /// Whether another one is known to have the same points.
    fn is_same(&self, other: &Self) -> bool;

    /// The sets that it keeps clear of.
    fn clear(&self) -> &[ClearOf<Self>];

    /// Whether it has points out to a distance from a place, and the place is finite.
    fn reaches(&self, at: [f64; D], distance: f64) -> bool;

    /// Visits the places of its points in a box, also of those that are too near others, until one is refused.
    fn visit(&mut self, within: &Region<D>, stop: &Stop, each: impl FnMut([f64; D]) -> bool);
}

/// A distance that points keep from all points of another set.
#[derive(Clone, Debug)]
pub(crate) struct ClearOf<S> {
    set: S,
    distance: f64,
}

impl<S> ClearOf<S> {
    /// A distance in world units.
    pub(crate) fn new<const D: usize>(set: S, distance: f64) -> Result<Self, Error>
    where
        S: OtherSet<D>,
    {
        if distance > 0.0 && distance <= set.spacing() * MOST_SPACINGS {
            Ok(Self { set, distance })
        } else {
            Err(refused(distance, set.spacing()))
        }
    }
}

/// The error of a distance that a set with a spacing is not kept clear of.
pub(crate) fn refused(distance: f64, spacing: f64) -> Error {
    let limit = spacing * MOST_SPACINGS;
    let allowed = alloc::format!(
        "a number above 0 and at most {}, {MOST_SPACINGS} mean spacings of the other set",
        number(limit)
    );
    let error = Error::new(ErrorKind::Clearance, "distance", number(distance), allowed);
    error.with_limit(limit)
}

/// The sets that places keep clear of, and the points of these sets that are known.
#[derive(Clone, Debug)]
pub(crate) struct Clear<S, const D: usize> {
    own: Vec<Edge>,
    /// Each keeps clear of earlier ones alone.
    others: Vec<Other<S, D>>,
    stop: Stop,
}

/// The distance that is kept from another set.
#[derive(Clone, Debug)]
struct Edge {
    other: usize,
    distance: f64,
}

/// A set that others keep clear of.
#[derive(Clone, Debug)]
struct Other<S, const D: usize> {
    set: S,
    edges: Vec<Edge>,
    sides: [f64; D],
    tiles: BTreeMap<[i64; D], Tile<D>>,
    held: usize,
}

#[derive(Clone, Debug)]
enum Tile<const D: usize> {
    /// Its points are not known; the number of places near it that were tested.
    Unknown(u32),
    Known(Points<D>),
}

/// The points of a tile, by the cells of a grid.
#[derive(Clone, Debug)]
struct Points<const D: usize> {
    corner: [f64; D],
    /// The inverse of the side of a cell.
    scale: f64,
    cells: [usize; D],
    /// For each cell where its points begin; then the end. Empty without points.
    starts: Vec<u32>,
    all: Vec<[f64; D]>,
    /// Whether each of them stays, once that is decided.
    stays: Vec<Option<bool>>,
}

impl<S: OtherSet<D>, const D: usize> Clear<S, D> {
    /// Tests of some distances, which end with a flag.
    pub(crate) fn new(clear: &[ClearOf<S>], stop: Stop) -> Self {
        let mut others = Vec::new();
        Self {
            own: list(clear, &mut others),
            others,
            stop,
        }
    }

    /// Whether there is no other set.
    pub(crate) const fn is_empty(&self) -> bool {
        self.own.is_empty()
    }

    /// Whether a place is far enough from all points of the other sets. Meaningless once the flag is raised.
    pub(crate) fn permits(&mut self, at: [f64; D]) -> bool {
        let (others, stop) = (&mut self.others, &self.stop);
        !(self.own.iter()).any(|edge| edge.is_near(others, at, stop))
    }
}

/// The edges to some sets, which are added to the list with those that they keep clear of.
fn list<S: OtherSet<D>, const D: usize>(
    clear: &[ClearOf<S>],
    others: &mut Vec<Other<S, D>>,
) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(clear.len());
    for ClearOf { set, distance } in clear {
        let known = others.iter().position(|other| other.set.is_same(set));
        let other = known.unwrap_or_else(|| {
            let edges = list(set.clear(), others);
            others.push(Other {
                set: set.clone(),
                edges,
                sides: set.sides(),
                tiles: BTreeMap::new(),
                held: 0,
            });
            others.len() - 1
        });
        for side in &mut others[other].sides {
            *side = side.max(*distance);
        }
        edges.push(Edge {
            other,
            distance: *distance,
        });
    }
    edges
}

impl Edge {
    /// Whether a point of the other set is nearer to a place than it may be.
    fn is_near<S: OtherSet<D>, const D: usize>(
        &self,
        others: &mut [Other<S, D>],
        at: [f64; D],
        stop: &Stop,
    ) -> bool {
        let (earlier, rest) = others.split_at_mut(self.other);
        let (other, distance) = (&mut rest[0], self.distance);
        if !other.set.reaches(at, distance) {
            return false;
        }
        // More than rounding takes.
        let room = at.map(|v| distance * (1.0 + 1e-9) + v.abs() * 1e-15);
        let ends = [from_fn(|i| at[i] - room[i]), from_fn(|i| at[i] + room[i])];
        let Other {
            set,
            edges,
            sides,
            tiles,
            held,
        } = other;
        if *held > most::<D>() {
            tiles.clear();
            *held = 0;
        }
        let mut stays = |point| !edges.iter().any(|edge| edge.is_near(earlier, point, stop));
        let [first, last] =
            ends.map(|p: [f64; D]| from_fn(|i| libm::floor(p[i] / sides[i]) as i64));
        let mut place = first;
        loop {
            let tile = tiles.entry(place).or_insert_with(|| {
                *held += EMPTY;
                Tile::Unknown(0)
            });
            if let Tile::Unknown(tested) = tile {
                *tested += 1;
                let is_worth = *tested >= set.searches(distance);
                if !is_worth {
                    break;
                }
                let Some(points) = make(set, place, *sides, stop) else {
                    return false;
                };
                *held += points.all.len();
                *tile = Tile::Known(points);
            }
            if let Tile::Known(points) = tile
                && points.has_near(at, ends, distance, &mut stays)
            {
                return true;
            }
            // The next one, along x first.
            let Some(axis) = (0..D).find(|&axis| place[axis] < last[axis]) else {
                return false;
            };
            place[axis] += 1;
            place[..axis].copy_from_slice(&first[..axis]);
        }
        let mut found = false;
        set.visit(&Region::between(ends[0], ends[1]), stop, |point| {
            found = is_nearer(point, at, distance) && stays(point);
            !found
        });
        found
    }
}

/// The points of a tile. `None` once the flag is raised.
fn make<S: OtherSet<D>, const D: usize>(
    set: &mut S,
    place: [i64; D],
    sides: [f64; D],
    stop: &Stop,
) -> Option<Points<D>> {
    let corner = |by: i64| from_fn(|i| place[i].saturating_add(by) as f64 * sides[i]);
    let region = Region::between(corner(0), corner(1));
    let mut all = Vec::new();
    set.visit(&region, stop, |point| {
        all.push(point);
        true
    });
    let points = Points::new(&region, set.spacing_kept(), &all);
    (!stop.is_raised()).then_some(points)
}

impl<const D: usize> Points<D> {
    /// Points in a box, in cells with about the side `side`.
    fn new(region: &Region<D>, side: f64, unsorted: &[[f64; D]]) -> Self {
        let (corner, scale) = (region.min(), 1.0 / side);
        let across = |axis: usize| (region.max()[axis] - corner[axis]) * scale;
        let cells: [usize; D] = from_fn(|axis| across(axis) as usize + 1);
        let mut points = Self {
            corner,
            scale,
            cells,
            starts: Vec::new(),
            all: vec![[0.0; D]; unsorted.len()],
            stays: vec![None; unsorted.len()],
        };
        if unsorted.is_empty() {
            return points;
        }
        points.starts = vec![0; cells.iter().product::<usize>() + 1];
        for &at in unsorted {
            let cell = points.own(at);
            points.starts[cell] += 1;
        }
        let mut sum = 0;
        for start in &mut points.starts {
            sum += *start;
            *start = sum;
        }
        // Each point moves the end of its cell down, in the end to where the cell begins.
        for &at in unsorted {
            let cell = points.own(at);
            points.starts[cell] -= 1;
            points.all[points.starts[cell] as usize] = at;
        }
        points
    }

    /// The cell of a coordinate, which never falls where the coordinate grows. A float below 0 becomes 0.
    fn cell(&self, axis: usize, v: f64) -> usize {
        (((v - self.corner[axis]) * self.scale) as usize).min(self.cells[axis] - 1)
    }

    /// The number of the cell of a place.
    fn own(&self, at: [f64; D]) -> usize {
        self.number(from_fn(|axis| self.cell(axis, at[axis])))
    }

    fn number(&self, cell: [usize; D]) -> usize {
        (0..D)
            .rev()
            .fold(0, |all, axis| all * self.cells[axis] + cell[axis])
    }

    /// Whether a point that stays is nearer to a place than a distance; all such points lie between two corners.
    fn has_near(
        &mut self,
        at: [f64; D],
        ends: [[f64; D]; 2],
        distance: f64,
        mut stays: impl FnMut([f64; D]) -> bool,
    ) -> bool {
        if self.all.is_empty() {
            return false;
        }
        let [first, last]: [[usize; D]; 2] = ends.map(|p| from_fn(|axis| self.cell(axis, p[axis])));
        let mut row = first;
        loop {
            let from = self.number(row);
            let [from, to] = [from, from + 1 + last[0] - first[0]].map(|i| self.starts[i] as usize);
            let points = self.all[from..to].iter().zip(&mut self.stays[from..to]);
            for (&point, decided) in points {
                if is_nearer(point, at, distance) && *decided.get_or_insert_with(|| stays(point)) {
                    return true;
                }
            }
            let Some(axis) = (1..D).find(|&axis| row[axis] < last[axis]) else {
                return false;
            };
            row[axis] += 1;
            row[..axis].copy_from_slice(&first[..axis]);
        }
    }
}

/// Whether two places are nearer than a distance.
fn is_nearer<const D: usize>(a: [f64; D], b: [f64; D], distance: f64) -> bool {
    let squared = (0..D).map(|axis| (a[axis] - b[axis]) * (a[axis] - b[axis]));
    squared.fold(0.0, |all, part| all + part) < distance * distance
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Points that are given, some of which keep clear of others.
    #[derive(Clone, Debug)]
    struct Given {
        all: Vec<[f64; 2]>,
        clear: Vec<ClearOf<Self>>,
        searches: u32,
        number: u32,
    }

    impl OtherSet<2> for Given {
        fn spacing(&self) -> f64 {
            1.0
        }

        fn spacing_kept(&self) -> f64 {
            0.4
        }

        fn sides(&self) -> [f64; 2] {
            [1.5, 0.5]
        }

        fn searches(&self, _: f64) -> u32 {
            self.searches
        }

        fn is_same(&self, other: &Self) -> bool {
            self.number == other.number
        }

        fn clear(&self) -> &[ClearOf<Self>] {
            &self.clear
        }

        fn reaches(&self, _: [f64; 2], _: f64) -> bool {
            true
        }

        fn visit(&mut self, within: &Region, _: &Stop, each: impl FnMut([f64; 2]) -> bool) {
            let mut inside = self.all.iter().copied().filter(|p| within.contains(*p));
            let _ = inside.all(each);
        }
    }

    fn is_clear(set: &[ClearOf<Given>], at: [f64; 2]) -> bool {
        set.iter().all(|of| {
            let mut near = of
                .set
                .all
                .iter()
                .filter(|p| is_nearer(**p, at, of.distance));
            !near.any(|p| is_clear(&of.set.clear, *p))
        })
    }

    proptest! {
        #[test]
        fn places_are_clear_as_all_pairs_say(
            all in proptest::collection::vec(proptest::collection::vec([0.0..6.0f64, 0.0..6.0f64], 0..60), 3),
            tested in proptest::collection::vec([-1.0..7.0f64, -1.0..7.0f64], 1..60),
            distances in [1e-3..1.2f64, 1e-3..1.2f64, 1e-3..1.2f64, 1e-3..1.2f64], searches in 0..6u32,
            at in prop_oneof![Just([0.0; 2]), [-1e3..1e3f64, -1e3..1e3f64], [-1e13..1e13f64, -1e13..1e13f64]],
        ) {
            let moved = |p: &[f64; 2]| [0, 1].map(|i| at[i] + p[i]);
            let given = |number: usize, clear: &[(&Given, f64)]| Given {
                all: all[number].iter().map(moved).collect(),
                clear: clear.iter().map(|&(set, d)| ClearOf::new(set.clone(), d).expect("near")).collect(),
                searches,
                number: number as u32,
            };
            let [a, b, c, d] = distances;
            let first = given(0, &[]);
            let second = given(1, &[(&first, a)]);
            let third = given(2, &[(&second, b), (&first, c)]);
            let own = [ClearOf::new(third, d).expect("near"), ClearOf::new(first, a).expect("near")];
            let mut clear = Clear::new(&own, Stop::default());
            for place in tested.iter().map(moved) {
                prop_assert_eq!(clear.permits(place), is_clear(&own, place));
            }
        }
    }

    #[test]
    fn tiles_are_made_when_searches_have_cost_as_much_and_dropped_when_they_are_many() {
        let all = vec![[0.2, 0.2]; most::<2>()];
        let set = Given {
            all,
            clear: vec![],
            searches: 3,
            number: 0,
        };
        let own = [ClearOf::new(set, 0.01).expect("near")];
        let mut clear = Clear::new(&own, Stop::default());
        for known in [false, false, true] {
            assert!(clear.permits([0.1, 0.1]));
            let tiles = &clear.others[0].tiles;
            assert_eq!(matches!(tiles[&[0, 0]], Tile::Known(_)), known);
        }
        assert!(!clear.permits([0.2, 0.205]));
        assert!(matches!(clear.others[0].tiles[&[0, 0]], Tile::Unknown(1)));
    }
}
