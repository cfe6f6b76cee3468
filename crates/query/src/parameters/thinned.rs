//! Parameters of sets that have a part of the points: how these settle, and levels of detail.

use strew_core::{Keep, Settle};

use crate::{
    parameter::{Group, Parameter},
    shape::Shape,
};

pub(super) const SETTLE: Parameter = Parameter {
    name: "settle",
    about: "The steps by which the points of a set that is thinned or in a field move apart, so that they are \
            spread evenly: 0 leaves them where their ranks have them, 4 is the smoothest. Each step takes its \
            time. Sets with all points stay by default; for them 1 is one small step that moves the nearest \
            points apart, and more count as 1. Periods do not settle.",
    group: Group::Thinned,
    shape: Shape::Integer {
        min: 0,
        max: Settle::MAX_STEPS as u64,
    },
    default: Some("2; 0 for sets with all points"),
    example: "3",
    is_echoed: true,
    ..Parameter::RARE
};

pub(super) const LOD: Parameter = Parameter {
    name: "lod",
    about: "The level of detail: the part of the points that the answer has, at each place those of the lowest \
            rank. None of them moves, so a level has a part of the points of a finer one, in fields, of kinds \
            and of layers, too. Beside layers: of all of them; they keep clear of all points of each other.",
    group: Group::Thinned,
    shape: Shape::Number {
        min: Keep::MIN,
        max: 1.0,
    },
    default: Some("1"),
    example: "0.25",
    is_echoed: true,
    ..Parameter::RARE
};
