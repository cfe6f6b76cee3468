//! Numbers and lists of numbers and names, as text has them.

use std::{borrow::Cow, iter, sync::Arc};

use strew_catalog::field::Document;
use strew_error::number;

pub(super) type Detail = Cow<'static, str>;

pub(super) fn listed(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().copied().map(number).collect();
    values.join(",")
}

pub(super) fn finite(text: &str) -> Result<f64, &'static str> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(value) if value.is_nan() => Err("must be a number"),
        Ok(_) => Err("must be finite"),
        Err(_) => Err("must be a number"),
    }
}

/// The parts of a text between characters of ASCII. (`str::split` takes several times as long for short ones.)
pub(super) fn parts(text: &str, between: u8) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    iter::from_fn(move || {
        let text = rest.take()?;
        let Some(at) = text.bytes().position(|byte| byte == between) else {
            return Some(text);
        };
        rest = text.get(at + 1..);
        text.get(..at)
    })
}

/// Numbers joined by commas, each named by one of `names` while there are any.
pub(super) fn numbers(text: &str, names: &[&str]) -> Result<Vec<f64>, Detail> {
    let part = |(i, part): (usize, &str)| {
        let part = part.trim();
        finite(part).map_err(|detail| -> Detail {
            match (names.get(i), part) {
                (Some(name), "") => format!("{name} is missing").into(),
                (Some(name), part) => format!("{name} is `{part}`, which {detail}").into(),
                (None, "") => "a number is missing".into(),
                (None, part) => format!("`{part}` {detail}").into(),
            }
        })
    };
    parts(text, b',').enumerate().map(part).collect()
}

/// Pairs joined by commas, with spaces between them, each of which may be a plus.
pub(super) fn offsets(text: &str) -> Result<Vec<f64>, Detail> {
    let pairs = text.split(|c: char| c.is_whitespace() || c == '+');
    let pair = |text: &str| -> Result<[f64; 2], Detail> {
        let refused = || Detail::from(format!("`{text}` must be two integers joined by a comma"));
        let (x, y) = text.split_once(',').ok_or_else(refused)?;
        let read = |text: &str| finite(text.trim()).map_err(|_| refused());
        Ok([read(x)?, read(y)?])
    };
    let pairs = pairs.filter(|text| !text.is_empty()).map(pair);
    Ok(pairs.collect::<Result<Vec<_>, _>>()?.into_flattened())
}

pub(super) fn integers(values: &[f64], limit: i64) -> Result<(), Detail> {
    for value in values {
        if value.fract() != 0.0 {
            return Err(format!("{} must be an integer", number(*value)).into());
        }
        if value.abs() > limit as f64 {
            return Err(format!("{} is out of range", number(*value)).into());
        }
    }
    Ok(())
}

/// Names with weights, such as `oak:3,birch:1`; the weight of a name without one is 1.
pub(super) fn weights(text: &str) -> Result<Vec<(String, f64)>, Detail> {
    let pair = |part: &str| {
        let (name, weight) = part.split_once(':').unwrap_or((part, "1"));
        let weight = weight.trim();
        let read = finite(weight).map_err(|detail| format!("the weight `{weight}` {detail}"))?;
        Ok((name.trim().to_owned(), read))
    };
    text.split(',').map(pair).collect()
}

/// Names with the names of fields, such as `birch:river`.
pub(super) fn fields(text: &str) -> Result<Vec<(String, Arc<Document>)>, Detail> {
    let pair = |part: &str| {
        let Some((name, field)) = part.split_once(':') else {
            return Err(format!("`{part}` must be name:field").into());
        };
        let field = Document::Name(field.trim().to_owned());
        Ok((name.trim().to_owned(), field.into()))
    };
    text.split(',').map(pair).collect()
}

/// Names with two numbers each, such as `oak:0.8:1.2`.
pub(super) fn ranges(text: &str) -> Result<Vec<(String, [f64; 2])>, Detail> {
    let range = |part: &str| {
        let mut parts = part.split(':').map(str::trim);
        let (Some(name), Some(min), Some(max), None) =
            (parts.next(), parts.next(), parts.next(), parts.next())
        else {
            return Err(format!("`{part}` must be name:min:max").into());
        };
        let read = |number: &str| {
            finite(number).map_err(|detail| format!("`{number}` of `{name}` {detail}"))
        };
        Ok((name.to_owned(), [read(min)?, read(max)?]))
    };
    text.split(',').map(range).collect()
}
