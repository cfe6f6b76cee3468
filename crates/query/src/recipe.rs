//! ARCHITECTURE.md says how to add a parameter. Here one is added to the table by an entry that only tests have:
//! requests of its group then take it, read it from addresses and JSON, write it into bodies, and echo it.
//!
//! The program shows parameters by their entries alone. Its tests prove that with the same entry (`src/recipe.rs`):
//! - flags and their help: `cli::flags::tests::an_added_parameter_is_a_flag_with_help`,
//!   `flags_are_a_loop_over_the_table`;
//! - OpenAPI: `rest::api::document::tests::an_added_parameter_is_described`,
//!   `parameters_and_members_are_loops_over_the_table`;
//! - types of the bindings and documentation: `cli::parameters::tests::an_added_parameter_is_in_all_of_them`,
//!   `the_generated_files_are_the_committed_ones`.
//!
//! The line of the contract is the second place: `grpc::set::tests::every_parameter_of_a_set_has_its_field` fails
//! without it. The third is the effect.

use serde_json::json;
use strew_catalog::Catalog;

use super::{
    Draft, Group, Parameter, ResolvedSet, Shape, Value, groups, of, parse_pairs, read_body, schema,
};
use crate::Assets;

/// A parameter that only tests have: they follow the recipe of ARCHITECTURE.md.
pub(super) static ADDED: Parameter = Parameter {
    name: "added",
    about: "Made for a test.",
    group: Group::Window,
    shape: Shape::Integer { min: 1, max: 9 },
    default: Some("1"),
    example: "3",
    is_echoed: true,
    ..Parameter::PLAIN
};

#[test]
fn requests_of_its_group_take_it() {
    let takes = |groups| of(groups).any(|parameter| *parameter == ADDED);
    assert!(takes(groups::POINTS) && takes(groups::QUERY) && takes(groups::CHUNK));
    assert!(!takes(groups::COUNT) && !takes(groups::NEAREST));
    assert_eq!(Parameter::named("added"), Some(&ADDED));
}

#[test]
fn addresses_and_bodies_read_it_and_say_what_is_allowed() {
    let values = parse_pairs("added=3", groups::POINTS);
    assert_eq!(values.get(&ADDED), Ok(Some(3_u64)));
    let values = parse_pairs("added=10", groups::POINTS);
    let faults = values.read().expect_err("out of range");
    assert_eq!(faults.as_slice()[0].allowed, "an integer from 1 to 9");
    let draft = read_body(br#"{"added": 4}"#, groups::QUERY).expect("an object");
    assert_eq!(draft.values.get(&ADDED), Ok(Some(4_u64)));
    let refused = parse_pairs("added=3", groups::COUNT).read();
    assert!(refused.is_err(), "counts take no window");
}

#[test]
fn a_body_that_is_written_has_it() {
    let mut draft = Draft::of(parse_pairs("bbox=0,0,1,1&spacing=1", groups::POINTS));
    draft.values.replace(&ADDED, Some(Value::Integer(5)));
    assert_eq!(draft.to_body()["added"], json!(5));
}

#[test]
fn answers_echo_it() {
    let catalog = Assets::from(Catalog::load(true, None).expect("built in"));
    let draft = Draft::of(parse_pairs(
        "bbox=0,0,1,1&spacing=1&added=3",
        groups::POINTS,
    ));
    let (query, _) = draft.check(&catalog, 100).expect("a query");
    let set = query.sets[0].resolved(&[], 1.0, strew_core::Spacing::ONE, 0.5, (&[], &[]));
    assert_eq!(json!(set)["added"], json!(3));
    let described = schemars::schema_for!(ResolvedSet);
    assert_eq!(described.as_value()["properties"]["added"]["maximum"], 9);
    assert_eq!(schema(ADDED.shape)["maximum"], 9);
}
