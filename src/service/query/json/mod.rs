//! Queries as JSON: the body of a `POST`.
//!
//! Members are read one by one from their text, so that a fault names the member by its path, shows its
//! value and says what is allowed. Nothing is built that the query does not need, and reading stops once
//! there are as many faults as are reported.

mod geojson;
mod object;
mod region;
mod schema;

use serde_json::value::RawValue;

use super::{
    Checked, Draft, Faults, LayerDraft, MOST_LAYERS, Values, groups,
    parameter::{Group, names, unknown},
    values::shown,
};
use crate::service::Fault;
use object::Object;

pub(super) use object::{fields, list_of_names, ranges, weights};
pub use region::read_region;
pub use schema::RegionSchema;

/// What layers are.
const LAYERS: &str = "an array of 1 to 16 layers, objects with a name and a set of points each";
/// What clear_of may be.
const CLEAR_OF: &str =
    r#"an object of distances by the names of earlier layers, such as {"trees": 2}"#;

/// The members of a query that are no parameters.
const QUERY: [&str; 2] = ["region", "layers"];
/// Those of a layer.
const LAYER: [&str; 3] = ["name", "region", "clear_of"];

/// Reads a query. What cannot be read is a fault in its place in the draft.
///
/// # Errors
/// A fault of `body` if it is not a JSON object.
pub fn read_body(bytes: &[u8], groups: &'static [Group]) -> Checked<Draft> {
    let fault = |detail: String| {
        let start = bytes.get(..bytes.len().min(500)).unwrap_or_default();
        let text = String::from_utf8_lossy(start);
        let words: Vec<&str> = text.split_whitespace().collect();
        Fault::new("body", words.join(" "), detail, "a JSON object")
    };
    let whole: &RawValue =
        serde_json::from_slice(bytes).map_err(|error| fault(format!("not JSON: {error}")))?;
    let object = Object::read(whole).map_err(fault)?;
    let mut draft = Draft::new(Values::new(groups, ""));
    let mut listed = 0;
    for (name, json) in object.members() {
        if draft.values.is_full() {
            break;
        }
        match name {
            "region" => draft.region = region::read(json, "region", &mut listed).map(Some),
            "layers" => draft.layers = layers(json, &mut listed),
            // A common slip, which the list of members would not explain.
            "bbox" | "circle" | "polygon" | "chunk" | "include" | "exclude" => {
                let detail = format!("belongs in `region`: {{\"region\": {{\"{name}\": …}}}}");
                let allowed = members(&QUERY, groups);
                draft
                    .values
                    .refuse(Fault::new(name, shown(json), detail, allowed));
            }
            name => add_member(&mut draft.values, name, json, &QUERY, groups),
        }
    }
    Ok(draft)
}

/// Reads a body whose members are all parameters.
///
/// # Errors
/// A fault of `body` if it is not a JSON object. Other faults are in their places.
pub fn read_members(bytes: &[u8], groups: &'static [Group]) -> Checked<Values> {
    let fault = |detail: String| {
        let start = bytes.get(..bytes.len().min(100)).unwrap_or_default();
        Fault::new(
            "body",
            String::from_utf8_lossy(start),
            detail,
            "a JSON object",
        )
    };
    let whole: &RawValue =
        serde_json::from_slice(bytes).map_err(|error| fault(format!("not JSON: {error}")))?;
    let object = Object::read(whole).map_err(fault)?;
    let mut values = Values::new(groups, "");
    for (name, json) in object.members() {
        values.add_json(name, json);
    }
    Ok(values)
}

/// Adds a member that is a parameter, or nothing known.
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
    let known = values.takes().map(|parameter| parameter.name);
    let known = known.chain(others.iter().copied());
    let detail = unknown("member", name, known);
    let field = format!("{}{name}", values.path());
    values.refuse(Fault::new(
        &field,
        shown(json),
        detail,
        members(others, groups),
    ));
}

/// The names of all members.
fn members(others: &[&str], groups: &'static [Group]) -> String {
    format!("{}, {}", others.join(", "), names(groups))
}

fn layers(json: &RawValue, listed: &mut usize) -> Checked<Vec<LayerDraft>> {
    let fault = |detail: &str| Faults::from(Fault::new("layers", shown(json), detail, LAYERS));
    let mut layers = vec![];
    let mut unread: Checked<()> = Ok(());
    let mut count = 0;
    let is_array = object::each(json, |i, item| {
        count += 1;
        if i < MOST_LAYERS {
            match layer(&format!("layers[{i}]"), item, listed) {
                Ok(layer) => layers.push(layer),
                Err(fault) => Faults::add(&mut unread, fault),
            }
        }
        true
    });
    if !is_array {
        return Err(fault("must be an array"));
    }
    if count == 0 || count > MOST_LAYERS {
        let detail = if count == 0 {
            "empty"
        } else {
            "too many layers"
        };
        return Err(Fault::new("layers", format!("{count} layers"), detail, LAYERS).into());
    }
    unread.map(|()| layers)
}

fn layer(path: &str, json: &RawValue, listed: &mut usize) -> Result<LayerDraft, Fault> {
    let fault = |detail| Fault::new(path, shown(json), detail, LAYERS);
    let object = Object::read(json).map_err(fault)?;
    let mut layer = LayerDraft::new(Values::new(groups::SET, &format!("{path}.")));
    for (name, json) in object.members() {
        match name {
            "region" => {
                let read = region::read(json, &format!("{path}.region"), listed);
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
                layer.clear_of = object::numbers(json).map_err(wrong);
            }
            name => add_member(&mut layer.values, name, json, &LAYER, groups::SET),
        }
    }
    Ok(layer)
}

#[cfg(test)]
mod tests;
