//! The arrays of a binary glTF file: which ones a node has, their types and sizes.
//!
//! All nodes have the same arrays, because they follow from the columns of the answer. So the size of a point, and with
//! it that of the file, is known before any point is made.

use crate::{pose::Pose, schema::Schema};

/// An array of a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Array<'a> {
    pub(super) name: &'a str,
    /// The glTF type of its items, such as `VEC3`.
    pub(super) items: &'static str,
    /// The glTF code of the type of their numbers: 5126 is `f32`, 5123 `u16`.
    pub(super) numbers: u32,
    /// The bytes of an item.
    pub(super) bytes: u64,
}

/// The arrays that each node of an answer has.
#[derive(Clone, Debug)]
pub(super) struct Arrays {
    /// Whether points have a rotation, and whether they have a scale.
    pub(super) is_turned: bool,
    pub(super) is_scaled: bool,
    /// Whether ids have a third part.
    pub(super) is_in_space: bool,
    /// The names of the arrays of further numbers: `_` and the column's name in capitals.
    pub(super) others: Vec<String>,
}

impl Arrays {
    pub(super) fn new(schema: &Schema, pose: &Pose) -> Self {
        let others = pose.others.iter().map(|i| {
            let letter = |c: char| {
                if c.is_ascii_alphanumeric() {
                    c.to_ascii_uppercase()
                } else {
                    '_'
                }
            };
            let name = schema.columns()[*i].name.chars().map(letter);
            format!("_{}", name.collect::<String>())
        });
        Self {
            is_turned: pose.is_turned(),
            is_scaled: pose.is_scaled(),
            is_in_space: schema.is_in_space(),
            others: others.collect(),
        }
    }

    /// The arrays in their order.
    pub(super) fn listed(&self) -> impl Iterator<Item = Array<'_>> {
        let of_floats = |name, items, bytes| Array {
            name,
            items,
            numbers: 5126,
            bytes,
        };
        let rotation = self.is_turned.then(|| of_floats("ROTATION", "VEC4", 16));
        let scale = self.is_scaled.then(|| of_floats("SCALE", "VEC3", 12));
        let id = Array {
            name: "_ID",
            items: "VEC4",
            numbers: 5123,
            bytes: 8,
        };
        let third = self.is_in_space.then_some(Array {
            name: "_ID_Z",
            items: "VEC2",
            numbers: 5123,
            bytes: 4,
        });
        let others = self.others.iter();
        let others = others.map(move |name| of_floats(name, "SCALAR", 4));
        [of_floats("TRANSLATION", "VEC3", 12)]
            .into_iter()
            .chain(rotation)
            .chain(scale)
            .chain([id])
            .chain(third)
            .chain(others)
    }

    /// The bytes of a point in all arrays.
    pub(super) fn point_bytes(&self) -> u64 {
        self.listed().map(|array| array.bytes).sum()
    }
}
