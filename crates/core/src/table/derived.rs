//! Tables made from others: with ranks, a ladder, or kinds.

use super::{Ladder, Mix, Ranks, Table};
use crate::error::Error;

impl Table {
    /// This table with an order in which its blocks leave, and without a ladder.
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
        (parts.ranks, parts.ladder) = (Some(ranks), None);
        Self::of_parts(parts)
    }

    /// This table with displacements for smaller shares.
    ///
    /// # Errors
    /// [`ErrorKind::Table`](crate::ErrorKind::Table) for a table without ranks, or unless each level has
    /// one vector for each block that is left above it.
    ///
    /// ```
    /// use strew_core::{Table, table::{Ladder, Ranks, Rung}};
    ///
    /// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// let blocks = table.displacements().len();
    /// let level = (0.5, vec![Rung { vector: [0, 0], event: [0, 255] }; blocks]);
    /// let ladder = Ladder::new(vec![level])?;
    /// assert!(table.with_ladder(ladder.clone()).is_err());
    /// let ranked = table.with_ranks(Ranks::new((0..blocks as u32).collect())?)?;
    /// assert_eq!(ranked.with_ladder(ladder.clone())?.ladder(), Some(&ladder));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn with_ladder(&self, ladder: Ladder) -> Result<Self, Error> {
        let mut parts = self.parts().clone();
        parts.ladder = Some(ladder);
        Self::of_parts(parts)
    }

    /// This table with kinds of points, and with ranks made for them: an order in which the kinds keep their
    /// shares as blocks leave. It has no ladder.
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
        (parts.mix, parts.ranks, parts.ladder) = (Some(mix), Some(ranks), None);
        Self::of_parts(parts)
    }
}
