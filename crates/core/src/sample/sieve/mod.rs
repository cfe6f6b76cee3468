//! Sieves: which points of a plan's box are requested, where not all of them are.
//!
//! The work narrows in five stages, each of which leaves less to the next:
//!
//! 1. [`Sieve`] (`whole`) has the conditions on all points of a plan: an area, and other sets to keep clear
//!    of.
//! 2. [`LocalSieve`] (`local`) is aimed at a band and then at a patch: `Area::focus` drops every shape and
//!    edge that does not matter there.
//! 3. For a strip of a few rows, `Area::steps` returns the stretches of x that are inside, outside, or to
//!    be tested.
//! 4. [`LocalSieve::runs`] turns stretches into [`Run`]s of lattice columns. Runs that pass are copied or
//!    counted at full speed.
//! 5. In other runs [`LocalSieve::passes`] tests each point, against the few edges that touch its stretch
//!    where these are known (`shape::Near`).

mod local;
mod scale;
mod whole;

pub(super) use local::{LocalSieve, Run, STRIP_ROWS};
pub(super) use scale::Scale;
pub(super) use whole::Sieve;
