//! The state of a job between two steps: all that decides the next.

/// The vectors of a table in the making, and what the current phase has beside them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SpaceState {
    /// Steps of the current phase.
    pub(crate) step: u32,
    /// The vectors, in mean spacings.
    pub(crate) moves: Vec<[f64; 3]>,
    /// Of a descent; empty in pushes.
    pub(crate) momentum: Vec<[f64; 3]>,
    /// The vectors that a descent's pairs were listed for, because the order of sums follows the lists; empty before the
    /// first step.
    pub(crate) listed: Vec<[f32; 3]>,
    /// Of pushes: the greatest least distance so far, and its vectors.
    pub(crate) least: f64,
    pub(crate) best: Vec<[f64; 3]>,
}
