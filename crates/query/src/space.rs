//! The parameters that requests about points in space have in place of those of the plane.

use crate::{
    parameter::{Parameter, parameter},
    shape::Shape,
};

pub static BOX: Parameter = parameter!("bbox" of Volume {
    about: "The volume as a box: min ≤ p < max on the reported coordinates.",
    shape: Shape::Numbers(&["min_x", "min_y", "min_z", "max_x", "max_y", "max_z"]),
    allowed: Some("six finite numbers min_x,min_y,min_z,max_x,max_y,max_z, each min below its max"),
    example: "0,0,0,3,2,1",
});

pub static BALL: Parameter = parameter!("ball" of Volume {
    about: "The volume as a ball: the points nearer to x,y,z than the radius.",
    shape: Shape::Numbers(&["x", "y", "z", "radius"]),
    allowed: Some("four finite numbers x,y,z,radius with a radius above 0"),
    example: "5,5,5,3",
});

pub static SPACE_ATTRIBUTES: Parameter = parameter!("attributes" of SpaceAttributes {
    about: "Further values of each point, hashed from its id and the seed: rotation (a uniform unit quaternion, as qx, \
            qy, qz and qw), scale (within scale_range), variant (one of variants, by weight), rank (0 to 1, see keep), \
            u1 to u16 (uniform, 0 to 1).",
    shape: Shape::Names {
        pattern: "^(rotation|scale|variant|rank|u([1-9]|1[0-6]))$",
    },
    allowed: Some(
        "different names of rotation, scale, variant, rank and u1 to u16, joined by commas",
    ),
    default: Some("none"),
    example: "rotation,u1",
    is_echoed: true,
});

pub static SPACE_AT: Parameter = parameter!("at" of SpaceNearest {
    about: "The place whose neighbors are wanted.",
    shape: Shape::Numbers(&["x", "y", "z"]),
    is_required: true,
    example: "100.5,-3,12",
});

/// All of them, in the order of help texts.
pub static SPACE_PARAMETERS: &[&Parameter] = &[&BOX, &BALL, &SPACE_ATTRIBUTES, &SPACE_AT];
