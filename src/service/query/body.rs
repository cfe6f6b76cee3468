//! Queries as JSON: the body of a `POST`.
//!
//! Members are read one by one instead of by a derived deserializer, so that a fault names the
//! member by its path, shows its value and says what is allowed, and all of them are found at once.

mod reader;

use serde_json::{Map, Value};

use super::{
    AMOUNT, AmountDraft, AttributesDraft, Draft, KEEP, LayerDraft, MOST_LEVELS, RegionDraft,
    SetDraft, ShapeDraft, TableDraft, WARP, WindowDraft,
    amount::COUNT,
    attributes::ATTRIBUTES,
    faults::Faults,
    geojson::{GEOJSON, polygons},
    parameters::{LOOKS_NAMES, SEED, SET_NAMES, WINDOW_NAMES},
};
use crate::service::{
    Encoding, Error, Fault,
    encode::{
        DECIMALS, MOST_DECIMALS, Options,
        preview::{LEAST_SIZE, MOST_SIZE, SIZE},
    },
};
use reader::Reader;

/// A body as far as it can be read: a draft to check, with the faults found on the way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// The query.
    pub draft: Draft,
    /// How the answer is to look.
    pub options: Options,
    /// What is wrong so far.
    pub faults: Vec<Fault>,
}

/// What regions are in JSON.
const REGION: &str = r#"{"bbox": …}, {"circle": …}, {"polygon": GeoJSON}, {"chunk": …}, or {"include": [regions], "exclude": [regions]}"#;
const BOX: &str = "[min_x, min_y, max_x, max_y], numbers with min_x < max_x and min_y < max_y";
const CIRCLE: &str = r#"{"center": [x, y], "radius": r}, numbers with r above 0"#;
const CHUNK: &str =
    r#"{"size": s, "x": column, "y": row}, a number above 0 and integers within ±4503599627370496"#;
/// What the values of points are in JSON.
const SCALE_RANGE: &str = "[min, max] with 0 <= min <= max <= 1e9";
const VARIANTS: &str = r#"{"oak": 3, "birch": 1}, or [{"name": "oak", "weight": 3}, …]: 1 to 256 different names of up to 64 characters, weights 1e-9 to 1e9"#;

/// Reads a body.
///
/// # Errors
/// [`Error::Invalid`] if it is not a JSON object.
pub fn read_body(bytes: &[u8]) -> Result<Body, Error> {
    let fault = |value: String, detail: String| {
        Error::Invalid(vec![Fault::new("body", value, detail, "a JSON object")])
    };
    let value: Value = serde_json::from_slice(bytes).map_err(|error| {
        let text = String::from_utf8_lossy(bytes);
        let words: Vec<&str> = text.split_whitespace().collect();
        fault(words.join(" "), format!("it is not JSON: {error}"))
    })?;
    let Value::Object(members) = value else {
        return Err(fault(value.to_string(), "it is not an object".into()));
    };
    let mut faults = Faults::default();
    let mut reader = Reader::new("", &members, &mut faults);
    let mut known = vec!["region", "layers"];
    known.extend(WINDOW_NAMES);
    known.extend(LOOKS_NAMES);
    known.extend(SET_NAMES);
    reader.only(&known);
    let draft = Draft {
        region: reader.member("region", REGION, |value, reader| {
            region(value, "region", 0, reader)
        }),
        set: set(&mut reader),
        layers: layers(&mut reader),
        window: WindowDraft {
            offset: reader.integer("offset", "an integer from 0 on"),
            limit: reader.integer("limit", "an integer from 1 on"),
            cursor: reader.text("cursor", "the cursor of an earlier answer"),
        },
    };
    let options = Options {
        encoding: reader
            .text("format", "the name of a format")
            .and_then(|name| {
                let encoding = Encoding::from_name(&name);
                if encoding.is_none() {
                    reader.found(super::values::no_format("format", &name));
                }
                encoding
            }),
        decimals: reader.integer("decimals", DECIMALS).and_then(|n| {
            let decimals = u8::try_from(n).ok().filter(|n| *n <= MOST_DECIMALS);
            if decimals.is_none() {
                reader.fault("decimals", &n.to_string(), "it is out of range", DECIMALS);
            }
            decimals
        }),
        size: reader.integer("size", SIZE).and_then(|n| {
            let sizes = LEAST_SIZE..=MOST_SIZE;
            let size = u32::try_from(n).ok().filter(|n| sizes.contains(n));
            if size.is_none() {
                reader.fault("size", &n.to_string(), "it is out of range", SIZE);
            }
            size
        }),
    };
    Ok(Body {
        draft,
        options,
        faults: faults.into_inner(),
    })
}

fn set(reader: &mut Reader<'_>) -> SetDraft {
    SetDraft {
        amount: AmountDraft {
            density: reader.number("density", AMOUNT),
            spacing: reader.number("spacing", AMOUNT),
            min_distance: reader.number("min_distance", AMOUNT),
            count: reader.integer("count", COUNT),
        },
        table: TableDraft {
            profile: reader.text("profile", "the name of a profile that is loaded"),
            alpha: reader.text("alpha", "a number that the profile is loaded for, as text"),
            map: reader.text("map", "s, m or l, as far as the profile is loaded with it"),
            table: reader.text("table", super::pin::DIGEST),
        },
        seed: reader.integer("seed", SEED),
        warp: reader.member("warp", WARP, |value, _| match value {
            Value::String(text) if text == "off" => Some(0.0),
            Value::String(text) if text == "on" => Some(1.0),
            value => value.as_f64(),
        }),
        keep: reader.number("keep", KEEP),
        attributes: attributes(reader),
    }
}

fn attributes(reader: &mut Reader<'_>) -> AttributesDraft {
    let names = reader.member("attributes", ATTRIBUTES, |value, _| match value {
        Value::String(text) => Some(text.split(',').map(Into::into).collect()),
        Value::Array(items) => items
            .iter()
            .map(|item| item.as_str().map(Into::into))
            .collect(),
        _ => None,
    });
    AttributesDraft {
        names: names.unwrap_or_default(),
        scale_range: reader.member("scale_range", SCALE_RANGE, |value, _| numbers(value)),
        variants: reader.member("variants", VARIANTS, |value, _| variants(value)),
    }
}

/// Variants: an object of weights by name, a list of objects with name and weight, or the text of
/// an address.
fn variants(value: &Value) -> Option<Vec<(String, f64)>> {
    match value {
        Value::Object(weights) => weights
            .iter()
            .map(|(name, weight)| Some((name.clone(), weight.as_f64()?)))
            .collect(),
        Value::Array(items) => items
            .iter()
            .map(|item| {
                let name = item.get("name")?.as_str()?;
                Some((
                    name.into(),
                    item.get("weight").map_or(Some(1.0), Value::as_f64)?,
                ))
            })
            .collect(),
        Value::String(text) => super::values::variants_of(text),
        _ => None,
    }
}

fn layers(reader: &mut Reader<'_>) -> Vec<LayerDraft> {
    const LAYERS: &str = "a list of layers, objects with a name and a set of points each";
    let read = reader.member("layers", LAYERS, |value, outer| {
        let items = value.as_array()?;
        let mut layers = vec![];
        for (i, item) in items.iter().enumerate() {
            let path = format!("layers[{i}]");
            let Some(members) = item.as_object() else {
                outer.fault(&path, &item.to_string(), "it is not an object", LAYERS);
                continue;
            };
            layers.push(layer(&path, members, outer));
        }
        Some(layers)
    });
    let layers = read.unwrap_or_default();
    if layers.is_empty()
        && let Some(value) = reader.members().get("layers")
    {
        reader.fault(
            "layers",
            &value.to_string(),
            "there is no layer in it",
            LAYERS,
        );
    }
    layers
}

fn layer(path: &str, members: &Map<String, Value>, outer: &mut Reader<'_>) -> LayerDraft {
    const CLEAR_OF: &str = r#"distances by the names of earlier layers, such as {"trees": 2}"#;
    let mut reader = outer.inner(&format!("{path}."), members);
    let mut known = vec!["name", "region", "clear_of"];
    known.extend(SET_NAMES);
    reader.only(&known);
    let region_path = format!("{path}.region");
    let clear_of = reader.member("clear_of", CLEAR_OF, |value, _| {
        let pairs = value.as_object()?.iter();
        pairs
            .map(|(name, distance)| Some((name.clone(), distance.as_f64()?)))
            .collect()
    });
    LayerDraft {
        name: reader.text("name", "the layer's name").unwrap_or_default(),
        region: reader.member("region", REGION, |value, reader| {
            region(value, &region_path, 0, reader)
        }),
        clear_of: clear_of.unwrap_or_default(),
        set: set(&mut reader),
    }
}

/// A region; `None` with a fault of its own, or for a value that is no region at all.
fn region(value: &Value, path: &str, depth: usize, outer: &mut Reader<'_>) -> Option<RegionDraft> {
    let members = value.as_object()?;
    let kinds = ["bbox", "circle", "polygon", "chunk", "include"];
    let given: Vec<&str> = kinds
        .into_iter()
        .filter(|kind| members.contains_key(*kind))
        .collect();
    let [kind] = given.as_slice() else {
        return None;
    };
    let mut reader = outer.inner(&format!("{path}."), members);
    let exclude = (*kind == "include").then_some("exclude");
    reader.only(
        &[Some(*kind), exclude]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>(),
    );
    let shape = match *kind {
        "bbox" => reader.member("bbox", BOX, |value, _| numbers(value).map(ShapeDraft::Box)),
        "circle" => reader.member("circle", CIRCLE, |value, _| {
            let center = numbers(value.get("center")?)?;
            Some(ShapeDraft::Circle(center, value.get("radius")?.as_f64()?))
        }),
        "polygon" => reader.member("polygon", GEOJSON, |value, reader| {
            let polygons = polygons(value).map(ShapeDraft::Polygons);
            Some(polygons.unwrap_or_else(|detail| {
                reader.fault("polygon", &value.to_string(), &detail, GEOJSON);
                ShapeDraft::Unread
            }))
        }),
        "chunk" => reader.member("chunk", CHUNK, |value, _| {
            let at = |name| value.get(name).and_then(Value::as_i64);
            Some(ShapeDraft::Chunk(
                value.get("size")?.as_f64()?,
                [at("x")?, at("y")?],
            ))
        }),
        _ if depth == MOST_LEVELS => {
            reader.fault(
                "include",
                "",
                "lists are nested too deeply",
                &format!("{MOST_LEVELS} levels at most"),
            );
            None
        }
        _ => {
            let mut list = |name: &str| {
                reader.member(name, "a list of regions", |value, reader| {
                    let items = value.as_array()?.iter().enumerate();
                    let mut regions = vec![];
                    for (i, item) in items {
                        let path = format!("{path}.{name}[{i}]");
                        match region(item, &path, depth + 1, reader) {
                            Some(region) => regions.push(region),
                            None => reader.fault_at(&path, item, "it is not a region", REGION),
                        }
                    }
                    Some(regions)
                })
            };
            let include = list("include");
            let exclude = list("exclude").unwrap_or_default();
            include.map(|include| ShapeDraft::Combined(include, exclude))
        }
    };
    let path = match *kind {
        "include" => path.into(),
        kind => format!("{path}.{kind}"),
    };
    let shape = shape.unwrap_or(ShapeDraft::Unread);
    Some(RegionDraft { path, shape })
}

/// So many numbers.
fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let numbers: Vec<f64> = value
        .as_array()?
        .iter()
        .map(Value::as_f64)
        .collect::<Option<_>>()?;
    numbers.try_into().ok()
}
