//! What tables of the plane and of space have of their own: their vectors.

use alloc::{string::String, vec::Vec};
use core::fmt::Debug;

/// The displacement of a block as a table and its file hold it.
pub trait Vector: Copy + Debug + Default + PartialEq {
    /// The number of axes.
    const AXES: u32;
    /// The section of the file that has the vectors.
    const SECTION: [u8; 4];
    /// The sections that such a file may not have, and why.
    const FOREIGN: &[([u8; 4], &str)];
    /// What is derived from the vectors and kept with the table.
    type Held;

    /// Derives it.
    fn held(vectors: &[Self]) -> Self::Held;

    /// The vector and what is allowed, if it is too long.
    fn too_long(&self) -> Option<[String; 2]>;

    /// The vector of as many bytes as it has in memory.
    fn read(bytes: &[u8]) -> Self;

    /// Appends the vector to a section.
    fn write(&self, section: &mut Vec<u8>);
}
