//! Values of parameters as text: numbers, lists of numbers, names with weights.

use std::str::FromStr;

use super::BOX;
use crate::service::{Encoding, Fault};

/// The box `min_x,min_y,max_x,max_y` of a text, as far as it is four numbers.
///
/// # Errors
/// A [`Fault`] of `bbox`.
pub fn read_bbox(text: Option<&str>) -> Result<Option<[f64; 4]>, Fault> {
    let Some(text) = text else { return Ok(None) };
    let fault = |detail: String| Fault::new("bbox", text, detail, BOX);
    let parts: Vec<&str> = text.split(',').collect();
    let parts: [&str; 4] = parts
        .try_into()
        .map_err(|parts: Vec<&str>| fault(format!("it has {} parts, not 4", parts.len())))?;
    let mut corners = [0.0; 4];
    for ((corner, part), name) in corners
        .iter_mut()
        .zip(parts)
        .zip(["min_x", "min_y", "max_x", "max_y"])
    {
        *corner = number(part).map_err(|detail| fault(format!("{name} is `{part}`, {detail}")))?;
    }
    Ok(Some(corners))
}

/// The fault of a format that queries do not have.
pub(super) fn no_format(field: &str, text: &str) -> Fault {
    let allowed = Encoding::ALL.map(Encoding::name).join(", ");
    let detail = if text == Encoding::Parquet.name() {
        "it is made by `strew sample` only"
    } else {
        "there is no such format"
    };
    Fault::new(field, text, detail, allowed)
}

/// `off`, `on` or a number.
pub(super) fn strength(text: &str) -> Option<f64> {
    match text {
        "off" => Some(0.0),
        "on" => Some(1.0),
        _ => finite(text),
    }
}

/// Names with weights, as `oak:3,birch:1`; a weight that is not given is 1.
pub(super) fn variants_of(text: &str) -> Option<Vec<(String, f64)>> {
    let variant = |part: &str| {
        let (name, weight) = part.split_once(':').unwrap_or((part, "1"));
        Some((name.to_owned(), finite(weight)?))
    };
    text.split(',').map(variant).collect()
}

pub(super) fn vertices(text: &str) -> Option<Vec<[f64; 2]>> {
    let values: Vec<f64> = text.split(',').map(finite).collect::<Option<_>>()?;
    let (pairs, []) = values.as_chunks::<2>() else {
        return None;
    };
    Some(pairs.to_vec())
}

/// So many finite numbers joined by commas.
pub(super) fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let values: Vec<f64> = text.split(',').map(finite).collect::<Option<_>>()?;
    values.try_into().ok()
}

pub(super) fn integer<T: FromStr>(text: &str) -> Option<T> {
    text.parse().ok()
}

pub(super) fn finite(text: &str) -> Option<f64> {
    number(text).ok()
}

/// What is wrong with a text that cannot be read.
pub(super) fn wrong(text: &str) -> &'static str {
    match text.parse::<f64>() {
        Ok(value) if value.is_infinite() => "not finite",
        Ok(value) if !value.is_nan() => "it is not such a number",
        _ if text.contains(',') => "it is not such a list",
        _ => "not a number",
    }
}

/// A finite number; otherwise what it is instead.
fn number(text: &str) -> Result<f64, &'static str> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(value) if value.is_nan() => Err("not a number"),
        Ok(_) => Err("not finite"),
        Err(_) => Err("not a number"),
    }
}
