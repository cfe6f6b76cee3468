//! What a call leaves for its caller.

use alloc::{string::String, vec, vec::Vec};

use strew_core::Error;

/// The output of a call.
pub enum Output {
    /// Coordinates.
    Places(Vec<[f64; 2]>),
    /// Coordinates relative to an origin.
    Near(Vec<[f32; 2]>),
    /// Integers and the bits of numbers.
    Words(Vec<u64>),
    /// Words of an error.
    Text(String),
}

impl Default for Output {
    fn default() -> Self {
        Self::Words(vec![])
    }
}

impl Output {
    /// Field, value, problem and what is allowed, with zeros between them.
    pub fn of_error(error: &Error) -> Self {
        let parts = [
            error.field(),
            error.value(),
            error.problem(),
            error.allowed(),
        ];
        Self::Text(parts.join("\0"))
    }

    /// The address of the first byte.
    pub fn start(&self) -> *const u8 {
        match self {
            Self::Places(places) => places.as_ptr().cast(),
            Self::Near(places) => places.as_ptr().cast(),
            Self::Words(words) => words.as_ptr().cast(),
            Self::Text(text) => text.as_ptr(),
        }
    }

    /// The number of bytes.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Places(places) => size_of_val(&places[..]),
            Self::Near(places) => size_of_val(&places[..]),
            Self::Words(words) => size_of_val(&words[..]),
            Self::Text(text) => text.len(),
        }
    }
}
