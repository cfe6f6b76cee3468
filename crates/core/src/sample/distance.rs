//! The least distance between any two points, anywhere in the plane: a promise, not a measurement.
//!
//! A neighbor at lattice offset (i, j) has its index shifted by ((αi + j)/2, (αj + i)/2). So two
//! blocks meet across that offset iff the shift carries a part of the one's interval into the
//! other's, along both axes; then they are |(i, j) + D_B − D_A| apart. There are finitely many such
//! pairs near each other, and the least of their distances is that of the whole pattern, to the bit:
//! irrational α visits every part of index space. A window shows the same least distance or, if it
//! is small, a greater one.
//!
//! In mean spacings:
//!
//! | table, (5−√3)/2 | δ_min | no warp | strength 1 | 2 | seen at 1 |
//! |---|---|---|---|---|---|
//! | blue, 63 | 0.6664 | 0.716 | 0.570 | 0.439 | 0.67 |
//! | sharp, 63 | 0.8274 | 0.889 | 0.707 | 0.545 | |
//! | spaced, 255 | 0.9383 | 1.008 | 0.802 | 0.618 | |
//!
//! The warp shrinks distances by a bounded factor (see `stretch.rs`), so the promise holds for
//! warped placements as well, if less tightly. Thinning can only widen distances.

use alloc::vec::Vec;

use super::{Sampler, Seed, Spacing, SpacingError, Warp, stretch::Stretch, warp::Shears};
use crate::{
    map::Map,
    pattern::{Axis, Pattern},
    table::FRACTION_BITS,
};

/// √(2/√3): the distance of neighbors in a hexagonal lattice, in mean spacings. No set of points
/// keeps a greater least distance.
const HEXAGONAL: f64 = 1.074_569_931_823_542;

/// The least distance between any two points of a sampler's unbounded point sets.
///
/// ```
/// use strew_core::{Sampler, Table, Warp};
///
/// let sampler = Sampler::new(Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?);
/// let least = sampler.least_distance();
/// assert!(least.is_promised());
/// assert!(least.with_warp(Warp::ON) < least.with_warp(Warp::OFF));
/// let spacing = least.spacing_for(2.0, Warp::ON)?;
/// assert!(spacing.get() * least.with_warp(Warp::ON) >= 2.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastDistance {
    /// The square, in units of 2⁻²⁰ grid units.
    squared: u64,
    /// t: mean spacings per grid unit.
    set_side: f64,
}

/// Why there is no spacing for a distance.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DistanceError {
    /// The table's points come so near each other that a least distance would mean little.
    #[error(
        "this profile promises no least distance: its nearest points are {relative:.4} of the \
         hexagonal distance apart; at least {min} is needed",
        min = LeastDistance::MIN_RELATIVE
    )]
    NoPromise {
        /// [`LeastDistance::relative`].
        relative: f64,
    },
    /// The distance is not a number greater than 0.
    #[error("min_distance is {0}; it must be a finite number greater than 0")]
    Distance(f64),
    /// The spacing it takes is not allowed.
    #[error("min_distance {distance:e} cannot be kept: {source}")]
    Spacing {
        /// The distance asked for.
        distance: f64,
        /// What is wrong with the spacing.
        source: SpacingError,
    },
}

impl Sampler {
    /// The least distance between any two points, exactly.
    ///
    /// It looks at every pair of blocks that can meet near each other: 0.3 ms for 63 intervals, 5 ms
    /// for 255. Keep the answer; it does not change.
    #[must_use]
    pub fn least_distance(&self) -> LeastDistance {
        LeastDistance {
            squared: least_squared(self),
            set_side: self.table().alpha().set_side_f64(),
        }
    }
}

impl LeastDistance {
    /// A table promises a distance from this part of the hexagonal distance on.
    pub const MIN_RELATIVE: f64 = 0.3;
    /// What [`spacing_for`](Self::spacing_for) adds, so that rounding takes nothing away.
    const MARGIN: f64 = 1e-6;

    /// Without warp, in units of the hexagonal distance √(2/√3) at the same density: δ_min, at
    /// most 1.
    #[must_use]
    pub fn relative(&self) -> f64 {
        self.with_warp(Warp::OFF) / HEXAGONAL
    }

    /// In mean spacings, for a strength of the warp and every seed: no two points are nearer.
    ///
    /// Without warp it is attained. With it, it is a bound: the table's distance divided by what
    /// the warp shrinks at most.
    #[must_use]
    pub fn with_warp(&self, warp: Warp) -> f64 {
        // The amplitudes are the same for every seed.
        let shears = Shears::new(warp, Seed(0), self.set_side);
        let Stretch { factor, slack } = Stretch::of(shears.as_ref());
        let units = libm::sqrt(self.squared as f64) / factor - 2.0 * slack;
        units.max(0.0) / f64::from(1u32 << FRACTION_BITS) * self.set_side
    }

    /// Whether the table promises a distance: δ_min is at least
    /// [`MIN_RELATIVE`](Self::MIN_RELATIVE).
    #[must_use]
    pub fn is_promised(&self) -> bool {
        self.relative() >= Self::MIN_RELATIVE
    }

    /// The mean spacing at which no two points are nearer than `distance` world units, with this
    /// strength of the warp, whatever the seed.
    ///
    /// It is 10⁻⁶ wider than the bound asks for, which outweighs the rounding of reported
    /// coordinates up to 10⁸ spacings from the origin. Farther out a coordinate x is itself only
    /// good to x·2⁻⁵², and a distance to three times that.
    ///
    /// # Errors
    /// [`DistanceError`] if the table promises no distance, or the distance is not a finite number
    /// greater than 0, or needs a spacing outside [`Spacing`]'s range.
    pub fn spacing_for(&self, distance: f64, warp: Warp) -> Result<Spacing, DistanceError> {
        if !(distance.is_finite() && distance > 0.0) {
            return Err(DistanceError::Distance(distance));
        }
        let kept = self.with_warp(warp);
        if !self.is_promised() || kept <= 0.0 {
            let relative = self.relative();
            return Err(DistanceError::NoPromise { relative });
        }
        Spacing::new(distance / kept * (1.0 + Self::MARGIN))
            .map_err(|source| DistanceError::Spacing { distance, source })
    }
}

/// Offsets up to this are looked at. It is enough for t ≥ 0.017 with the longest displacements
/// there are; sparser patterns, α below 1.035, promise nothing.
const MAX_REACH: i64 = 320;

/// The least squared distance over all pairs of blocks that meet, in fixed-point units.
fn least_squared(sampler: &Sampler) -> u64 {
    let (map, vectors) = (sampler.map(), sampler.table().displacements());
    let n = map.intervals();
    // Displacements differ by the span at most, so only offsets within it and the distance matter.
    let span = sampler
        .reach
        .map(|[low, high]| i64::from(high) - i64::from(low));
    let hexagonal = HEXAGONAL / map.alpha().set_side_f64() * f64::from(1u32 << FRACTION_BITS);
    let reach = span.map(|s| (s.saturating_add(hexagonal as i64) >> FRACTION_BITS) + 1);
    if reach[0].max(reach[1]) > MAX_REACH {
        return 0;
    }
    let mut least = (hexagonal * hexagonal) as u64 + 1;
    let meetings = Meetings::new(map, reach[0].max(reach[1]));

    let mut offsets: Vec<(u64, i64, i64)> = Vec::new();
    for j in 0..=reach[1] {
        // The other half are the same pairs, seen from the other end.
        let first = if j == 0 { 1 } else { -reach[0] };
        for i in first..=reach[0] {
            let gap = |v: i64, span: i64| ((v.abs() << FRACTION_BITS) - span).max(0);
            offsets.push((norm(gap(i, span[0]), gap(j, span[1])), i, j));
        }
    }
    // What can be nearest comes first: most of the rest need not be looked at.
    offsets.sort_unstable_by_key(|&(nearest, i, j)| (nearest, i * i + j * j));
    for (nearest, i, j) in offsets {
        if nearest >= least {
            break;
        }
        let (x, y) = (i << FRACTION_BITS, j << FRACTION_BITS);
        let columns = meetings.of(i, j);
        for row in meetings.of(j, i) {
            let (own, other) = (
                &vectors[row[0] as usize * n..],
                &vectors[row[1] as usize * n..],
            );
            for column in columns {
                let (a, b) = (own[column[0] as usize], other[column[1] as usize]);
                let dx = x + i64::from(b[0]) - i64::from(a[0]);
                let dy = y + i64::from(b[1]) - i64::from(a[1]);
                least = least.min(norm(dx, dy));
            }
        }
    }
    least
}

/// The squared length. Components stay below 2³⁰.
fn norm(x: i64, y: i64) -> u64 {
    (x * x + y * y) as u64
}

/// Which intervals meet across an offset, along one axis: (own, neighbor's). The axes are alike: the
/// shift of X by (i, j) is that of Y by (j, i).
struct Meetings {
    reach: i64,
    /// By offset along the axis, then parity of the offset across it.
    pairs: Vec<Vec<[u32; 2]>>,
}

impl Meetings {
    fn new(map: &Map, reach: i64) -> Self {
        let pattern = Pattern::new(map.alpha());
        let pairs = (-reach..=reach)
            .flat_map(|own| [(own, 0), (own, 1)])
            .map(|(own, across)| meet(map, pattern.axis_index(Axis::X, own, across)))
            .collect();
        Self { reach, pairs }
    }

    fn of(&self, own: i64, across: i64) -> &[[u32; 2]] {
        &self.pairs[(own + self.reach) as usize * 2 + (across & 1) as usize]
    }
}

/// The pairs of intervals that a shift carries into each other, if only by one unit.
fn meet(map: &Map, shift: u64) -> Vec<[u32; 2]> {
    let side = i128::from(map.alpha().set_side());
    // The circle is longer than twice the set region: there is one way round.
    let shift = i128::from(shift as i64);
    let mut pairs = Vec::new();
    for from in 0..map.intervals() {
        let own = map.interval(from);
        let mut at = (i128::from(own.start) + shift).max(0);
        let end = (i128::from(own.end) + shift).min(side);
        while at < end {
            let to = map.locate(at as u64);
            pairs.push([from as u32, to as u32]);
            at = i128::from(map.interval(to).end);
        }
    }
    pairs
}
