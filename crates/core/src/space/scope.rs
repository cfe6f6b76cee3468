//! Scopes: the part of a lattice that a request covers.

use alloc::{sync::Arc, vec::Vec};
use core::ops::Range;

use super::{
    Region, Volume,
    lattice::{Lattice, fixed},
    mask::{Mask, Other},
    point::PointId,
};
pub(super) use crate::lattice::bounds::common;
use crate::{
    error::{Error, ErrorKind},
    lattice::{
        Without,
        bounds::{Corner, bounds, check_limit, common_box},
    },
    near::clear::{Clear, ClearOf},
    settle::{LEAST_IN_SPACE, Moves},
    stop::Stop,
    table::FRACTION_BITS,
};

/// The sides of parts that settle at once, in lattice units at full density: points settle with those around, so larger
/// ones cost less for each point and more memory.
pub(super) const TILE: f64 = 256.0;

/// [`Scope::leaf`] where points stay.
const LEAF: i64 = 64;

/// The requested part of a lattice.
#[derive(Clone, Debug)]
pub struct Scope {
    pub(super) lattice: Lattice,
    /// The fixed-point coordinates of the points inside.
    pub(super) bounds: [Range<i64>; 3],
    /// The positions before the warp from which points may get inside.
    pub(super) before: [Range<i64>; 3],
    /// The lattice coordinates of these points, and a few more.
    pub(super) all: [Range<i64>; 3],
    /// The conditions that points must satisfy beside the bounds.
    pub(super) volume: Option<Volume>,
    /// The box around all points.
    pub(super) region: Region,
    /// The place that offsets are relative to.
    pub(super) corner: Corner<3>,
    /// The sets that points keep clear of.
    pub(super) clear: Arc<[ClearOf<Other>]>,
    /// The addresses of the points inside that are left out by their ids; where points settle, of some outside, too.
    pub(super) missing: Arc<[[i64; 3]]>,
    /// How far points may settle from where they are put, in fixed-point units.
    pub(super) room: i64,
    /// Boxes of the lattice up to this side are counted point by point: larger ones where points settle with those
    /// around.
    pub(super) leaf: i64,
    /// Ends counting early.
    pub(super) stop: Stop,
}

/// Whether the points of a box of the lattice lie inside.
#[derive(Clone, Debug)]
pub(super) enum State {
    In,
    Out,
    /// Each has to be tested, by this volume beside the bounds.
    Test(Option<Volume>),
}

impl Scope {
    /// The part of a lattice under a mask that lies in a volume.
    pub(super) fn new(
        lattice: &Lattice,
        mask: &Mask,
        volume: &Volume,
        stop: Stop,
    ) -> Result<Self, Error> {
        let volume = &mask.narrowed(volume);
        let region = volume
            .bounds()
            .ok_or_else(|| Error::new(ErrorKind::Unbounded, "area", "unbounded", "within a box"))?;
        let limit = lattice.limit();
        check_limit(&region, limit)?;
        let (chunks, rest) = (volume.chunks(), volume.beside_chunks());
        let around_rest = rest.as_ref().and_then(Volume::bounds);
        let bounds = bounds((lattice.step, limit), &chunks, around_rest);
        let corner = Corner::new(lattice.step, &chunks, &region, &bounds);
        // Within the limit they fit 64 bits.
        let bounds = bounds.map(|range| range.start as i64..range.end as i64);
        let volume = rest.filter(|rest| !matches!(rest, Volume::Region(_)));
        let mut scope = Self {
            volume,
            clear: mask.clear.clone(),
            stop,
            ..Self::between_places(lattice, bounds, (region, corner))
        };
        scope.missing = scope.find_missing();
        Ok(scope)
    }

    /// The points of a lattice at some places.
    pub(super) fn of_places(lattice: &Lattice, bounds: [Range<i64>; 3]) -> Self {
        let ends = bounds.each_ref().map(|range| [range.start, range.end]);
        let [min, max] = [0, 1].map(|end| ends.map(|ends| lattice.world(ends[end])));
        let region = Region::between(min, max);
        let first = (bounds.clone()).map(|range| range.start.into()..range.end.into());
        let corner = Corner::new(lattice.step, &[], &region, &first);
        Self::between_places(lattice, bounds, (region, corner))
    }

    /// All of a lattice between bounds, with offsets from a corner of the box around.
    fn between_places(
        lattice: &Lattice,
        bounds: [Range<i64>; 3],
        (region, corner): (Region, Corner<3>),
    ) -> Self {
        let (mut room, mut leaf) = (0, LEAF);
        if let Some((_, grade)) = lattice.settling()
            && bounds.iter().all(|range| !range.is_empty())
        {
            let side = lattice.table.map().alpha().set_side_f64();
            let moves = Moves::new(grade, side, lattice.step);
            let bounds = (bounds.clone()).map(|range| range.start.into()..range.end.into());
            let around = moves.around(&bounds);
            room = moves.most(&around);
            leaf = tile(&moves, &around);
        }
        let placed = bounds
            .clone()
            .map(|range| range.start - room..range.end + room);
        let before = before(lattice, &placed);
        let all = [0, 1, 2].map(|axis| {
            let ([least, most], range) = (lattice.turned.reach[axis], &before[axis]);
            if range.is_empty() {
                return 0..0;
            }
            let start = -((i64::from(most) - range.start) >> FRACTION_BITS);
            start..((range.end - 1 - i64::from(least)) >> FRACTION_BITS) + 1
        });
        Self {
            corner,
            lattice: lattice.clone(),
            bounds,
            before,
            all,
            volume: None,
            region,
            clear: Arc::default(),
            missing: Arc::default(),
            room,
            leaf,
            stop: Stop::default(),
        }
    }

    /// The states of the points of a box of the lattice, which is not empty, if their number is not known to be 0.
    pub(super) fn state(&self, ranges: &[Range<i64>; 3], volume: Option<&Volume>) -> State {
        let places = self.places(ranges);
        let grade = self.lattice.grade.as_ref();
        let bounds = grade.map(|grade| grade.bounds(&self.between(places)));
        let mut is_inside = match bounds {
            Some([_, high]) if high <= 0.0 => return State::Out,
            Some([low, _]) => low >= self.lattice.placement.graded(),
            None => true,
        };
        for ([least, most], bounds) in places.iter().zip(&self.bounds) {
            if *most < bounds.start || bounds.end <= *least {
                return State::Out;
            }
            is_inside &= bounds.start <= *least && *most < bounds.end;
        }
        let Some(volume) = volume else {
            return if is_inside {
                State::In
            } else {
                State::Test(None)
            };
        };
        let near = volume.focus(&self.between(places));
        match near.is_all_or_nothing() {
            Some(false) => State::Out,
            Some(true) if is_inside => State::In,
            Some(true) => State::Test(None),
            None => State::Test(Some(near)),
        }
    }

    /// The ends of the fixed-point coordinates of the points of a box of the lattice.
    fn places(&self, ranges: &[Range<i64>; 3]) -> [[i64; 2]; 3] {
        let room = self.room;
        (self.placed(ranges)).map(|[least, most]| [least - room, most + room])
    }

    /// As [`places`](Self::places), before points settle.
    pub(super) fn placed(&self, ranges: &[Range<i64>; 3]) -> [[i64; 2]; 3] {
        let lattice = &self.lattice;
        let displaced = [0, 1, 2].map(|axis| {
            let [least, most] = lattice.turned.reach[axis].map(i64::from);
            let range = &ranges[axis];
            [fixed(range.start) + least, fixed(range.end - 1) + most]
        });
        match &lattice.shears {
            Some(shears) => shears.spread(displaced),
            None => displaced,
        }
    }

    /// The number of points of a box of the lattice that are inside, but for their ids.
    pub(super) fn missing(&self, ranges: &[Range<i64>; 3]) -> u128 {
        // They ascend by x.
        let [start, end] =
            [ranges[0].start, ranges[0].end].map(|x| self.missing.partition_point(|at| at[0] < x));
        let near = self.missing.get(start..end).unwrap_or_default();
        let is_there = |at: &&[i64; 3]| (1..3).all(|axis| ranges[axis].contains(&at[axis]));
        near.iter().filter(is_there).count() as u128
    }

    /// The addresses of the points that the lattice lacks by their ids and that lie inside.
    fn find_missing(&self) -> Arc<[[i64; 3]]> {
        let Self { lattice, all, .. } = self;
        if lattice.without.is_empty() {
            return Arc::default();
        }
        let whole = Lattice {
            without: Without::default(),
            ..lattice.clone()
        };
        let holds = |place: [i64; 3]| {
            let is_in = |volume: &Volume| volume.contains(lattice.at(place));
            (0..3).all(|axis| self.bounds[axis].contains(&place[axis]))
                && self.volume.as_ref().is_none_or(is_in)
        };
        // Where points settle, those are needed only that lie in parts all of which is inside.
        let is_inside = |id: PointId| {
            let place = whole.place(id)?;
            (self.room > 0 || holds(place)).then(|| id.lattice())
        };
        let [first, end] = [all[0].start, all[0].end].map(|x| PointId::of([x, i64::MIN, i64::MIN]));
        let near = lattice.without.within(first..end);
        let near = near.filter(|id| all[1].contains(&id.y) && all[2].contains(&id.z));
        let mut missing: Vec<[i64; 3]> = near.filter_map(is_inside).collect();
        // Several lists may have the same.
        missing.sort_unstable();
        missing.dedup();
        missing.into()
    }

    /// The sets that points keep clear of.
    pub(super) fn clearance(&self) -> Clear<Other, 3> {
        Clear::new(&self.clear, Some(&self.region), self.stop.clone())
    }

    fn between(&self, places: [[i64; 2]; 3]) -> Region {
        let [min, max] = [0, 1].map(|end| places.map(|ends| self.lattice.world(ends[end])));
        Region::between(min, max)
    }

    /// Whether points are counted in closed form: all that is requested lies in a box without warp, and is clear of
    /// nothing.
    pub(super) fn is_closed(&self) -> bool {
        self.is_box() && self.clear.is_empty()
    }

    /// Whether all that is requested lies in a box without warp and in no field, and stays where it is put.
    pub(super) fn is_box(&self) -> bool {
        let lattice = &self.lattice;
        let is_plain = lattice.shears.is_none() && lattice.grade.is_none() && self.room == 0;
        self.volume.is_none() && is_plain
    }

    /// Whether it has few points, near each other, which are walked once in place of being counted.
    pub(super) fn is_small(&self) -> bool {
        /// The most candidates.
        const FEW: f64 = 20_000.0;
        let is_short = |range: &Range<i64>| range.end - range.start <= 1024;
        self.all.iter().all(is_short) && self.candidates(&self.all) <= FEW
    }

    /// Whether walking over a box of the lattice to some of its points takes no longer than counting parts of it.
    pub(super) fn is_worth_walking(&self, ranges: &[Range<i64>; 3], numbers: usize) -> bool {
        /// Candidates that are walked in the time of a count: in closed form, and along a surface. Points that keep clear
        /// are walked to be counted, too.
        const CLOSED: f64 = 65_536.0;
        const SURFACE: f64 = 2e6;
        let least = if self.is_closed() { CLOSED } else { SURFACE };
        let most = least.max(CLOSED * numbers as f64);
        let is_slow = self.lattice.grade.is_some() || self.room > 0;
        !self.clear.is_empty() || is_slow || self.candidates(ranges) <= most
    }

    /// The box of the lattice that both have.
    pub(super) fn clip(&self, ranges: &[Range<i64>; 3]) -> [Range<i64>; 3] {
        common_box(&self.all, ranges)
    }

    /// About the number of points that are looked at for those of a box of the lattice.
    pub(super) fn candidates(&self, ranges: &[Range<i64>; 3]) -> f64 {
        let t = self.lattice.pattern.alpha().set_side_f64();
        let sides = ranges
            .iter()
            .map(|range| (range.end - range.start).max(0) as f64 * t);
        sides.product()
    }
}

/// The positions from which the warp takes points into bounds.
fn before(lattice: &Lattice, bounds: &[Range<i64>; 3]) -> [Range<i64>; 3] {
    match &lattice.shears {
        Some(shears) if bounds.iter().all(|range| !range.is_empty()) => {
            let ends = bounds.clone().map(|range| [range.start, range.end - 1]);
            shears.gather(ends).map(|[first, last]| first..last + 1)
        }
        _ => bounds.clone(),
    }
}

/// The sides of parts that settle at once, which hold as many points at any share.
pub(super) fn tile(moves: &Moves<3>, within: &[Range<i128>; 3]) -> i64 {
    power(TILE / libm::cbrt(moves.greatest_share(within).max(LEAST_IN_SPACE)))
}

/// The next power of two.
pub(super) fn power(side: f64) -> i64 {
    (side as u64).next_power_of_two() as i64
}
