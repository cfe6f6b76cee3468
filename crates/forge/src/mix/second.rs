//! The second order of blocks: kinds whose shares vary from place to place are cut from it.
//!
//! The points whose second rank lies in an interval must be evenly spread, among all points and among those that
//! are left when a set is thinned out by the ranks of its table. So the second order is that of a mix whose kinds
//! are the points by when they leave: the first quarter of the ranks, the second, and the upper half.

use strew_core::{
    Table,
    table::{Mix, Ranks, Shares},
};

use super::order;
use crate::{
    ForgeError,
    watch::{Meter, Stage, Watch},
};

/// The parts of the ranks that are each evenly ordered. More of them are no more even when thinned out, and
/// less so as a whole.
const PARTS: &str = "1:1:2";

/// Makes the second order of a table's blocks: the ranks of [`VaryingKinds`](strew_core::VaryingKinds). Takes about
/// a second on map m. `None` if it was stopped.
///
/// # Errors
/// [`ForgeError`] if the table has too few blocks.
///
/// ```
/// use strew_core::Table;
/// use strew_forge::second_order;
///
/// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let order = second_order(&table, &())?.expect("not stopped");
/// assert_eq!(order.positions().len(), table.displacements().len());
/// // It is another order than that in which points leave.
/// assert_ne!(Some(&order), table.ranks());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn second_order(table: &Table, watch: &dyn Watch) -> Result<Option<Ranks>, ForgeError> {
    let shares: Shares = PARTS.parse()?;
    let sums = shares.parts().iter().scan(0.0, |sum, part| {
        *sum += f64::from(*part);
        Some(*sum / f64::from(shares.total()))
    });
    let ends: Vec<f64> = sums.take(shares.kinds() - 1).collect();
    let label = |block: usize| {
        let ranks = table.block_ranks(block);
        let middle = 0.5 * (ranks.start + ranks.end);
        ends.partition_point(|end| *end <= middle) as u8
    };
    let labels = (0..table.displacements().len()).map(label).collect();
    let mix = Mix::new(table.map(), shares, labels)?;
    let mut meter = Meter::new(watch, Stage::Optimizing, order::STEPS);
    order::order(table, &mix, &mut meter)
}
