//! Mixes: which kind each point is of, so that each kind is evenly spread and all of them together.
//!
//! *Labels* leave a table's points where they are: `labels` sets up an annealing of blocks (`anneal`) by how
//! much blocks press each other (`press`), a Gaussian summed by exact pair frequencies. So every twin is unseen,
//! and all points together are the table itself. A *joint* table (`joint`) also moves the points: the energy of
//! all of them and of each kind (`part`) is lowered by descent, then the few pairs that are too near
//! are pushed apart (`clear`). Either way blocks get an order of leaving made for the labels (`order`), because
//! the table's own would remove some kinds before others. It also makes the order from which kinds are cut
//! whose shares vary. `judge` measures, `make` is the way in.

mod anneal;
mod clear;
mod joint;
mod judge;
mod labels;
mod make;
mod order;
mod part;
mod press;

/// The shares of kinds, one by one.
fn each(shares: &strew_core::table::Shares) -> Vec<f64> {
    let kinds = 0..shares.kinds() as u8;
    kinds.map(|kind| shares.of(kind)).collect()
}

pub use make::{MixJob, MixOutcome, labels, mix, mix_file_name};
pub use order::second_order;
