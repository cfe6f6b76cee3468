//! Optimizing in table space: the unknowns are the n² vectors of a table, not points.

mod descent;
mod neighbors;
mod objective;
mod overlap;
mod pairs;
mod radial;
mod rings;
mod sets;
mod start;
mod state;

pub use descent::Descent;
pub use objective::Objective;
pub use pairs::Pairs;
pub use radial::Radial;
pub use rings::RadialWeights;
pub use sets::Sets;
pub use start::jitter;
pub use state::DescentState;
