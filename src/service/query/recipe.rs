//! ARCHITECTURE.md says how to add a parameter: here one is added to the table, by an entry that only
//! tests have. Flags and the API's description have tests of their own with it.

use serde_json::json;

use super::{Draft, Group, Parameter, Shape, Value, groups, parse_pairs, read_body};
use crate::service::Catalog;

/// A parameter that only tests have: they follow the recipe of ARCHITECTURE.md.
pub(super) static ADDED: Parameter = Parameter {
    name: "added",
    about: "Made for a test.",
    group: Group::Window,
    shape: Shape::Integer { min: 1, max: 9 },
    default: Some("1"),
    example: "3",
    echo: Some(|_| Some(Value::Integer(3))),
    ..Parameter::PLAIN
};

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
    let catalog = Catalog::load(true, None).expect("built in");
    let draft = Draft::of(parse_pairs("bbox=0,0,1,1&spacing=1", groups::POINTS));
    let (query, _) = draft.check(&catalog, 100).expect("a query");
    let set = query.sets[0].resolved(&[], 1.0, strew_core::Spacing::ONE, 0.5, (&[], &[]));
    assert_eq!(json!(set)["added"], json!(3));
}
