//! What tables of the plane and of space have of their own: their vectors.

use alloc::{format, string::String, vec::Vec};
use core::fmt::Debug;

use super::{
    Displacement, FRACTION_BITS, MAX_DISPLACEMENT, parts::Parts, to_grid_units, turned::PlaneParts,
};
use crate::error::number;

/// The displacement of a block as a table and its file hold it.
pub trait Vector: Copy + Debug + Default + PartialEq {
    /// The number of axes.
    const AXES: u32;
    /// The section of the file that has the vectors.
    const SECTION: [u8; 4];
    /// The sections that such a file may not have, and why.
    const FOREIGN: &[([u8; 4], &str)];
    /// What a table holds beside its parts.
    type Held;

    /// What a table of checked parts holds beside them.
    fn held(parts: &Parts<Self>) -> Self::Held;

    /// The vector and what is allowed, if it is too long.
    fn too_long(&self) -> Option<[String; 2]>;

    /// The vector of as many bytes as it has in memory.
    fn read(bytes: &[u8]) -> Self;

    /// Appends the vector to a section.
    fn write(&self, section: &mut Vec<u8>);
}

impl Vector for Displacement {
    const AXES: u32 = 2;
    const SECTION: [u8; 4] = *b"DISP";
    const FOREIGN: &[([u8; 4], &str)] = &[
        (*b"CUBE", "a table of points in space"),
        (
            *b"BASE",
            "labels of another table: Table::with_labels reads them",
        ),
    ];
    type Held = PlaneParts;

    fn held(parts: &Parts<Self>) -> PlaneParts {
        PlaneParts::new(parts)
    }

    fn too_long(&self) -> Option<[String; 2]> {
        let limit = (MAX_DISPLACEMENT as i32) << FRACTION_BITS;
        self.iter().any(|v| !(-limit < *v && *v < limit)).then(|| {
            let [x, y] = self.map(|v| number(to_grid_units(v)));
            let most = number(MAX_DISPLACEMENT);
            [
                format!("({x}, {y})"),
                format!("less than {most} grid units along an axis"),
            ]
        })
    }

    fn read(bytes: &[u8]) -> Self {
        let (numbers, _) = bytes.as_chunks();
        [0, 1].map(|axis| i32::from_le_bytes(numbers[axis]))
    }

    fn write(&self, section: &mut Vec<u8>) {
        section.extend(self.iter().flat_map(|v| v.to_le_bytes()));
    }
}
