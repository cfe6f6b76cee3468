//! Tables made from others: with kinds.

use alloc::vec::Vec;

use super::{
    Mix, Ranks, Table,
    file::{read_labels, write_labels},
};
use crate::error::Error;

impl Table {
    /// This table with kinds of points, and with ranks made for them: an order in which the kinds keep their
    /// shares as blocks leave.
    ///
    /// # Errors
    /// [`ErrorKind::Table`](crate::ErrorKind::Table) for a mix of another map, or unless there is a position for
    /// each block.
    pub fn with_mix(&self, mix: Mix, ranks: Ranks) -> Result<Self, Error> {
        let mut parts = self.parts().clone();
        (parts.mix, parts.ranks) = (Some(mix), Some(ranks));
        Self::of_parts(parts)
    }

    /// This table with the kinds and ranks of a file of [labels](Self::labels_of).
    ///
    /// # Errors
    /// [`ErrorKind::Table`](crate::ErrorKind::Table) and its like for a file that is damaged, is no file of labels, or
    /// has those of another table.
    ///
    /// ```
    /// use strew_core::{Table, table::{Mix, Ranks}};
    ///
    /// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let mix = Mix::scattered(table.map(), "1:3".parse()?)?;
    /// let ranks = Ranks::new((0..mix.labels().len() as u32).collect())?;
    /// let labels = table.labels_of(&mix, &ranks);
    /// assert!(labels.len() < table.to_bytes().len());
    /// let mixed = table.with_labels(&labels)?;
    /// assert_eq!(mixed, table.with_mix(mix, ranks)?);
    /// assert!(mixed.with_labels(&labels).is_err(), "the labels are of the table without");
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn with_labels(&self, labels: &[u8]) -> Result<Self, Error> {
        let (mix, ranks) = read_labels(labels, self)?;
        self.with_mix(mix, ranks)
    }

    /// A file of kinds and ranks for this table, without its vectors: about three bytes for each block instead of eleven.
    #[must_use]
    pub fn labels_of(&self, mix: &Mix, ranks: &Ranks) -> Vec<u8> {
        write_labels(self, mix, ranks)
    }
}
