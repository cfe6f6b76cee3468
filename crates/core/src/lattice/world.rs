//! The lattice of a point set, laid into the world.

use alloc::sync::Arc;
use core::ops::Range;

use super::{
    Keep, OneKind, Placement, Point, PointId, Settle, Without,
    bounds::world,
    grade::{Grade, alike},
    kinds::{Chosen, KindRow, Varied},
};
use crate::{
    field::Field,
    map::Map,
    pattern::{Axis, Class, Pattern},
    table::{Cut, Displacement, FRACTION_BITS, Order, Table, TurnedTable, fixed},
    warp::{NearShears, Shears, Stretch, Waves},
};

/// The largest absolute lattice coordinate of a region and of an id, 2⁵². Up to there `f64` separates
/// lattice points, and no intermediate value overflows or rounds twice.
///
/// ```
/// use strew_core::{LATTICE_LIMIT, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let set = PointSet::new(table).spacing(4.0)?;
/// // A lattice unit is t mean spacings.
/// let unit = set.table().alpha().set_side_f64() * 4.0;
/// assert_eq!(set.limit(), LATTICE_LIMIT as f64 * unit);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub const LATTICE_LIMIT: i64 = 1 << 52;

/// A table at a placement: which lattice addresses have points, and where these are.
#[derive(Clone, Debug)]
pub(crate) struct Lattice {
    pub(crate) table: Table,
    pub(crate) placement: Placement,
    /// The table, turned by the seed's symmetry.
    pub(crate) turned: TurnedTable,
    /// The pattern from the seed's origin.
    pub(crate) pattern: Pattern,
    /// The cut between points that are kept and others, if not all are kept.
    cut: Option<Cut>,
    /// The kind that points are of, if not any.
    pub(super) kinds: Option<Chosen>,
    /// The kinds whose shares vary, if there are such.
    pub(super) varied: Option<Varied>,
    /// The field that decides which points are kept.
    pub(crate) grade: Option<Grade>,
    pub(crate) shears: Option<Shears>,
    /// The bound of what the warp does to distances.
    pub(crate) stretch: Stretch,
    /// The points that are left out by their ids.
    pub(crate) without: Without<PointId>,
    /// World units per fixed-point unit.
    pub(crate) step: f64,
}

impl Lattice {
    pub(crate) fn new(table: Table, placement: Placement) -> Self {
        let alpha = table.alpha();
        let Placement {
            spacing,
            seed,
            warp,
            keep,
            settle,
            ..
        } = placement;
        // The mean spacing in the grid is 1/t, so a scale of spacing · t makes it `spacing`.
        let scale = spacing.get() * alpha.set_side_f64();
        let shears = Shears::new(Waves::of(table.profile()), warp, seed);
        let turned = TurnedTable::new(&table, seed.symmetry());
        // Where points settle, the level of detail is a choice among settled ones.
        let settles = settle.of_share(keep.get()).is_some();
        let shown = placement.shown();
        Self {
            placement,
            pattern: Pattern::with_origin(alpha, seed.origin()),
            cut: (shown < 1.0 && !settles).then(|| turned.order().cut(table.map(), shown)),
            kinds: None,
            varied: None,
            grade: settles.then(|| Grade::constant(keep.get())),
            without: Without::default(),
            turned,
            stretch: Stretch::of(shears.as_ref()),
            shears,
            step: scale / f64::from(1u32 << FRACTION_BITS),
            table,
        }
    }

    /// The points of this lattice that are of a kind; none if the table has no mix.
    pub(crate) fn of_kind(self, kind: u8) -> Self {
        if self.varied.is_some() {
            return self.picking(kind);
        }
        let (map, mix) = (self.table.map(), self.table.mix());
        let kinds = self.turned.labels().zip(mix);
        let kinds = kinds.map(|(labels, mix)| OneKind::chosen(map, mix, labels, kind));
        Self { kinds, ..self }
    }

    /// This lattice with another table of the same map. It has points of all kinds.
    pub(crate) fn of_table(self, table: Table) -> Self {
        let placement = self.placement;
        let all = Self {
            kinds: None,
            varied: None,
            table,
            ..self
        };
        match &all.grade {
            Some(grade) if grade.known().is_none() => all.graded(placement, grade),
            _ => all.at(placement),
        }
    }

    /// A lattice of the same table at another placement, of the same kind as this one.
    fn at(&self, placement: Placement) -> Self {
        let symmetry = placement.seed.symmetry();
        let varied = self.varied.as_ref();
        let lattice = Self {
            varied: varied.map(|varied| varied.turned(symmetry)),
            without: self.without.clone(),
            ..Self::new(self.table.clone(), placement)
        };
        match &self.kinds {
            Some(kinds) if symmetry != self.placement.seed.symmetry() => {
                lattice.of_kind(kinds.kind())
            }
            kinds => Self {
                kinds: kinds.clone(),
                ..lattice
            },
        }
    }

    /// The kind that points are of, if not any.
    pub(crate) fn kind(&self) -> Option<u8> {
        match &self.varied {
            Some(varied) => varied.only(),
            None => self.kinds.as_ref().map(|kinds| kinds.kind()),
        }
    }

    /// The share of all points that are of the lattice's kind, if it has one; about, where shares vary.
    pub(crate) fn kind_share(&self) -> f64 {
        match &self.varied {
            Some(varied) => varied.share(),
            None => self.kinds.as_ref().map_or(1.0, |kinds| kinds.share()),
        }
    }

    /// About the share of all points that the lattice has, before a field decides.
    pub(crate) fn share(&self) -> f64 {
        self.placement.shown() * self.kind_share()
    }

    /// Whether the lattice has all points of the pattern, before a field decides.
    #[inline]
    pub(crate) fn has_all(&self) -> bool {
        self.cut.is_none() && self.kinds.is_none()
    }

    /// This lattice in a field, which the share of the placement multiplies.
    pub(crate) fn in_field(&self, field: Arc<dyn Field>) -> Self {
        let grade = Grade::new(field, 1.0);
        self.graded(self.placement, &grade)
    }

    /// The lattice of a placement in a field.
    fn graded(&self, placement: Placement, grade: &Grade) -> Self {
        Self {
            placement,
            grade: Some(grade.times(placement.graded())),
            ..self.at(placement.with_keep(Keep::ALL).with_lod(Keep::ALL))
        }
    }

    /// The lattice where a field has the same share everywhere.
    pub(crate) fn in_constant(&self, share: f64) -> Self {
        let part = self.settle().map_or(1.0, |_| self.placement.lod.get());
        let keep = Keep::unchecked(share * part);
        let placement = self.placement.with_keep(keep).with_lod(Keep::ALL);
        let placement = placement.with_settle(Settle::OFF);
        Self {
            placement: self.placement,
            ..self.at(placement)
        }
    }

    /// The steps by which points settle, if they do.
    pub(crate) fn settle(&self) -> Option<Settle> {
        let settle = self.placement.settle;
        match self.grade.as_ref()?.known() {
            Some(share) => settle.of_share(share),
            None => (!settle.is_off()).then_some(settle),
        }
    }

    /// The share of points that settle, if it is no field's.
    pub(crate) fn constant_share(&self) -> Option<f64> {
        self.grade.as_ref()?.known()
    }

    /// Whether a field decides which points are kept.
    pub(crate) fn is_in_field(&self) -> bool {
        self.grade.is_some() && self.constant_share().is_none()
    }

    /// Whether a point that settles, of a share, is one of those that are wanted.
    pub(crate) fn shows(&self, id: PointId, share: f64) -> bool {
        self.is_of_level(id, share) && !self.without.has(id)
    }

    /// Whether a point that settles, of a share, is of the kinds and the level of detail that are wanted.
    pub(crate) fn is_of_level(&self, id: PointId, share: f64) -> bool {
        let lod = self.placement.lod;
        (lod == Keep::ALL || self.rank(id) < lod.get() * share)
            && (!self.tells_kinds() || self.block(id).is_some())
    }

    /// The points of all kinds.
    pub(crate) fn of_all_kinds(&self) -> Self {
        Self {
            kinds: None,
            varied: None,
            ..self.clone()
        }
    }

    /// Whether points are of some kind only.
    fn tells_kinds(&self) -> bool {
        self.kinds.is_some() || self.picks()
    }

    /// The least distance of all points of the plane, in fixed-point units.
    pub(crate) fn certified(&self) -> f64 {
        let relative = self.table.least_distance().with_warp(self.placement.warp);
        relative * f64::from(1u32 << FRACTION_BITS) / self.table.alpha().set_side_f64()
    }

    pub(crate) fn map(&self) -> &Map {
        self.table.map()
    }

    /// The class of a row and its block of dY, or `None` if the row holds no points.
    #[inline]
    pub(crate) fn row(&self, y: i64) -> Option<(Class, usize)> {
        let (class, index) = self.pattern.visit(Axis::Y, y)?;
        Some((class, self.map().locate(index)))
    }

    /// The column of an index dX.
    #[inline]
    pub(crate) fn line(&self, at: i64, index: u64) -> Line {
        let block = self.map().locate(index);
        let of_cut = self.cut.is_some_and(|cut| cut.is_in_strip(block, index));
        let of_kind = self.kinds.as_ref();
        let of_kind = of_kind.map_or(0, |kinds| kinds.strips_at(block, index));
        Line {
            at,
            block: block as u32,
            strips: u32::from(of_cut) | of_kind,
        }
    }

    /// A test for the columns that have points in the rows of a block of dY.
    #[inline]
    pub(crate) fn keeps(&self, block_y: usize) -> impl Fn(&Line) -> bool + '_ {
        let n = self.map().intervals();
        let positions = self.order().positions(block_y * n..(block_y + 1) * n);
        let kinds = self.kinds_in_row(block_y);
        move |line| {
            let block = line.block as usize;
            self.cut
                .is_none_or(|cut| cut.keeps(positions[block], line.strips & 1 != 0))
                && kinds.is_none_or(|kinds| kinds.keeps(block, line.strips))
        }
    }

    /// The parts of the blocks of a row that are of the lattice's kind, if it has one.
    #[inline]
    pub(crate) fn kinds_in_row(&self, block_y: usize) -> Option<KindRow<'_>> {
        let n = self.map().intervals();
        self.kinds.as_ref().map(|kinds| kinds.in_row(n, block_y))
    }

    /// The blocks of dX and dY of which the lattice may have a part, with the interval of dX that it has, if
    /// any of the block.
    pub(crate) fn parts(&self) -> impl Iterator<Item = ([usize; 2], Range<u64>)> + '_ {
        let strip = self.cut.map(|cut| {
            let ([x, y], end) = cut.strip();
            ([x, y], self.map().interval(x).start..end)
        });
        let of_kind = self.kinds.iter().flat_map(|kinds| kinds.parts());
        let own = strip.clone();
        let of_kind = of_kind.map(move |(block, interval)| match &own {
            Some((partial, strip)) if *partial == block => {
                let start = interval.start.max(strip.start);
                (block, start..interval.end.min(strip.end).max(start))
            }
            _ => (block, interval.clone()),
        });
        // The first of two of a block counts.
        of_kind.chain(strip)
    }

    /// The vectors of all blocks with one interval of dY.
    #[inline]
    pub(crate) fn vectors(&self, block_y: usize) -> &[[i32; 2]] {
        self.turned.row(block_y)
    }

    /// The order in which blocks leave.
    #[inline]
    pub(crate) fn order(&self) -> &Order {
        self.turned.order()
    }

    /// The least and the greatest displacement along an axis, without the warp.
    pub(crate) fn table_reach(&self, axis: Axis) -> [i32; 2] {
        self.turned.reach()[axis as usize]
    }

    /// This lattice at another placement. What does not change is shared.
    pub(crate) fn replaced(&self, placement: Placement) -> Self {
        if let Some(grade) = &self.grade {
            return match grade.known() {
                Some(_) => self.at(placement),
                None => self.graded(placement, grade),
            };
        }
        let is_turned = placement.seed.symmetry() != self.placement.seed.symmetry();
        let is_kept = placement.keep == self.placement.keep
            && placement.settle == self.placement.settle
            && placement.lod == self.placement.lod;
        if !is_kept || is_turned {
            return self.at(placement);
        }
        let still = placement.with_keep(Keep::ALL).with_lod(Keep::ALL);
        let still = still.with_settle(Settle::OFF);
        Self {
            placement,
            cut: self.cut,
            ..self.at(still)
        }
    }

    /// Whether another lattice is known to have the same points.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let is_graded = alike(&self.grade, &other.grade, Grade::is_same);
        let is_of_kind = alike(&self.kinds, &other.kinds, |a, b| core::ptr::eq(&**a, &**b));
        let is_varied = self.is_varied() || other.is_varied();
        let is_placed = self.placement == other.placement && self.table == other.table;
        is_graded && is_of_kind && is_placed && !is_varied && self.without.is_same(&other.without)
    }

    /// The kind of a point of the pattern, if the table has kinds; `None` for other addresses.
    pub(crate) fn kind_of(&self, id: PointId) -> Option<u8> {
        match &self.varied {
            Some(varied) => self.varied_kind_of(varied, id),
            None => {
                let (index_x, index_y) = self.pattern.index(id.x, id.y);
                let map = self.map();
                let block = [map.interval_of(index_x)?, map.interval_of(index_y)?];
                let labels = self.turned.labels()?;
                Some(labels.kind(map.intervals(), block, index_x))
            }
        }
    }

    /// The blocks of dX and dY of an address, or `None` if it has no point.
    pub(crate) fn block(&self, id: PointId) -> Option<[usize; 2]> {
        let within = -LATTICE_LIMIT..=LATTICE_LIMIT;
        if !within.contains(&id.x) || !within.contains(&id.y) {
            return None;
        }
        let (index_x, index_y) = self.pattern.index(id.x, id.y);
        let map = self.map();
        let [block_x, block_y] = [map.interval_of(index_x)?, map.interval_of(index_y)?];
        let line = self.line(id.x, index_x);
        (self.keeps(block_y)(&line) && self.has_kind(id)).then_some([block_x, block_y])
    }

    /// The rank of a point of the pattern; the greatest for other addresses.
    pub(crate) fn rank(&self, id: PointId) -> f64 {
        self.rank_in(&self.turned, id)
    }

    /// The same in the order of another table.
    pub(super) fn rank_in(&self, turned: &TurnedTable, id: PointId) -> f64 {
        let (index_x, index_y) = self.pattern.index(id.x, id.y);
        let map = self.map();
        let (Some(x), Some(y)) = (map.interval_of(index_x), map.interval_of(index_y)) else {
            return 1.0_f64.next_down();
        };
        let (order, interval) = (turned.order(), map.interval(x));
        let position = order.position(y * map.intervals() + x);
        let (offset, length) = (index_x - interval.start, interval.end - interval.start);
        order.rank(position, offset, length)
    }

    /// The fixed-point place of an address, or `None` if it has no point.
    pub(crate) fn place(&self, id: PointId) -> Option<[i128; 2]> {
        (!self.without.has(id)).then(|| self.place_of_any(id))?
    }

    /// As [`place`](Self::place), of points that are left out by their ids, too.
    pub(crate) fn place_of_any(&self, id: PointId) -> Option<[i128; 2]> {
        let [block_x, block_y] = self.block(id)?;
        let vector = self.vectors(block_y)[block_x];
        let place = self.displaced_place(id, vector);
        let at = || place.map(|k| self.world(k));
        let grade = self.grade.as_ref();
        grade
            .is_none_or(|grade| self.is_left(grade, id, at()))
            .then_some(place)
    }

    /// The share of the field at the place of a point; `None` without a field or a point.
    pub(crate) fn share_of(&self, id: PointId) -> Option<f64> {
        let grade = self.grade.as_ref()?;
        let [block_x, block_y] = self.block(id)?;
        let place = self.displaced_place(id, self.vectors(block_y)[block_x]);
        let share = grade.share(place.map(|k| self.world(k)));
        (self.rank(id) < share).then_some(share)
    }

    /// Whether a field leaves a point of the pattern, by its place.
    #[inline]
    pub(crate) fn is_left(&self, grade: &Grade, id: PointId, at: [f64; 2]) -> bool {
        self.rank(id) < grade.share(at)
    }

    /// The fixed-point place of an address that has a point, with a displacement.
    pub(super) fn displaced_place(&self, id: PointId, [dx, dy]: Displacement) -> [i128; 2] {
        let displaced = [fixed(id.x) + i128::from(dx), fixed(id.y) + i128::from(dy)];
        match &self.shears {
            Some(shears) => {
                let (mut near, origin) = NearShears::new(shears, displaced);
                let place = near.apply([0, 1].map(|i| (displaced[i] - origin[i]) as i64));
                [0, 1].map(|i| origin[i] + i128::from(place[i]))
            }
            None => displaced,
        }
    }

    /// The point of an address, or `None` if it has none.
    pub(crate) fn point(&self, id: PointId) -> Option<Point> {
        Some(self.point_at(id, self.place(id)?))
    }

    fn point_at(&self, id: PointId, place: [i128; 2]) -> Point {
        let [x, y] = place.map(|k| self.world(k));
        Point { id, x, y }
    }

    /// The world coordinate of a fixed-point one. Monotone.
    #[inline]
    pub(crate) fn world(&self, fixed: i128) -> f64 {
        world(self.step, fixed)
    }

    /// The largest absolute world coordinate of a region.
    pub(crate) fn limit(&self) -> f64 {
        const LIMIT: f64 = fixed(LATTICE_LIMIT) as f64;
        LIMIT * self.step
    }
}

/// A column or row that holds points: its coordinate, and its interval of dX or dY.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Line {
    pub(crate) at: i64,
    pub(crate) block: u32,
    /// For a column, the strips that its dX lies in, of blocks that are partly in the set. Bit 0 is that of the
    /// [cut](crate::table::Cut), the others are those of the [kind](super::OneKind).
    pub(crate) strips: u32,
}
