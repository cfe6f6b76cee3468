//! Words about parameters that all forms share.

use strew_query::{Parameter, Shape};

/// The columns of a line.
const WIDTH: usize = 120;

/// A parameter's meaning, allowed values and default, as one paragraph. Lists, objects and switches have types of their
/// own in programs: only texts write them with commas and colons. `raster` is how a language names the function that
/// makes fields.
pub(super) fn paragraph(parameter: &Parameter, raster: &str) -> String {
    let allowed = match parameter.shape {
        Shape::Switch | Shape::Names { .. } | Shape::Weights | Shape::Ranges | Shape::Fields => {
            String::new()
        }
        Shape::Vertices => " Vertices, or GeoJSON.".into(),
        Shape::Field => format!(" By its name, or as in JSON; see {raster}."),
        _ => format!(" Allowed: {}.", parameter.allowed()),
    };
    let default = parameter.default;
    let default = default.map_or_else(String::new, |default| format!(" Default: {default}."));
    format!("{}{allowed}{default}", parameter.about)
}

/// A paragraph in lines that begin with a prefix.
pub(super) fn wrapped(text: &str, prefix: &str) -> String {
    let mut lines = String::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let is_full = prefix.len() + line.chars().count() + 1 + word.chars().count() > WIDTH;
        if is_full && !line.is_empty() {
            lines += &format!("{prefix}{line}\n");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    lines + &format!("{prefix}{line}\n")
}

/// The kind of a parameter's values, by which bindings read and write texts.
pub(super) const fn kind(shape: Shape) -> &'static str {
    match shape {
        Shape::Number { .. } => "number",
        Shape::Integer { .. } | Shape::Signed { .. } => "integer",
        Shape::Switch => "switch",
        Shape::Strength { .. } => "strength",
        Shape::Numbers(_) | Shape::Integers { .. } => "numbers",
        Shape::Vertices | Shape::Offsets { .. } => "pairs",
        Shape::Names { .. } => "names",
        Shape::Weights => "weights",
        Shape::Ranges => "ranges",
        Shape::Field => "field",
        Shape::Fields => "fields",
        Shape::Choice(_) | Shape::Format | Shape::Quadratic | Shape::Pattern(_) | Shape::Text => {
            "text"
        }
    }
}
