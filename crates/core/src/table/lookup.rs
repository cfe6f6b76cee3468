//! The moves of many points, looked up at once.

use super::Ladder;
#[cfg(doc)]
use super::{Rung, ladder::Stage};

/// The moves of some points between two levels, as they are looked up.
#[derive(Clone, Debug)]
pub(crate) struct Lookup<const N: usize> {
    /// The vectors above and below: x in the lower 16 bits.
    pub(crate) vectors: [[u32; N]; 2],
    /// See [`Rung::event`].
    pub(crate) events: [[u8; N]; 2],
    /// Whether the table itself is the level above.
    pub(crate) is_first: [u32; N],
    /// The numbers of the [`Stage`].
    pub(crate) way: [f64; N],
    pub(crate) per_share: [f64; N],
    /// The points whose displacement is to be had one by one, and their number.
    pub(crate) others: [u32; N],
    pub(crate) number: usize,
}

impl<const N: usize> Lookup<N> {
    pub(crate) const fn new() -> Self {
        Self {
            vectors: [[0; N]; 2],
            events: [[0; N], [1; N]],
            is_first: [0; N],
            way: [0.0; N],
            per_share: [0.0; N],
            others: [0; N],
            number: 0,
        }
    }
}

impl Ladder {
    /// Looks up the moves of points by their shares and positions, of which there are at most `N`. Nothing else is
    /// done meanwhile, so that many loads wait for memory at once.
    #[inline(always)]
    pub(crate) fn look_up<const N: usize>(
        &self,
        shares: &[f64],
        positions: &[u32],
        found: &mut Lookup<N>,
    ) {
        let length = shares.len().min(positions.len()).min(N);
        let mut at = [[0u32; N]; 2];
        found.number = 0;
        for i in 0..length {
            let (share, position) = (shares[i], positions[i]);
            let below = self.below(share);
            let level = self.levels.get(below);
            let level = level.filter(|level| position < level.length && share < level.above);
            let above = self.levels[below.saturating_sub(1).min(self.levels.len() - 1)].first;
            found.is_first[i] = u32::from(below == 0);
            match level {
                Some(level) => {
                    at[0][i] = above + position;
                    at[1][i] = level.first + position;
                    found.way[i] = (level.above - share) * level.per_share;
                    found.per_share[i] = level.per_share;
                }
                None => {
                    found.others[found.number] = i as u32;
                    found.number += 1;
                    at[0][i] = 0;
                    at[1][i] = 0;
                }
            }
        }
        let packed = |[x, y]: [i16; 2]| u32::from(x as u16) | u32::from(y as u16) << 16;
        if self.rungs.is_empty() {
            return;
        }
        for i in 0..length {
            let [above, rung] = [at[0][i], at[1][i]].map(|at| self.rungs[at as usize]);
            found.vectors[0][i] = packed(above.vector);
            found.vectors[1][i] = packed(rung.vector);
            [found.events[0][i], found.events[1][i]] = rung.event;
        }
    }
}
