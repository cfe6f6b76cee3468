//! A column or row that holds points.

/// A column or row that holds points: its coordinate, and its interval of dX or dY.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Line {
    pub(crate) at: i64,
    pub(crate) block: u32,
    /// For a column, the strips that its dX lies in, of blocks that are partly in the set. Bit 0 is that of the
    /// [cut](crate::table::Cut), the others are those of the [kind](super::OneKind).
    pub(crate) strips: u32,
}
