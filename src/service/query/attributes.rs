//! Attributes: the values that points are to have besides their place.

use serde_json::{Value, json};
use strew_core::{Attribute, Attributes, ScaleRange, UniformNumber, Variants};

use super::{number, region::listed};
use crate::service::Fault;

/// What a list of attributes may be.
pub(super) const ATTRIBUTES: &str =
    "different names of angle, scale, variant, rank and u1 to u16, joined by commas";
/// What a range of scales may be.
pub(super) const SCALE_RANGE: &str = "two numbers min,max with 0 <= min <= max <= 1e9";
/// What a list of variants may be.
pub(super) const VARIANTS: &str = "name:weight joined by commas, such as oak:3,birch:1: 1 to 256 \
                                   different names of up to 64 characters, weights 1e-9 to 1e9";

/// Attributes as they were asked for, not checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AttributesDraft {
    /// Their names, in order.
    pub names: Vec<String>,
    /// The least and the greatest scale; 0 to 1 by default.
    pub scale_range: Option<[f64; 2]>,
    /// The variants with their weights.
    pub variants: Option<Vec<(String, f64)>>,
}

impl AttributesDraft {
    /// Checks them; `path` is put before the names of fields.
    pub(super) fn check(&self, path: &str) -> Result<Attributes, Fault> {
        let field = |name: &str| format!("{path}{name}");
        let unused = |name: &str, value: String, by: &str| {
            let detail = format!("it means nothing without the attribute {by}");
            Fault::new(
                &field(name),
                value,
                detail,
                format!("{by} among attributes"),
            )
        };
        let has = |name: &str| self.names.iter().any(|other| other == name);
        if let Some(range) = self.scale_range
            && !has("scale")
        {
            return Err(unused("scale_range", listed(&range), "scale"));
        }
        if let Some(variants) = &self.variants
            && !has("variant")
        {
            return Err(unused("variants", joined(variants), "variant"));
        }
        let list: Vec<Attribute> = self
            .names
            .iter()
            .map(|name| self.attribute(name, path))
            .collect::<Result<_, _>>()?;
        Attributes::new(list).map_err(|error| {
            let value = self.names.join(",");
            Fault::new(&field("attributes"), value, error.to_string(), ATTRIBUTES)
        })
    }

    fn attribute(&self, name: &str, path: &str) -> Result<Attribute, Fault> {
        let field = |name: &str| format!("{path}{name}");
        match name {
            "scale" => {
                let [min, max] = self.scale_range.unwrap_or([0.0, 1.0]);
                let scale = ScaleRange::new(min, max).map(Attribute::Scale);
                scale.map_err(|error| {
                    let value = listed(&[min, max]);
                    Fault::new(&field("scale_range"), value, error.to_string(), SCALE_RANGE)
                })
            }
            "variant" => {
                let Some(variants) = &self.variants else {
                    return Err(Fault::missing(&field("variants"), VARIANTS));
                };
                // The order in which they are written does not matter: not every writer of JSON keeps
                // that of an object's members.
                let mut sorted: Vec<_> = variants.iter().collect();
                sorted.sort_by(|a, b| a.0.cmp(&b.0));
                let pairs = sorted.into_iter();
                Variants::new(pairs.map(|(name, weight)| (name.as_str(), *weight)))
                    .map(Attribute::Variant)
                    .map_err(|error| {
                        Fault::new(
                            &field("variants"),
                            joined(variants),
                            error.to_string(),
                            VARIANTS,
                        )
                    })
            }
            name => name.parse().map_err(|error: strew_core::Error| {
                Fault::new(&field("attributes"), name, error.to_string(), ATTRIBUTES)
            }),
        }
    }
}

/// As answers echo them: by name, with what they need.
pub(super) fn echo(attributes: &Attributes) -> Value {
    let one = |attribute: &Attribute| {
        let mut value = json!({ "name": attribute.name() });
        match attribute {
            Attribute::Scale(range) => value["range"] = json!([range.min(), range.max()]),
            Attribute::Variant(variants) => {
                let weights = variants.weights();
                value["variants"] = weights
                    .map(|(name, weight)| json!({ "name": name, "weight": weight }))
                    .collect();
            }
            _ => {}
        }
        value
    };
    attributes.as_slice().iter().map(one).collect()
}

/// As a text has them.
fn joined(variants: &[(String, f64)]) -> String {
    let pairs = variants
        .iter()
        .map(|(name, weight)| format!("{name}:{}", number(*weight)));
    pairs.collect::<Vec<_>>().join(",")
}

/// How many uniform numbers there are, for the list above.
const _: () = assert!(UniformNumber::MAX == 16 && Variants::MAX == 256 && Variants::MAX_NAME == 64);
