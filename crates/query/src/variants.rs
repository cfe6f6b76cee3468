//! The variants of points.

use strew_core::Variants;
use strew_error::Checked;

use crate::{parameters::VARIANTS, values::Values};

/// The variants among some values, if there are any.
pub(crate) fn variants(values: &Values) -> Checked<Option<Variants>> {
    let Some(pairs) = values.get::<Vec<(String, f64)>>(&VARIANTS)? else {
        return Ok(None);
    };
    let variants = Variants::new(pairs.iter().map(|(name, weight)| (name.as_str(), *weight)));
    let fault = |error: strew_core::Error| values.fault(&VARIANTS, error.to_string()).into();
    variants.map(Some).map_err(fault)
}
