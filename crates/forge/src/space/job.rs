//! A job: the table of points in space to make, and the phases of its making.

use strew_core::{Alpha, Map};

use super::{
    descent::Rule,
    pairs::{Gaussian, LONGEST, longest},
};
use crate::{ForgeError, MAX_STEPS};

/// The table to make. Equal jobs make the same table, bit for bit, on every machine and with any number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceJob {
    /// The noise profile.
    pub profile: SpaceProfile,
    /// The α of the pattern.
    pub alpha: Alpha,
    /// The half-width of the map: 16 has 21 intervals at the default α.
    pub radius: u32,
    /// The seed of the random start.
    pub seed: u64,
    /// The number of steps of all phases together; the profile's own if `None`.
    pub steps: Option<u32>,
}

/// A noise profile of points in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpaceProfile {
    /// Blue noise: a low Gaussian energy.
    Blue,
    /// Points as far apart as they go: blue noise, then pushes.
    Spaced,
}

impl SpaceProfile {
    /// All profiles.
    pub const ALL: [Self; 2] = [Self::Blue, Self::Spaced];

    /// The name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Blue => "blue",
            Self::Spaced => "spaced",
        }
    }

    /// The profile with a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|profile| profile.name() == name)
    }
}

impl SpaceJob {
    /// The default job of a profile: α = (5−√3)/2 and 21 intervals.
    ///
    /// # Panics
    /// Never: the text is an α.
    #[must_use]
    pub fn new(profile: SpaceProfile) -> Self {
        let alpha = "(5-sqrt(3))/2".parse();
        Self {
            profile,
            alpha: alpha.unwrap_or_else(|error| unreachable!("{error}")),
            radius: 16,
            seed: 1,
            steps: None,
        }
    }

    /// The maps of the coarse phase and of all others. Fails for a part of the job that is not allowed.
    pub(super) fn maps(&self) -> Result<[Map; 2], ForgeError> {
        if longest(self.alpha) < LEAST_REACH {
            let allowed = "in space at least 1.51: below, vectors are too short";
            return Err(ForgeError::field("alpha", self.alpha, allowed));
        }
        ForgeError::unless_in_range("steps", self.steps.unwrap_or(1), MAX_STEPS)?;
        ForgeError::unless_in_range("R", self.radius, MAX_SPACE_RADIUS)?;
        let coarse = (self.radius * 11).div_ceil(16).max(1);
        let map = Map::new(self.alpha, self.radius)?;
        let intervals = map.intervals();
        // Block numbers fit 16 bits.
        if intervals > MAX_INTERVALS {
            let value = format!("{}, of {intervals} intervals", self.radius);
            let allowed = format!("at most {MAX_INTERVALS} intervals");
            return Err(ForgeError::field("R", value, allowed));
        }
        Ok([Map::new(self.alpha, coarse)?, map])
    }

    /// All phases, in order, with their steps. The first is on the coarse map.
    pub(super) fn phases(&self) -> Vec<(Rule, u32)> {
        let descent = |(sigma, steps)| (Rule::Descent(Gaussian { sigma }), steps);
        let mut phases = [(1.0, 150), (1.0, 120), (0.84, 300)].map(descent).to_vec();
        if self.profile == SpaceProfile::Spaced {
            phases.push((Rule::Pushes, 400));
        }
        if let Some(limit) = self.steps {
            let whole: u64 = phases.iter().map(|(_, steps)| u64::from(*steps)).sum();
            for (_, steps) in &mut phases {
                *steps = (u64::from(*steps) * u64::from(limit) / whole).max(1) as u32;
            }
        }
        phases
    }
}

/// The largest half-width R of a map in space: at the default α 29 intervals.
pub const MAX_SPACE_RADIUS: u32 = 22;
/// The largest number of intervals of a map in space.
const MAX_INTERVALS: usize = 40;
/// The least reach of vectors, in mean spacings.
const LEAST_REACH: f64 = 0.8 * LONGEST;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_fit_8_bits() {
        for text in ["1.51", "(5-sqrt(3))/2", "(1+sqrt(5))/2", "1.8"] {
            let job = SpaceJob {
                alpha: text.parse().expect("valid"),
                radius: MAX_SPACE_RADIUS,
                ..SpaceJob::new(SpaceProfile::Blue)
            };
            let [_, map] = job.maps().expect(text);
            assert!((5.6 + 5.0) / map.alpha().set_side_f64() + 1.0 < 127.0);
        }
    }
}
