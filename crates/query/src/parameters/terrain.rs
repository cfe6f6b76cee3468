//! Parameters of the terrain that points stand on.

use crate::{
    parameter::{Group, Parameter},
    shape::Shape,
};

pub(super) const TERRAIN: Parameter = Parameter {
    name: "terrain",
    about: "The terrain that points stand on: each has a height z. It is a field: its share becomes a height \
            between heights.",
    group: Group::Attributes,
    shape: Shape::Field,
    default: Some("none"),
    example: "hills",
    is_echoed: true,
    ..Parameter::RARE
};
pub(super) const HEIGHTS: Parameter = Parameter {
    name: "heights",
    about: "The heights of the terrain where its field is 0 and where it is 1, in world units.",
    group: Group::Attributes,
    shape: Shape::Numbers(&["low", "high"]),
    allowed: Some("two numbers low,high with -1e9 <= low < high <= 1e9, beside a terrain"),
    default: Some("0,1"),
    example: "0,120",
    is_echoed: true,
    ..Parameter::RARE
};
pub(super) const NORMALS: Parameter = Parameter {
    name: "normals",
    about: "Whether points have the normal nx, ny, nz of the terrain, of unit length.",
    group: Group::Attributes,
    shape: Shape::Switch,
    allowed: Some("on or off, beside a terrain"),
    default: Some("off"),
    example: "on",
    is_echoed: true,
    ..Parameter::RARE
};
pub(super) const ALIGN: Parameter = Parameter {
    name: "align",
    about: "How far things lean from the vertical (0) to the normal of the terrain (1). Points then have a \
            rotation qx, qy, qz, qw, which the attribute angle is part of.",
    group: Group::Attributes,
    shape: Shape::Number { min: 0.0, max: 1.0 },
    allowed: Some("a number from 0 to 1, beside a terrain"),
    default: Some("no rotations"),
    example: "0.5",
    is_echoed: true,
    ..Parameter::RARE
};
