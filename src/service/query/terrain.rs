//! The terrain on which points stand: a field whose shares are heights between two bounds.

use std::sync::Arc;

use super::{
    Checked, Faults, Group, Parameter, SetField, Shape, Together as _, Value, Values, field::Loaded,
};
use crate::service::field::Document;

/// The terrain that points stand on.
pub static TERRAIN: Parameter = Parameter {
    name: "terrain",
    about: "The terrain that points stand on: each has a height z. It is a field: its share becomes a height \
            between heights.",
    group: Group::Attributes,
    shape: Shape::Field,
    default: Some("none"),
    example: "hills",
    echo: Some(|set| set.terrain.as_ref()?.field.echo()),
    ..Parameter::PLAIN
};
/// The bounds of its heights.
pub static HEIGHTS: Parameter = Parameter {
    name: "heights",
    about: "The heights of the terrain where its field is 0 and where it is 1, in world units.",
    group: Group::Attributes,
    shape: Shape::Numbers(&["low", "high"]),
    allowed: Some("two numbers low,high with -1e9 <= low < high <= 1e9, beside a terrain"),
    default: Some("0,1"),
    example: "0,120",
    echo: Some(|set| Some(Value::Numbers(set.terrain.as_ref()?.heights.into()))),
    ..Parameter::PLAIN
};
/// Whether points have normals.
pub static NORMALS: Parameter = Parameter {
    name: "normals",
    about: "Whether points have the normal nx, ny, nz of the terrain, of unit length.",
    group: Group::Attributes,
    shape: Shape::Switch,
    allowed: Some("on or off, beside a terrain"),
    default: Some("off"),
    example: "on",
    echo: Some(|set| {
        set.terrain
            .as_ref()?
            .has_normals
            .then_some(Value::Switch(true))
    }),
    ..Parameter::PLAIN
};
/// How far things lean.
pub static ALIGN: Parameter = Parameter {
    name: "align",
    about: "How far things lean from the vertical (0) to the normal of the terrain (1). Points then have a \
            rotation qx, qy, qz, qw, which the attribute angle is part of.",
    group: Group::Attributes,
    shape: Shape::Number { min: 0.0, max: 1.0 },
    allowed: Some("a number from 0 to 1, beside a terrain"),
    default: Some("no rotations"),
    example: "0.5",
    echo: Some(|set| set.terrain.as_ref()?.align.map(Value::Number)),
    ..Parameter::PLAIN
};

/// The terrain of a set.
#[derive(Clone, Debug, PartialEq)]
pub struct Terrain {
    /// Its share is the height, from the lower of the bounds to the upper one.
    pub field: SetField,
    /// The heights where the share is 0 and where it is 1, in world units.
    pub heights: [f64; 2],
    /// Whether points have normals.
    pub has_normals: bool,
    /// How far things lean from the vertical to the normal, 0 to 1, if they have rotations.
    pub align: Option<f64>,
}

/// The terrain among some values.
pub(super) fn check(values: &Values, loaded: &Loaded<'_>) -> Checked<Option<Terrain>> {
    let document = values.get::<Arc<Document>>(&TERRAIN);
    let Some(document) = document? else {
        for parameter in [&HEIGHTS, &NORMALS, &ALIGN] {
            if values.has(parameter) {
                let fault = values.fault(parameter, "has no effect without a terrain");
                return Err(Faults::from(fault));
            }
        }
        return Ok(None);
    };
    let path = format!("{}{}", values.path(), TERRAIN.name);
    let (field, heights, normals, align) = (
        loaded.built(&path, &document),
        heights(values),
        values.get::<bool>(&NORMALS),
        values.get::<f64>(&ALIGN),
    );
    let (field, heights, normals, align) = (field, heights, normals, align).together()?;
    Ok(Some(Terrain {
        field,
        heights,
        has_normals: normals.unwrap_or(false),
        align,
    }))
}

fn heights(values: &Values) -> Checked<[f64; 2]> {
    let [low, high] = values.get(&HEIGHTS)?.unwrap_or([0.0, 1.0]);
    // Beyond that `f32` coordinates overflow; NaN and infinities are no values.
    if low < high && low >= -1e9 && high <= 1e9 {
        Ok([low, high])
    } else {
        Err(values.fault(&HEIGHTS, "out of order or range").into())
    }
}
