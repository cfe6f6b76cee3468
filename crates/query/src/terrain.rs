//! The terrain on which points stand: a field whose shares are heights between two bounds.

use std::sync::Arc;

use strew_catalog::field::Document;
use strew_error::{Checked, Fault, Together as _};

use crate::{
    field::{Loaded, SetField},
    parameters::{ALIGN, HEIGHTS, NORMALS, TERRAIN},
    region::QueryRegion,
    rules,
    set::Set,
    values::Values,
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
            rules::check(values, parameter)?;
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

/// Refuses terrains without a height somewhere in the box of a region: no number stands for it.
pub(super) fn hold(sets: &[Set], region: &QueryRegion) -> Checked<()> {
    let partial = sets.iter().find(|set| {
        let within = set.region.as_ref().unwrap_or(region).bounds;
        let terrain = set.terrain.as_ref();
        terrain.is_some_and(|terrain| terrain.field.spec.has_missing(&within))
    });
    let Some(set) = partial else {
        return Ok(());
    };
    let name = set
        .terrain
        .iter()
        .find_map(|terrain| terrain.field.name.clone());
    let detail = "it has pixels without a height in the box of the region";
    let allowed = "a region in which all pixels have heights, or a terrain whose gaps are filled";
    let path = format!("{}{}", set.path, TERRAIN.name);
    Err(Fault::new(&path, name.unwrap_or_default(), detail, allowed).into())
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
