//! The terrain on which points stand: a field whose shares are heights between two bounds.

use std::sync::Arc;

use strew_catalog::field::Document;
use strew_error::{Checked, Together as _};

use crate::{
    field::{Loaded, SetField},
    parameters::{ALIGN, HEIGHTS, NORMALS, TERRAIN},
    rules,
    values::Values,
};

#[derive(Clone, Debug, PartialEq)]
pub struct Terrain {
    /// Its share is the height, from the lower of the bounds to the upper one.
    pub field: SetField,
    /// The heights where the share is 0 and where it is 1, in world units.
    pub heights: [f64; 2],
    pub has_normals: bool,
    /// How far things lean from the vertical to the normal, 0 to 1, if they have rotations.
    pub align: Option<f64>,
}

pub(super) fn check(values: &Values, loaded: &Loaded<'_>) -> Checked<Option<Terrain>> {
    let document = values.get::<Arc<Document>>(&TERRAIN);
    let Some(document) = document? else {
        for parameter in [&HEIGHTS, &NORMALS, &ALIGN] {
            rules::check(values, parameter)?;
        }
        return Ok(None);
    };
    let path = format!("{}{}", values.path(), TERRAIN.name);
    let (field, heights, normals, align) = (
        loaded
            .built(&path, &document)
            .and_then(|field| field.of_plane(&path)),
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
