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
//! - The tiles of a set hold about as much as [`most`] points. Beyond that all of them are dropped and begin anew.

use alloc::{collections::BTreeMap, vec::Vec};
use core::{array::from_fn, fmt::Debug};

use super::tile::{Grid, Points, is_nearer};
use crate::{
    error::{Error, ErrorKind, number},
    shape::Region,
    stop::Stop,
};

/// A tile without points counts as this many.
const EMPTY: usize = 16;

/// The most mean spacings of another set that may be kept. Hardly a place is farther than one from the next point, so a
/// larger distance would leave nothing.
pub(crate) const MOST_SPACINGS: f64 = 16.0;

/// The most points that the tiles of a set hold, or other memory of their size: about 4 MB in the plane, 12 MB in space.
const fn most<const D: usize>() -> usize {
    1 << (16 + D)
}

/// A set that others keep clear of.
pub(crate) trait OtherSet<const D: usize>: Clone + Debug {
    /// The mean spacing of its points at full density.
    fn spacing(&self) -> f64;

    /// The mean spacing of those that it has.
    fn spacing_kept(&self) -> f64;

    /// The greatest sides of tiles.
    fn sides(&self) -> [f64; D];

    /// How many looks at the points within a distance of a place cost as much as a tile with some sides.
    fn searches(&self, sides: [f64; D], distance: f64) -> u32;

    /// Whether another one is known to have the same points.
    fn is_same(&self, other: &Self) -> bool;

    /// The sets that it keeps clear of.
    fn clear(&self) -> &[ClearOf<Self>];

    /// The largest absolute coordinate near which it has points.
    fn limit(&self) -> f64;

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
        match distance > 0.0 && distance <= set.spacing() * MOST_SPACINGS {
            true => Ok(Self { set, distance }),
            false => Err(refused(distance, set.spacing())),
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
    /// The greatest distance that is kept, and the box in which most points matter, if one is known.
    distance: f64,
    around: Option<Region<D>>,
    limit: f64,
    grid: Grid<D>,
    /// The searches near a tile after which it is made.
    searches: u32,
    numbers: BTreeMap<[i64; D], usize>,
    tiles: Vec<Tile<D>>,
    /// The place and the number of the last tile that was looked at, and its box.
    last: ([i64; D], usize),
    within: Region<D>,
    held: usize,
}

#[derive(Clone, Debug)]
enum Tile<const D: usize> {
    /// Its points are not known; the number of places near it that were tested.
    Unknown(u32),
    Known(Points<D>),
}

impl<S: OtherSet<D>, const D: usize> Clear<S, D> {
    /// Tests of some distances, which end with a flag. If most of the places are known to be in a box, they cost less.
    pub(crate) fn new(clear: &[ClearOf<S>], within: Option<&Region<D>>, stop: Stop) -> Self {
        let mut others = Vec::new();
        let own = list(clear, &mut others);
        widen(&own, within, &mut others);
        for i in (0..others.len()).rev() {
            let (earlier, rest) = others.split_at_mut(i);
            let other = &mut rest[0];
            widen(&other.edges, other.around.as_ref(), earlier);
            let around = other.around.as_ref().filter(|around| !around.is_empty());
            other.grid = Grid::new(around, other.set.sides());
            other.searches = other.set.searches(other.grid.sides, other.distance);
        }
        Self { own, others, stop }
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
            others.push(Other::new(set.clone(), edges));
            others.len() - 1
        });
        edges.push(Edge {
            other,
            distance: *distance,
        });
    }
    edges
}

/// Adds the surroundings of places in a box, from which edges lead, to the boxes of the sets there.
fn widen<S, const D: usize>(
    edges: &[Edge],
    within: Option<&Region<D>>,
    others: &mut [Other<S, D>],
) {
    for Edge { other, distance } in edges {
        let other = &mut others[*other];
        other.distance = distance.max(other.distance);
        if let Some(within) = within {
            // Beyond the limit no tile is looked at.
            let end = |v: f64| v.clamp(-other.limit, other.limit);
            let min = within.min().map(|v| end(v - distance));
            let around = Region::between(min, within.max().map(|v| end(v + distance)));
            let all = other.around.map(|all| all.around(&around));
            other.around = Some(all.unwrap_or(around));
        }
    }
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
        // Not so for numbers that are infinite or not a number.
        if !(at.iter()).all(|v| v.abs() + distance <= other.limit) {
            return false;
        }
        // More than rounding takes.
        let room = at.map(|v| distance * (1.0 + 1e-9) + v.abs() * 1e-15);
        let [first, last] = match other.is_in_last(at, room) {
            true => [other.last.0; 2],
            false => other.grid.places(at, room),
        };
        let mut place = first;
        loop {
            let tile = other.number(place);
            if let Tile::Unknown(tested) = &mut other.tiles[tile] {
                *tested += 1;
                if *tested < other.searches {
                    return self.finds(others, (at, room), stop);
                }
                if !other.make(place, stop) {
                    return false;
                }
            }
            let (edges, tile) = (&other.edges, &mut other.tiles[tile]);
            if let Tile::Known(points) = tile
                && points.may_have(at)
                && points.has_near((at, room), distance, |point| {
                    !edges.iter().any(|edge| edge.is_near(earlier, point, stop))
                })
            {
                return true;
            }
            if place == last {
                return false;
            }
            // The next one, along x first.
            let axis = (0..D).find(|&axis| place[axis] < last[axis]).unwrap_or(0);
            place[axis] += 1;
            place[..axis].copy_from_slice(&first[..axis]);
        }
    }

    /// As [`is_near`](Self::is_near), by a look at the points around the place.
    #[cold]
    fn finds<S: OtherSet<D>, const D: usize>(
        &self,
        others: &mut [Other<S, D>],
        (at, room): ([f64; D], [f64; D]),
        stop: &Stop,
    ) -> bool {
        let (earlier, rest) = others.split_at_mut(self.other);
        let Other { set, edges, .. } = &mut rest[0];
        let around = Region::between(from_fn(|i| at[i] - room[i]), from_fn(|i| at[i] + room[i]));
        let mut found = false;
        set.visit(&around, stop, |point| {
            found = is_nearer(point, at, self.distance)
                && !edges.iter().any(|edge| edge.is_near(earlier, point, stop));
            !found
        });
        found
    }
}

impl<S: OtherSet<D>, const D: usize> Other<S, D> {
    fn new(set: S, edges: Vec<Edge>) -> Self {
        Self {
            distance: 0.0,
            around: None,
            grid: Grid::new(None, set.sides()),
            searches: 0,
            limit: set.limit(),
            set,
            edges,
            numbers: BTreeMap::new(),
            tiles: Vec::new(),
            last: ([i64::MIN; D], 0),
            within: Region::between([0.0; D], [0.0; D]),
            held: 0,
        }
    }

    /// Whether everything up to `room` from a place lies in the last tile.
    #[inline(always)]
    fn is_in_last(&self, at: [f64; D], room: [f64; D]) -> bool {
        let (min, max) = (self.within.min(), self.within.max());
        (0..D).all(|axis| min[axis] <= at[axis] - room[axis] && at[axis] + room[axis] < max[axis])
    }

    /// The number of a tile.
    #[inline]
    fn number(&mut self, place: [i64; D]) -> usize {
        if self.last.0 != place {
            self.last = (place, self.find(place));
            self.within = self.grid.region(place);
        }
        self.last.1
    }

    #[cold]
    fn find(&mut self, place: [i64; D]) -> usize {
        if let Some(number) = self.numbers.get(&place) {
            return *number;
        }
        if self.held > most::<D>() {
            self.numbers.clear();
            self.tiles.clear();
            self.held = 0;
        }
        self.held += EMPTY;
        self.numbers.insert(place, self.tiles.len());
        self.tiles.push(Tile::Unknown(0));
        self.tiles.len() - 1
    }

    /// Makes the last tile. Returns false once the flag is raised.
    fn make(&mut self, place: [i64; D], stop: &Stop) -> bool {
        let region = self.grid.region(place);
        let mut all = Vec::new();
        self.set.visit(&region, stop, |point| {
            all.push(point);
            true
        });
        let by = (self.set.spacing_kept(), self.distance);
        let points = Points::new(&region, by, &all);
        self.held += points.bytes() / size_of::<[f64; D]>();
        self.tiles[self.last.1] = Tile::Known(points);
        !stop.is_raised()
    }
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

        fn searches(&self, _: [f64; 2], _: f64) -> u32 {
            self.searches
        }

        fn is_same(&self, other: &Self) -> bool {
            self.number == other.number
        }

        fn clear(&self) -> &[ClearOf<Self>] {
            &self.clear
        }

        fn limit(&self) -> f64 {
            f64::MAX
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
            distances in [1e-3..1.2f64, 1e-3..1.2f64, 1e-3..1.2f64, 1e-3..1.2f64], searches in 0..6u32, size in 1.0..6.0f64,
            is_known in any::<bool>(), far in prop_oneof![Just(0.0), Just(1e6), Just(1e12)],
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
            let within = Region::between(moved(&[1.0 - far, 2.0 - far]), moved(&[size, 5.0]));
            let mut clear = Clear::new(&own, is_known.then_some(&within), Stop::default());
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
        let within = Region::between([0.0; 2], [0.3; 2]);
        let mut clear = Clear::new(&own, Some(&within), Stop::default());
        for known in [false, false, true] {
            assert!(clear.permits([0.1, 0.1]));
            let tiles = &clear.others[0].tiles;
            assert_eq!(matches!(tiles[..], [Tile::Known(_)]), known);
        }
        assert!(!clear.permits([0.2, 0.205]) && clear.permits([1.0, 1.0]));
        assert!(matches!(clear.others[0].tiles[..], [Tile::Unknown(1)]));
    }
}
