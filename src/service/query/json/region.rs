//! Regions as JSON.

use serde::Deserialize;
use serde_json::value::RawValue;

use super::{
    super::{
        Checked, Faults, MOST_LEVELS, MOST_REGIONS, RegionDraft, ShapeDraft, parameter::unknown,
        region::REGION, shape::LONGEST, values::shown,
    },
    geojson::{GEOJSON, polygons},
    object::{self, Object, text_of},
};
use crate::service::Fault;

/// What a box is in JSON.
const BOX: &str = "[min_x, min_y, max_x, max_y], numbers with min_x < max_x and min_y < max_y";
/// What a circle is in JSON.
const CIRCLE: &str = r#"{"center": [x, y], "radius": r}, numbers with r above 0"#;
/// The shapes of regions, each a member.
const SHAPES: [&str; 5] = ["bbox", "circle", "polygon", "chunk", "include"];

/// A circle.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Circle")]
pub(super) struct CircleJson {
    /// The center [x, y].
    center: [f64; 2],
    /// The radius in world units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    radius: f64,
}

/// A square of the world grid: size·x ≤ p.x < size·(x + 1), and so for y.
#[derive(Debug, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Chunk")]
pub(super) struct ChunkJson {
    /// The side in world units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    size: f64,
    /// The column.
    #[schemars(range(min = -4_503_599_627_370_496_i64, max = 4_503_599_627_370_496_i64))]
    x: i64,
    /// The row.
    #[schemars(range(min = -4_503_599_627_370_496_i64, max = 4_503_599_627_370_496_i64))]
    y: i64,
}

/// The region of a GeoJSON file: all of its polygons.
///
/// # Errors
/// A [`Fault`] of `region`, which says where in the file something is wrong.
pub fn read_region(bytes: &[u8]) -> Result<RegionDraft, Fault> {
    let fault = |detail: String| {
        let start = bytes.get(..bytes.len().min(500)).unwrap_or_default();
        let text = String::from_utf8_lossy(start);
        let words: Vec<&str> = text.split_whitespace().collect();
        Fault::new("region", words.join(" "), detail, GEOJSON)
    };
    let json: &RawValue =
        serde_json::from_slice(bytes).map_err(|error| fault(format!("not JSON: {error}")))?;
    Ok(RegionDraft {
        path: "region".into(),
        shape: ShapeDraft::Polygons(polygons(json).map_err(fault)?),
    })
}

/// A region. `listed` counts the regions in lists of the query.
pub(super) fn read(json: &RawValue, path: &str, listed: &mut usize) -> Checked<RegionDraft> {
    region(json, path, 0, listed)
}

fn region(json: &RawValue, path: &str, depth: usize, listed: &mut usize) -> Checked<RegionDraft> {
    let wrong = |detail: String| Faults::from(Fault::new(path, shown(json), detail, REGION));
    let object = Object::read(json).map_err(wrong)?;
    let given: Vec<&str> = SHAPES
        .into_iter()
        .filter(|kind| object.get(kind).is_some())
        .collect();
    let known = |name: &str| match given.as_slice() {
        [kind] => name == *kind || (*kind == "include" && name == "exclude"),
        _ => SHAPES.contains(&name) || name == "exclude",
    };
    let mut faults: Checked<()> = Ok(());
    for (name, json) in object.members().filter(|(name, _)| !known(name)) {
        let detail = match SHAPES.contains(&name) {
            true => "a region has one shape".into(),
            false => unknown("member", name, SHAPES.into_iter()),
        };
        let field = format!("{path}.{name}");
        Faults::add(&mut faults, Fault::new(&field, shown(json), detail, REGION));
    }
    faults?;
    let [kind] = given.as_slice() else {
        return Err(wrong(match given.as_slice() {
            [] => "has no shape".into(),
            several => format!("has several shapes: {}", several.join(", ")),
        }));
    };
    let (kind, json) = (*kind, object.get(kind).unwrap_or(json));
    let field = format!("{path}.{kind}");
    let wrong = |detail: String, allowed: &str| -> Faults {
        Fault::new(&field, shown(json), detail, allowed).into()
    };
    if ["circle", "chunk"].contains(&kind) && !json.get().starts_with('{') {
        let allowed = if kind == "circle" { CIRCLE } else { CHUNK_JSON };
        return Err(wrong("must be an object".into(), allowed));
    }
    let shape = match kind {
        "bbox" => {
            let corners = numbers(json).map_err(|detail| wrong(detail, BOX))?;
            ShapeDraft::Box(corners)
        }
        "circle" => {
            let CircleJson { center, radius } =
                serde_json::from_str(json.get()).map_err(|error| wrong(text_of(&error), CIRCLE))?;
            ShapeDraft::Circle(center, radius)
        }
        "polygon" => ShapeDraft::Polygons(polygons(json).map_err(|detail| wrong(detail, GEOJSON))?),
        "chunk" => {
            let ChunkJson { size, x, y } = serde_json::from_str(json.get())
                .map_err(|error| wrong(text_of(&error), CHUNK_JSON))?;
            ShapeDraft::Chunk(size, [x, y])
        }
        _ if depth == MOST_LEVELS => {
            let allowed = format!("{MOST_LEVELS} levels at most");
            return Err(wrong("regions are nested too deeply".into(), &allowed));
        }
        _ => {
            let include = list(&field, json, depth, listed)?;
            let exclude = object.get("exclude");
            let exclude = exclude.map(|json| list(&format!("{path}.exclude"), json, depth, listed));
            ShapeDraft::Combined(include, exclude.transpose()?.unwrap_or_default())
        }
    };
    let path = match kind {
        "include" => path.into(),
        _ => field,
    };
    Ok(RegionDraft { path, shape })
}

/// What a chunk is in JSON.
const CHUNK_JSON: &str =
    r#"{"size": s, "x": column, "y": row}, a number above 0 and integers within ±4503599627370496"#;

/// A list of regions, each with its faults in its place.
fn list(
    path: &str,
    json: &RawValue,
    depth: usize,
    listed: &mut usize,
) -> Checked<Vec<Checked<RegionDraft>>> {
    let mut regions = vec![];
    let mut faults = 0;
    let is_array = object::each(json, |i, item| {
        *listed += 1;
        if *listed > MOST_REGIONS {
            // Only counted.
            return true;
        }
        let read = region(item, &format!("{path}[{i}]"), depth + 1, listed);
        faults += usize::from(read.is_err());
        regions.push(read);
        *listed > MOST_REGIONS || faults < super::super::faults::MOST_FAULTS
    });
    if !is_array {
        let allowed = "an array of regions";
        return Err(Fault::new(path, shown(json), "must be an array", allowed).into());
    }
    if *listed > MOST_REGIONS {
        let (value, detail) = (format!("{listed} regions"), "too many regions");
        let allowed = format!("at most {MOST_REGIONS} regions in the lists of a query");
        return Err(Fault::new(path, value, detail, allowed).into());
    }
    Ok(regions)
}

/// As many numbers as are wanted.
fn numbers<const N: usize>(json: &RawValue) -> Result<[f64; N], String> {
    if json.get().len() > LONGEST {
        return Err(format!("must be an array of {N} numbers"));
    }
    let values: Vec<f64> =
        serde_json::from_str(json.get()).map_err(|_| format!("must be an array of {N} numbers"))?;
    let wrong = |values: Vec<f64>| format!("expected {N} numbers, got {}", values.len());
    values.try_into().map_err(wrong)
}
