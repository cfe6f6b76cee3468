//! Scopes: the part of a lattice that a plan covers.

use core::ops::Range;

use super::{
    field::constant,
    lattice::{BAND_WIDTH, LATTICE_LIMIT, Lattice, Multiple, Span},
    near::Mask,
    settle::Settler,
    sieve::Sieve,
};
use crate::{
    error::{Error, ErrorKind, exponential, number},
    shape::{Area, Chunk, Region},
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
    pub(crate) corner: Corner,
    /// The lattice in its field, where that has the same share in all of the scope and
    /// [`lattice`](Self::lattice) has that share.
    in_field: Option<Lattice>,
}

/// The place that offsets of points are relative to, on the fixed-point grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    /// The place in world coordinates, rounded.
    pub(crate) at: [f64; 2],
    /// The first fixed-point coordinates from there on.
    pub(crate) first: [i128; 2],
    /// The distances from the exact place to [`first`](Self::first); see [`Multiple::gap`].
    pub(crate) gap: [[f64; 2]; 2],
    /// Offsets are below this.
    pub(crate) extent: [f64; 2],
}

impl Corner {
    /// The lower corner of a box, whose sides begin at these fixed-point coordinates.
    fn of_box(lattice: &Lattice, region: Region, first: [i128; 2]) -> Self {
        let (min, max) = (region.min(), region.max());
        let gap = |axis: usize| {
            let sign = if min[axis] < 0.0 { -1 } else { 1 };
            let corner = Multiple::new(lattice.step, min[axis].abs(), sign);
            // Reported coordinates decide which is first, so it is a little beside the corner far out.
            let [gap, error] = corner.gap;
            [gap, error + lattice.world(first[axis] - corner.first)]
        };
        Self {
            at: min,
            first,
            gap: [gap(0), gap(1)],
            extent: [0, 1].map(|axis| max[axis] - min[axis]),
        }
    }

    /// The exact corner of a chunk.
    fn of_chunk(lattice: &Lattice, Chunk { size, at }: Chunk<2>) -> Self {
        let multiples = at.map(|index| Multiple::new(lattice.step, size, index));
        Self {
            at: at.map(|index| index as f64 * size),
            first: multiples.map(|multiple| multiple.first),
            gap: multiples.map(|multiple| multiple.gap),
            extent: [size; 2],
        }
    }
}

/// The fixed-point coordinates of the points of an area along both axes: of its chunks exactly, of
/// everything else by the reported coordinates. The bounds of the area are within the lattice's limit.
fn bounds(lattice: &Lattice, chunks: &[Chunk<2>], rest: Option<&Area>) -> [Range<i128>; 2] {
    let common = |a: Range<i128>, b: Range<i128>| a.start.max(b.start)..a.end.min(b.end);
    let of_box = rest.and_then(Area::bounds).map(|region| {
        let side = |i: usize| {
            let ends = [region.min()[i], region.max()[i]].map(|bound| {
                let limit = lattice.limit();
                lattice.first_at_or_above(bound.clamp(-limit, limit))
            });
            ends[0]..ends[1]
        };
        [side(0), side(1)]
    });
    let of_chunks = chunks.iter().map(|chunk| {
        chunk.at.map(|index| {
            let first = |index| Multiple::new(lattice.step, chunk.size, index).first;
            first(index)..first(index + 1)
        })
    });
    let all = of_box.into_iter().chain(of_chunks);
    let all = all.reduce(|[ax, ay], [bx, by]| [common(ax, bx), common(ay, by)]);
    all.unwrap_or([0..0, 0..0])
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
fn spans(lattice: &Lattice, bounds: [Range<i128>; 2]) -> [Span; 2] {
    let Some(settler) = Settler::new(lattice) else {
        return Span::of_box(lattice, bounds);
    };
    if bounds.iter().any(Range::is_empty) {
        return Span::of_box(lattice, bounds);
    }
    let [x, y] = Span::of_box(lattice, settler.around(&bounds));
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
        let mask = mask.clone().and_within(area);
        let area = mask.area.as_ref();
        let region = area.and_then(Area::bounds).ok_or_else(|| {
            let (field, value) = ("area", "unbounded");
            Error::new(ErrorKind::Unbounded, field, value, "within a box")
        })?;
        let limit = lattice.limit();
        for (name, value) in region.numbers() {
            if value.abs() > limit {
                let allowed = alloc::format!(
                    "within ±{} with this spacing, where f64 coordinates still keep \
                     neighbors apart",
                    exponential(limit)
                );
                let error = Error::new(ErrorKind::TooFar, name, number(value), allowed);
                return Err(error.because("too far from the origin").with_limit(limit));
            }
        }
        let (chunks, rest) = area.map_or_else(Default::default, |area| {
            (area.chunks(), area.beside_chunks())
        });
        let [x, y] = spans(lattice, bounds(lattice, &chunks, rest.as_ref()));
        let piece = [x.all.clone(), y.all.clone()];
        let share = lattice
            .grade
            .as_ref()
            .and_then(|grade| constant(lattice, grade, &piece));
        // Points settle, but those of a field not where there are none, or all.
        let stay = |share| lattice.is_in_field() && (share <= 0.0 || share >= 1.0);
        let share = share.filter(|&share| lattice.settle().is_none() || stay(share));
        if let Some(share) = share {
            let area = area.cloned().unwrap_or(Area::Region(region));
            let mask = Mask { area: None, ..mask };
            return Ok(Self {
                in_field: Some(lattice.clone()),
                ..Self::new(&lattice.in_constant(share), &mask, area, stop)?
            });
        }
        debug_assert!(x.all.end < 2 * LATTICE_LIMIT && y.all.end < 2 * LATTICE_LIMIT);
        // Integers decide membership of a box, so it needs no sieve, except together with one.
        let is_box = matches!(rest, None | Some(Area::Region(_)));
        let corner = match chunks.last() {
            Some(chunk) => Corner::of_chunk(lattice, *chunk),
            None => Corner::of_box(lattice, region, [x.bounds.start, y.bounds.start]),
        };
        let sieve = if is_box && mask.clear.is_empty() && !lattice.picks() {
            None
        } else {
            let area = area.map(around_chunks);
            Sieve::new(lattice, Mask { area, ..mask }, [x.reach, y.reach])
        };
        Ok(Self {
            lattice: lattice.clone(),
            x,
            y,
            sieve,
            stop,
            region,
            corner,
            in_field: None,
        })
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
