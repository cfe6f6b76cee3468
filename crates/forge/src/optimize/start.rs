//! The random start of a table.

use crate::numeric::SplitMix;

/// Returns a vector for each block, uniformly random in a square of half-width `jitter`.
///
/// The half-width should be small: from a large random start, pairs of blocks that seldom meet
/// settle on top of each other.
#[must_use]
pub fn jitter(blocks: usize, jitter: f64, seed: u64) -> Vec<[f64; 2]> {
    let mut random = SplitMix::new(seed);
    let mut next = || (2.0 * random.next_f64() - 1.0) * jitter;
    (0..blocks).map(|_| [next(), next()]).collect()
}
