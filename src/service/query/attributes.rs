//! Attributes: the values that points have besides their place.

use strew_core::{Attribute, Attributes, ScaleRange, Variants};

use super::{
    Checked, Parameter, Together as _, Values,
    parameters::{ATTRIBUTES, SCALE_RANGE, VARIANTS},
};
use crate::service::Fault;

/// Checks the attributes among some values.
pub(super) fn check(values: &Values) -> Checked<Attributes> {
    let (names, range, variants) = (
        values.get::<Vec<String>>(&ATTRIBUTES),
        values.get::<[f64; 2]>(&SCALE_RANGE),
        values.get::<Vec<(String, f64)>>(&VARIANTS),
    )
        .together()?;
    let names = names.unwrap_or_default();
    let without = |parameter: &'static Parameter, attribute: &str| -> Option<Fault> {
        let is_unused = values.has(parameter) && !names.iter().any(|name| name == attribute);
        is_unused.then(|| {
            values.fault(
                parameter,
                format!("has no effect without the attribute {attribute}"),
            )
        })
    };
    if let Some(fault) = without(&SCALE_RANGE, "scale").or_else(|| without(&VARIANTS, "variant")) {
        return Err(fault.into());
    }
    let one = |name: &String| -> Result<Attribute, Fault> {
        match name.as_str() {
            "scale" => {
                let [min, max] = range.unwrap_or([0.0, 1.0]);
                let scale = ScaleRange::new(min, max).map(Attribute::Scale);
                scale.map_err(|error| values.fault(&SCALE_RANGE, error.to_string()))
            }
            "variant" => {
                let variants = variants.as_ref().ok_or_else(|| values.missing(&VARIANTS))?;
                let pairs = variants.iter();
                let variants = Variants::new(pairs.map(|(name, weight)| (name.as_str(), *weight)));
                let fault = |error: strew_core::Error| values.fault(&VARIANTS, error.to_string());
                variants.map(Attribute::Variant).map_err(fault)
            }
            name => name.parse().map_err(|error: strew_core::Error| {
                let field = format!("{}{}", values.path(), ATTRIBUTES.name);
                Fault::new(&field, name, error.to_string(), ATTRIBUTES.allowed())
            }),
        }
    };
    let list: Vec<Attribute> = names.iter().map(one).collect::<Result<_, _>>()?;
    let fault = |error: strew_core::Error| values.fault(&ATTRIBUTES, error.to_string()).into();
    Attributes::new(list).map_err(fault)
}
