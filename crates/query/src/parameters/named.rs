//! Parameters of what a server names: worlds and lists of points.

use strew_catalog::except::MOST_GIVEN;

use crate::{
    parameter::{Group, Parameter},
    shape::Shape,
};

pub(super) const WORLD: Parameter = Parameter {
    name: "world",
    about: "The world that everything is taken from that the query leaves open: layers or a set of \
            points, seed, limit, format. The list of worlds shows what is loaded.",
    group: Group::World,
    allowed: Some("the name of a loaded world"),
    default: Some("none"),
    example: "forest",
    ..Parameter::PLAIN
};

pub(super) const WORLD_DIGEST: Parameter = Parameter {
    name: "world_digest",
    about: "The digest that the world must have: caches may keep the answer forever. If the server's world \
            has another one, the query is refused.",
    group: Group::WorldPin,
    shape: Shape::Pattern("^[0-9a-fA-F]{64}$"),
    allowed: Some("64 hexadecimal digits, as in the header strew-world, beside world"),
    default: Some("any"),
    example: "964d5f8f3b54b47d272533f84423daa3e9b1dd6624fa906325132538c062fa4a",
    ..Parameter::RARE
};

pub(super) const EXCEPT: Parameter = Parameter {
    name: "except",
    about: "The points that are left out, by their ids, lists of the server by their names, and lists that were sent \
            by their digests. Other layers keep clear of them all the same. Beside layers ids are layer/column:row. \
            The list of lists shows what is loaded.",
    group: Group::Except,
    shape: Shape::Names {
        pattern: "^(.{1,64}/)?-?[0-9]+:-?[0-9]+$|^[A-Za-z0-9_.-]{1,64}$",
    },
    allowed: Some(
        "at most 10000 ids of points (column:row, beside layers layer/column:row) and names of loaded \
                   lists or digests of sent ones, joined by commas; not with count or periodic",
    ),
    default: Some("none"),
    example: "18:-17",
    is_echoed: true,
    ..Parameter::RARE
};

/// The figure that a text repeats.
const _: () = assert!(MOST_GIVEN == 10_000);
