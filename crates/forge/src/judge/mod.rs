//! Acceptance: a table is judged on point sets it was not optimized on.
//!
//! A table can look perfect on the twins it was optimized on and hide pairs of blocks that meet
//! only elsewhere. So it is measured on larger twins, on both sides of α, and on windows cut from
//! the unbounded pattern of α itself.
//!
//! A [`Panel`] holds these point sets and measures a table on each: the figures of `figure`, and
//! those of `curve` if there is a power curve to follow. A [`Bound`] limits a figure; a table is
//! accepted if there are no [`complaints`]. The bounds of custom curves, and how near a table came
//! to its curve, are computed in `curve`.

mod curve;
mod figure;
mod panel;

pub use curve::{Nearness, TARGET_RING, bounds_of_curve, curve_figures};
pub(crate) use figure::named;
pub use figure::{Bound, Complaint, Figure, RING_WIDTH, Side, complaints, figures, gravest};
pub(crate) use panel::measured;
pub use panel::{JUDGED_POINTS, Panel};
