//! The library from outside. One binary, so that what it shares is compiled once; golden vectors, which run on other
//! processors too, and settled sets have one each. `cargo test -p strew-core --test suite NAME` runs a part.

mod attributes;
mod dimensions;
mod distance;
mod documentation;
mod field_plans;
mod field_specs;
mod kinds;
mod layers;
mod missing_pixels;
// With the labels and tables of all ratios, as in the workspace.
#[cfg(all(
    feature = "even-1-1",
    feature = "even-1-3",
    feature = "even-1-1-2",
    feature = "even-1-3-10",
    feature = "joint-1-1",
    feature = "joint-1-3",
    feature = "joint-1-1-2",
    feature = "joint-1-3-10"
))]
mod named_kinds;
mod nearest;
mod periodic;
mod space_definition;
mod space_fields;
mod space_layers;
mod subject;
mod varying;
