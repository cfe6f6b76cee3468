//! Acceptance: a table is judged on point sets it was not optimized on.

mod bound;
mod curve;
mod figure;
mod nearness;
mod panel;

pub use bound::{Bound, Complaint, Side, complaints};
pub use curve::{TARGET_RING, curve_figures};
pub(crate) use figure::figures_of_spectrum;

pub use figure::{Figure, RING_WIDTH, figures_of_torus, figures_of_window};
pub use nearness::{Nearness, bounds_of_curve};
pub use panel::{JUDGED_POINTS, Panel};
