//! Scopes: the part of a lattice that a plan covers.

use alloc::vec::Vec;
use core::ops::Range;

use super::{
    missing::Missing,
    sieve::{LocalSieve, Sieve},
};
pub(crate) use crate::lattice::bounds::Corner;
use crate::{
    error::{Error, ErrorKind},
    field::constant,
    lattice::{
        BAND_WIDTH, LATTICE_LIMIT, Lattice, PointId, Span,
        bounds::{Bounds, bounds, check_limit},
    },
    near::Mask,
    settle::Settler,
    shape::{Area, Region},
    stop::Stop,
};

/// The columns and rows around an area, and what their points must satisfy.
#[derive(Clone, Debug)]
pub(crate) struct Scope {
    pub(crate) lattice: Lattice,
    pub(crate) x: Span,
    pub(crate) y: Span,
    /// `None` if all points of the box are requested.
    pub(crate) sieve: Option<Sieve>,
    /// Ends counting early.
    pub(crate) stop: Stop,
    /// The box around the area.
    pub(crate) region: Region,
    /// The place that offsets are relative to.
    pub(crate) corner: Corner<2>,
    /// The lattice in its field, where that has the same share in all of the scope and
    /// [`lattice`](Self::lattice) has that share.
    in_field: Option<Lattice>,
}

/// The area with its [chunks](Area::chunks) as boxes that hold every point of them by its reported
/// coordinates, and a little more.
fn around_chunks(area: &Area) -> Area {
    match area {
        Area::Region(region) if region.as_chunk().is_some() => {
            // Corners and reported coordinates are each rounded once.
            let below = |v: f64| v.next_down().next_down();
            let above = |v: f64| v.next_up().next_up();
            let (min, max) = (region.min().map(below), region.max().map(above));
            Area::Region(Region::between(min, max))
        }
        Area::AllOf(areas) => Area::AllOf(areas.iter().map(around_chunks).collect()),
        other => other.clone(),
    }
}

/// The spans of the points between fixed-point bounds. The addresses of points that settle may lie farther off.
fn spans(lattice: &Lattice, bounds: Bounds<2>) -> [Span; 2] {
    let Some(settler) = Settler::new(lattice) else {
        return Span::of_box(lattice, bounds);
    };
    if bounds.iter().any(Range::is_empty) {
        return Span::of_box(lattice, bounds);
    }
    let [x, y] = Span::of_box(lattice, settler.moves.around(&bounds));
    let [in_x, in_y] = bounds;
    [Span { bounds: in_x, ..x }, Span { bounds: in_y, ..y }]
}

impl Scope {
    /// The part of a set, given by its lattice and mask, that lies in an area.
    pub(crate) fn new(
        lattice: &Lattice,
        mask: &Mask,
        area: Area,
        stop: Stop,
    ) -> Result<Self, Error> {
        let area = mask.narrowed(&area);
        let region = area.bounds().ok_or_else(|| {
            let (field, value) = ("area", "unbounded");
            Error::new(ErrorKind::Unbounded, field, value, "within a box")
        })?;
        let limit = lattice.limit();
        check_limit(&region, limit)?;
        let (chunks, rest) = (area.chunks(), area.beside_chunks());
        let around_rest = rest.as_ref().and_then(Area::bounds);
        let bounds = bounds((lattice.step, limit), &chunks, around_rest);
        let corner = Corner::new(lattice.step, &chunks, &region, &bounds);
        let [x, y] = spans(lattice, bounds);
        let piece = [x.all.clone(), y.all.clone()];
        let share = lattice
            .grade
            .as_ref()
            .and_then(|grade| constant(lattice, grade, &piece));
        // Points settle, but those of a field not where there are none, or all.
        let stay = |share| lattice.is_in_field() && (share <= 0.0 || share >= 1.0);
        let share = share.filter(|&share| lattice.settle().is_none() || stay(share));
        if let Some(share) = share {
            let mask = Mask {
                area: None,
                clear: mask.clear.clone(),
            };
            return Ok(Self {
                in_field: Some(lattice.clone()),
                ..Self::new(&lattice.in_constant(share), &mask, area, stop)?
            });
        }
        debug_assert!(x.all.end < 2 * LATTICE_LIMIT && y.all.end < 2 * LATTICE_LIMIT);
        // Integers decide membership of a box, so it needs no sieve, except together with one.
        let is_box = matches!(rest, None | Some(Area::Region(_)));
        let sieve = if is_box && mask.clear.is_empty() && !lattice.picks() {
            None
        } else {
            let mask = Mask {
                area: Some(around_chunks(&area).into()),
                clear: mask.clear.clone(),
            };
            Some(Sieve::new(lattice, (mask, region), [x.reach, y.reach]))
        };
        let mut scope = Self {
            lattice: lattice.clone(),
            x,
            y,
            sieve,
            stop,
            region,
            corner,
            in_field: None,
        };
        let missing = scope.find_missing();
        if !missing.is_empty() {
            let sieve = scope.sieve.take().unwrap_or_else(|| scope.box_sieve());
            scope.sieve = Some(sieve.without(missing));
        }
        Ok(scope)
    }

    /// This scope of a lattice at another share.
    pub(crate) fn with_lattice(&self, lattice: Lattice) -> Self {
        let bounds = [self.x.bounds.clone(), self.y.bounds.clone()];
        let [x, y] = Span::of_box(&lattice, bounds);
        Self {
            lattice,
            x,
            y,
            ..self.clone()
        }
    }

    /// The points that the lattice leaves out by their ids. Meaningless once the flag is raised.
    fn find_missing(&self) -> Missing {
        let Self { lattice, x, y, .. } = self;
        if lattice.without.is_empty() {
            return Missing::default();
        }
        let [start, end] = [x.all.start, x.all.end].map(|x| PointId { x, y: i64::MIN });
        let near = lattice.without.within(start..end);
        let all = Missing::in_order(near.filter(|id| y.all.contains(&id.y)).collect());
        let mut found = Vec::new();
        if lattice.settle().is_some() {
            // Where they end does not matter: they are left out of counts of parts all of which is inside.
            found = all;
            found.retain(|id| {
                let share = lattice.share_of(*id).filter(|_| !self.stop.is_raised());
                share.is_some_and(|share| lattice.is_of_level(*id, share))
            });
        } else {
            let sieve = self.sieve.as_ref();
            let local = sieve.map(Sieve::local);
            let area = sieve.and_then(Sieve::area);
            self.keep_inside((local.as_ref(), area), &all, &mut found);
        }
        Missing(found.into())
    }

    /// Adds those of some ids, in order, whose points lie inside: the sieve's, and in what of its area matters to them.
    fn keep_inside(
        &self,
        (sieve, area): (Option<&LocalSieve>, Option<&Area>),
        ids: &[PointId],
        found: &mut Vec<PointId>,
    ) {
        /// So many are compared with the whole area. Where there are more, they are halved, and so is the area.
        const TOGETHER: usize = 16;
        if self.stop.is_raised() || area.and_then(Area::is_all_or_nothing) == Some(false) {
            return;
        }
        if ids.len() > TOGETHER {
            for half in [&ids[..ids.len() / 2], &ids[ids.len() / 2..]] {
                let near = sieve.zip(area).map(|(sieve, area)| {
                    let [columns, rows] = [|id: &PointId| id.x, |id: &PointId| id.y].map(|v| {
                        let all = || half.iter().map(v);
                        all().min().unwrap_or(0)..all().max().unwrap_or(0) + 1
                    });
                    area.focus(&sieve.world([&columns, &rows]))
                });
                self.keep_inside((sieve, near.as_ref()), half, found);
            }
            return;
        }
        let is_inside = |id: &&PointId| {
            let Some([x, y]) = self.lattice.place_of_any(**id) else {
                return false;
            };
            let at = [x, y].map(|k| self.lattice.world(k));
            self.x.bounds.contains(&x)
                && self.y.bounds.contains(&y)
                && area.is_none_or(|area| area.contains(at))
                && sieve.is_none_or(|sieve| sieve.is_clear(at))
        };
        found.extend(ids.iter().filter(is_inside));
    }

    /// A sieve that leaves all points of the box.
    fn box_sieve(&self) -> Sieve {
        let Self { lattice, x, y, .. } = self;
        let corner =
            |end: fn(&Range<i128>) -> i128| [x, y].map(|span| lattice.world(end(&span.bounds)));
        let within = Region::between(corner(|range| range.start), corner(|range| range.end));
        let mask = Mask::default().and_within(within.into());
        Sieve::new(lattice, (mask, self.region), [x.reach, y.reach]).of_box()
    }

    /// The bands that the scope touches.
    pub(crate) fn bands(&self) -> Range<i64> {
        let columns = &self.x.all;
        if columns.is_empty() || self.y.all.is_empty() {
            return 0..0;
        }
        columns.start.div_euclid(BAND_WIDTH)..(columns.end - 1).div_euclid(BAND_WIDTH) + 1
    }

    /// The lattice of the set.
    pub(crate) fn whole_lattice(&self) -> &Lattice {
        self.in_field.as_ref().unwrap_or(&self.lattice)
    }
}
