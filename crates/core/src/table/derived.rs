//! Tables made from others: with ranks or kinds.

use super::{Mix, Ranks, Table};
use crate::error::Error;

impl Table {
    /// This table with an order in which its blocks leave.
    ///
    /// # Errors
    /// [`ErrorKind::Table`](crate::ErrorKind::Table) unless there is a position for each block.
    ///
    /// ```
    /// use strew_core::{Table, table::Ranks};
    ///
    /// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let blocks = table.displacements().len() as u32;
    /// let ranked = table.with_ranks(Ranks::new((0..blocks).rev().collect())?)?;
    /// assert_eq!(ranked.displacements(), table.displacements());
    /// assert_ne!(ranked.digest(), table.digest());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn with_ranks(&self, ranks: Ranks) -> Result<Self, Error> {
        let mut parts = self.parts().clone();
        parts.ranks = Some(ranks);
        Self::of_parts(parts)
    }

    /// This table with kinds of points, and with ranks made for them: an order in which the kinds keep their
    /// shares as blocks leave.
    ///
    /// # Errors
    /// [`ErrorKind::Table`](crate::ErrorKind::Table) for a mix of another map, or unless there is a position for
    /// each block.
    ///
    /// ```
    /// use strew_core::{Table, table::{Mix, Ranks}};
    ///
    /// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let blocks = table.displacements().len() as u32;
    /// let mix = Mix::scattered(table.map(), "1:3".parse()?)?;
    /// let mixed = table.with_mix(mix.clone(), Ranks::new((0..blocks).collect())?)?;
    /// assert_eq!(mixed.mix(), Some(&mix));
    /// assert_eq!(mixed.displacements(), table.displacements());
    /// assert_ne!(mixed.digest(), table.digest());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn with_mix(&self, mix: Mix, ranks: Ranks) -> Result<Self, Error> {
        let mut parts = self.parts().clone();
        (parts.mix, parts.ranks) = (Some(mix), Some(ranks));
        Self::of_parts(parts)
    }
}
