//! An entry of the table of parameters, for tests: what shows a parameter to users needs nothing but its entry.
//!
//! `crates/query/src/recipe.rs` has the same entry in its table, and reads and echoes it.

use strew_query::{Group, Parameter, Shape};

pub(crate) static ADDED: Parameter = Parameter {
    name: "added",
    about: "Made for a test.",
    group: Group::Window,
    shape: Shape::Integer { min: 1, max: 9 },
    default: Some("1"),
    example: "3",
    is_echoed: true,
    ..Parameter::PLAIN
};
