//! A column or row that holds points.

/// A column or row that holds points: its coordinate, and its interval of dX or dY.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Line {
    pub(crate) at: i64,
    pub(crate) block: u32,
    /// Of a column: whether its dX lies in the strip of the block that is partly kept.
    pub(crate) is_in_strip: bool,
}
