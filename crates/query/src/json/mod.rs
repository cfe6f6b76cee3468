//! Queries as JSON: the body of a `POST`.
//!
//! Members are read one by one from their text, so that a fault names the member by its path, shows its
//! value and says what is allowed. Nothing is built that the query does not need, and reading stops once
//! there are as many faults as are reported.

mod features;
mod geojson;
pub(crate) mod object;
mod region;

use serde_json::value::RawValue;
use strew_catalog::Dimension;
use strew_error::{Checked, Fault, all, unknown};

use super::{
    Draft, LayerDraft, MOST_FEATURES, Values, groups, lookup::names, parameter::Group,
    values::NOT_IN_SPACE,
};
use object::{Object, of_text, parse, shown};

pub use features::read_features;
pub use region::{AnyRegionSchema, RegionSchema, VolumeSchema, read_region};

const LAYERS: &str = "an array of 1 to 16 layers, or of 1000 that differ in name, region, amount, seed and field alone: objects with a name and a set of points each";
/// The form of `clear_of`.
const CLEAR_OF: &str =
    r#"an object of distances by the names of earlier layers, such as {"trees": 2}"#;

/// The members of a query that are no parameters.
const QUERY: [&str; 3] = ["region", "features", "layers"];
const LAYER: [&str; 3] = ["name", "region", "clear_of"];

/// Reads a query. What cannot be read is a fault in its place in the draft.
pub fn read_body(bytes: &[u8], groups: &'static [Group]) -> Checked<Draft> {
    let object = object_of(bytes)?;
    let mut draft = Draft::new(Values::new(groups, ""));
    let (mut listed, mut features) = (0, None);
    for (name, json) in object.members() {
        if draft.values.is_full() {
            break;
        }
        match name {
            "region" => {
                let dimension = draft.values.dimension();
                draft.region = region::read(json, "region", 0, &mut listed, dimension).map(Some);
            }
            "features" if draft.values.dimension() == Dimension::Plane => features = Some(json),
            "layers" => draft.layers = layers(json, &mut listed, draft.values.dimension()),
            // A common slip, which the list of members would not explain.
            "bbox" | "circle" | "polygon" | "ball" | "prism" | "chunk" | "include" | "exclude" => {
                let detail = format!("belongs in `region`: {{\"region\": {{\"{name}\": …}}}}");
                let allowed = members(&QUERY, groups);
                draft
                    .values
                    .refuse(Fault::new(name, shown(json), detail, allowed));
            }
            name => add_member(&mut draft.values, name, json, &QUERY, groups),
        }
    }
    let Some(json) = features else {
        return Ok(draft);
    };
    let is_alone =
        matches!((&draft.region, &draft.layers), (Ok(None), Ok(layers)) if layers.is_empty());
    if !is_alone {
        let detail = "beside region or layers: each feature is a layer with a region";
        let fault = Fault::new("features", shown(json), detail, "features alone");
        draft.values.refuse(fault);
        return Ok(draft);
    }
    Ok(draft.in_features(features::read(json)))
}

pub fn read_members(bytes: &[u8], groups: &'static [Group]) -> Checked<Values> {
    let object = object_of(bytes)?;
    let mut values = Values::new(groups, "");
    for (name, json) in object.members() {
        values.add_json(name, json);
    }
    Ok(values)
}

fn object_of(bytes: &[u8]) -> Result<Object<'_>, Fault> {
    let object = parse(bytes).and_then(Object::read);
    object.map_err(of_text("body", bytes, "a JSON object"))
}

fn add_member(
    values: &mut Values,
    name: &str,
    json: &RawValue,
    others: &'static [&'static str],
    groups: &'static [Group],
) {
    if values.takes().any(|parameter| parameter.name == name) {
        return values.add_json(name, json);
    }
    let detail = if values.is_of_the_plane(name) {
        NOT_IN_SPACE.into()
    } else {
        let known = values.takes().map(|parameter| parameter.name);
        unknown("member", name, known.chain(others.iter().copied()))
    };
    let field = format!("{}{name}", values.path());
    values.refuse(Fault::new(
        &field,
        shown(json),
        detail,
        members(others, groups),
    ));
}

fn members(others: &[&str], groups: &'static [Group]) -> String {
    format!("{}, {}", others.join(", "), names(groups))
}

fn layers(json: &RawValue, listed: &mut usize, dimension: Dimension) -> Checked<Vec<LayerDraft>> {
    let items = match object::elements(json, MOST_FEATURES, "layers") {
        Ok(items) if items.is_empty() => Err("empty".into()),
        read => read,
    };
    let items = items.map_err(|detail| Fault::new("layers", shown(json), detail, LAYERS))?;
    let items = items.into_iter().enumerate();
    all(items.map(|(i, json)| Ok(layer(&format!("layers[{i}]"), json, listed, dimension)?)))
}

fn layer(
    path: &str,
    json: &RawValue,
    listed: &mut usize,
    dimension: Dimension,
) -> Result<LayerDraft, Fault> {
    let groups = match dimension {
        Dimension::Plane => groups::SET,
        Dimension::Space => groups::SPACE_SET,
    };
    let fault = |detail| Fault::new(path, shown(json), detail, LAYERS);
    let object = Object::read(json).map_err(fault)?;
    let mut layer = LayerDraft::new(Values::new(groups, &format!("{path}.")));
    for (name, json) in object.members() {
        match name {
            "region" => {
                let path = format!("{path}.region");
                let read = region::read(json, &path, 0, listed, dimension);
                layer.region = read.map(Some);
            }
            "name" => {
                let wrong = |_| {
                    let field = format!("{path}.name");
                    Fault::new(&field, shown(json), "must be text", super::layer::NAME).into()
                };
                layer.name = serde_json::from_str(json.get()).map_err(wrong);
            }
            "clear_of" => {
                let wrong = |detail: String| {
                    Fault::new(&format!("{path}.clear_of"), shown(json), detail, CLEAR_OF).into()
                };
                layer.clear_of = object::weights(json).map_err(wrong);
            }
            name => add_member(&mut layer.values, name, json, &LAYER, groups),
        }
    }
    Ok(layer)
}

#[cfg(test)]
mod tests;
