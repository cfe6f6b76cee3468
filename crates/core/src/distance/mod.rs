//! The least distance between any two points, of the plane or of space: a guarantee, not a measurement.
//!
//! A neighbor at lattice offset (i, j) has its index shifted by ((αi + j)/2, (αj + i)/2). So two blocks
//! meet across that offset iff the shift carries a part of one's interval into the other's along all
//! axes, and then they are |(i, j) + D_B − D_A| apart. Few such pairs are near each other, and the least
//! of their distances is that of the whole pattern, to the bit, since an irrational α visits every part
//! of index space. A window shows this distance, or a larger one if it is small.
//!
//! In the plane, in mean spacings:
//!
//! | table, (5−√3)/2 | δ_min | no warp | strength 1 | 2 | seen at 1 |
//! |---|---|---|---|---|---|
//! | blue, 129 | 0.6665 | 0.716 | 0.627 | 0.542 | 0.65 |
//! | sharp, 63 | 0.8274 | 0.889 | 0.778 | 0.673 | |
//! | spaced, 255 | 0.9383 | 1.008 | 0.883 | 0.763 | |
//!
//! The warp shrinks distances by a bounded factor, so the guarantee holds for warped sets as well, less
//! tightly. Thinning only widens distances.

mod pairs;

use alloc::string::String;

use pairs::{densest, least_of_kinds, least_squared};

use crate::{
    error::{Error, ErrorKind, number, rounded},
    lattice::{Spacing, seed::Seed},
    pattern::Alpha,
    space,
    table::{FRACTION_BITS, Table},
    warp::{Shears, Stretch, Warp, Waves},
};

/// The least distance between any two points of a table's unbounded point sets, or between any two of some
/// kinds.
///
/// ```
/// use strew_core::{Table, Warp};
///
/// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let least = table.least_distance();
/// assert!(least.is_useful());
/// assert!(least.with_warp(Warp::ON) < least.with_warp(Warp::OFF));
/// let spacing = least.spacing_for(2.0, Warp::ON)?;
/// assert!(spacing.get() * least.with_warp(Warp::ON) >= 2.0);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastDistance {
    /// The square of the distance, in units of 2⁻²⁰ grid units.
    squared: u64,
    /// t, the mean spacings per grid unit.
    set_side: f64,
    /// The share of all points that the distance is about: 1, or that of one kind.
    share: f64,
    /// The waves of the warp of a table of the plane.
    waves: Option<Waves>,
}

impl Table {
    /// The least distance between any two points, exactly.
    ///
    /// The first call visits every pair of blocks that can meet near each other: 0.3 ms for 63
    /// intervals, 5 ms for 255. Later calls, on clones too, return the same answer at once (with the
    /// feature `std`).
    #[must_use]
    pub fn least_distance(&self) -> LeastDistance {
        let vectors = self.displacements();
        let squared = self.least_squared(|| least_squared(self.map(), vectors));
        LeastDistance::new(squared, self.alpha(), Some(Waves::of(self.profile())))
    }

    /// The least distance between a point of one kind and one of another, or between two of the same kind; `None`
    /// if the table has no such kinds. Kinds are numbered in the order of the
    /// [shares](crate::table::Mix::shares).
    ///
    /// A block that is [split](crate::table::Split) counts for both of its kinds, so distances may be a little
    /// larger in truth. Two kinds of which no points are nearer than the hexagonal distance of the rarer kind have
    /// that distance here.
    ///
    /// The first call visits the pairs of blocks that can meet within the distances of the rarest kind: some ten
    /// milliseconds for 129 intervals and common kinds.
    #[must_use]
    pub fn least_distance_of(&self, a: u8, b: u8) -> Option<LeastDistance> {
        let (mix, labels) = (self.mix()?, self.labels()?);
        let shares = mix.shares();
        let [row, column] = [a, b].map(usize::from);
        if row.max(column) >= shares.kinds() {
            return None;
        }
        let all = self.least_of_kinds(|| least_of_kinds(self, shares, labels).into());
        Some(LeastDistance {
            squared: all[row * shares.kinds() + column],
            share: if a == b { shares.of(a) } else { 1.0 },
            ..self.least_distance()
        })
    }
}

impl space::Table {
    /// The least distance between any two points of the table's sets. The first call looks at the pairs of blocks that can
    /// meet near each other.
    #[must_use]
    pub fn least_distance(&self) -> LeastDistance {
        let squared = self.least_squared(|| least_squared(self.map(), &self.fixed_vectors()));
        LeastDistance::new(squared, self.map().alpha(), None)
    }
}

impl LeastDistance {
    /// The least distance of all points; `waves` are those of a table of the plane.
    fn new(squared: u64, alpha: Alpha, waves: Option<Waves>) -> Self {
        Self {
            squared,
            set_side: alpha.set_side_f64(),
            share: 1.0,
            waves,
        }
    }

    /// The least [`relative`](Self::relative) distance that is useful.
    pub const MIN_RELATIVE: f64 = 0.3;
    /// Reported `f64` coordinates keep [`reported`](Self::reported) distances out to this many of them from
    /// the origin, 2³⁰. Farther out the rounding of coordinates takes more from a distance.
    pub const RANGE: f64 = 1_073_741_824.0;
    /// The part by which [`spacing_for`](Self::spacing_for) widens a spacing, more than rounding takes within
    /// [`RANGE`](Self::RANGE): 2³⁰ · 2⁻⁵⁰.
    const MARGIN: f64 = 1e-6;
    /// The loss of a distance to rounding, per unit of the largest coordinate. A coordinate is rounded
    /// twice, by 2⁻⁵³ of itself each, and a distance changes by up to 2√2 times that much.
    const ROUNDING: f64 = 1.0 / (1u64 << 50) as f64;

    /// δ_min: the distance without warp in units of that of the densest packing at the same density, √(2/√3) mean
    /// spacings in the plane and 2^(1/6) in space; at most 1. Within a kind the density is that of the kind, between two
    /// kinds that of all points.
    #[must_use]
    pub fn relative(&self) -> f64 {
        self.relative_to_all() * libm::sqrt(self.share)
    }

    /// The guaranteed distance in mean spacings, for a strength of the warp and every seed. It is that of
    /// exact positions; [`reported`](Self::reported) has that of coordinates.
    ///
    /// Without warp it is attained. With warp it is a bound: the table's distance divided by the largest
    /// factor by which the warp shrinks distances.
    #[must_use]
    pub fn with_warp(&self, warp: Warp) -> f64 {
        // All seeds have the same amplitudes.
        let Stretch { factor, slack } = match self.waves {
            Some(waves) => Stretch::of(Shears::new(waves, warp, Seed(0)).as_ref()),
            None => space::stretch(warp),
        };
        let units = libm::sqrt(self.squared as f64) / factor - 2.0 * slack;
        units.max(0.0) / f64::from(1u32 << FRACTION_BITS) * self.set_side
    }

    /// The distance in world units that reported `f64` coordinates keep, for a spacing, a strength of the
    /// warp and every seed: the [guaranteed](Self::with_warp) one less what rounding takes. `reach` is the
    /// largest absolute coordinate of a point, at least 0. Up to [`RANGE`](Self::RANGE) times the distance
    /// the answer is the same, and nearly all of the guaranteed one; far beyond it is 0.
    ///
    /// Coordinates relative to a chunk reach no farther than its size ([`Offsets`](crate::Offsets)).
    #[must_use]
    pub fn reported(&self, spacing: Spacing, warp: Warp, reach: f64) -> f64 {
        let exact = self.with_warp(warp) * spacing.get();
        (exact - Self::ROUNDING * reach.max(Self::RANGE * exact)).max(0.0)
    }

    /// Whether δ_min is at least [`MIN_RELATIVE`](Self::MIN_RELATIVE), at the density of all points.
    #[must_use]
    pub fn is_useful(&self) -> bool {
        self.relative_to_all() >= Self::MIN_RELATIVE
    }

    /// δ_min at the density of all points.
    fn relative_to_all(&self) -> f64 {
        let dimensions = if self.waves.is_some() { 2 } else { 3 };
        self.with_warp(Warp::OFF) / densest(dimensions)
    }

    /// The mean spacing at which no two points are nearer than `distance` world units, for a strength of
    /// the warp and every seed.
    ///
    /// It is 10⁻⁶ wider than the bound requires, which outweighs the rounding of reported `f64` coordinates
    /// out to [`RANGE`](Self::RANGE) times the distance from the origin. Farther out
    /// [`reported`](Self::reported) is less than the distance.
    ///
    /// # Errors
    /// [`ErrorKind::Distance`] unless the distance is a positive finite number,
    /// [`ErrorKind::NoLeastDistance`] if the table's distance is not [useful](Self::is_useful), and
    /// [`ErrorKind::Spacing`] if the spacing would leave [`Spacing`]'s range.
    pub fn spacing_for(&self, distance: f64, warp: Warp) -> Result<Spacing, Error> {
        let refused =
            |kind, allowed: String| Error::new(kind, "min_distance", number(distance), allowed);
        if !(distance.is_finite() && distance > 0.0) {
            return Err(refused(
                ErrorKind::Distance,
                "a finite number greater than 0".into(),
            ));
        }
        let kept = self.with_warp(warp);
        if !self.is_useful() || kept <= 0.0 {
            let packing = match self.waves {
                Some(_) => "hexagonal",
                None => "densest packing's",
            };
            let problem = alloc::format!(
                "the profile guarantees no least distance: its nearest points are {} of the {packing} \
                 distance apart, and at least {} is needed",
                rounded(self.relative_to_all(), 4),
                number(Self::MIN_RELATIVE)
            );
            return Err(refused(ErrorKind::NoLeastDistance, String::new()).because(problem));
        }
        Spacing::new(distance / kept * (1.0 + Self::MARGIN)).map_err(|error| {
            refused(
                ErrorKind::Spacing,
                alloc::format!("a distance with a {error}"),
            )
        })
    }
}
