//! A job: the table to make.

use strew_core::Alpha;

use crate::curve::Target;

/// The largest half-width R: 330 intervals at the default α, about 200 MB of neighbor lists.
pub const MAX_RADIUS: u32 = 256;
/// The default seed. Of the first 18 seeds it yields the flattest spectra: Bragg peaks crowd into
/// rings differently from seed to seed, and the largest radial power on twins far from α varies
/// from 2.2 to 2.8. The other figures hardly depend on the seed.
pub const DEFAULT_SEED: u64 = 17;
/// The largest number of optimizer steps.
pub const MAX_STEPS: u32 = 1_000_000;

/// The table to make. Equal jobs make the same table, bit for bit, on every machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    /// The number α.
    pub alpha: Alpha,
    /// The half-width R of the map, 1 to [`MAX_RADIUS`], in grid units. Larger maps have more
    /// blocks: every kind of error falls, and the run time grows, as the square of R.
    pub radius: u32,
    /// The name of a [`Profile`](crate::Profile), or with a `target` a new name.
    pub profile: String,
    /// The seed of the random start.
    pub seed: u64,
    /// A custom radial power curve to follow; `None` for the built-in profiles.
    pub target: Option<Target>,
    /// Steps of the optimizer, 1 to [`MAX_STEPS`]; `None` for the default of the profile. Run time
    /// is proportional to it. Fewer steps leave power at low frequencies, more sharpen the peak of
    /// the spectrum.
    pub steps: Option<u32>,
}

impl Job {
    /// The default job for an α: R = 49, profile `blue`, seed [`DEFAULT_SEED`], the default steps.
    #[must_use]
    pub fn new(alpha: Alpha) -> Self {
        Self {
            alpha,
            radius: 49,
            profile: "blue".into(),
            seed: DEFAULT_SEED,
            target: None,
            steps: None,
        }
    }
}
