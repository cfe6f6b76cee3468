//! Parameters for Python (_parameters.py): their types, and their names by what they are about.

use strew_encode::Encoding;
use strew_query::{
    Group, Parameter, Shape, groups,
    parameters::{BBOX, CRS},
};

use super::{
    section::{MEMBERS, OUTPUT, REGIONS, Section, quoted, within},
    words,
};

const HEAD: &str = "\
\"\"\"The parameters of queries. ``strew parameters --as py`` writes this file from crates/query/src/parameters.rs.\"\"\"

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypedDict, Union

import numpy as np

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

Number: TypeAlias = \"Union[float, np.integer[Any], np.floating[Any]]\"
Integer: TypeAlias = \"Union[int, np.integer[Any]]\"
Numbers: TypeAlias = \"Union[Sequence[Number], np.ndarray[Any, Any]]\"
";

/// Words of the language, which cannot be keywords of calls.
const RESERVED: [&str; 32] = [
    "and", "as", "assert", "async", "await", "break", "class", "continue", "def", "del", "elif",
    "else", "except", "finally", "for", "from", "global", "if", "import", "in", "is", "lambda",
    "nonlocal", "not", "or", "pass", "raise", "return", "try", "while", "with", "yield",
];

/// The module.
pub(super) fn module(table: &[&Parameter]) -> String {
    let mut text = HEAD.to_owned();
    for section in [REGIONS, MEMBERS, OUTPUT] {
        text += &class(&section, table);
    }
    let of = |groups| quoted(&within(table, groups));
    let (regions, window, output) = (of(REGIONS.groups), of(&[Group::Window]), of(OUTPUT.groups));
    let kinds: String = (within(table, groups::POINTS).into_iter())
        .map(|of| format!("    \"{}\": \"{}\",\n", of.name, words::kind(of.shape)))
        .collect();
    let placed = Encoding::ALL.iter().chain(&Encoding::FILES);
    let placed: String = (placed.filter(|encoding| encoding.has_crs()))
        .map(|encoding| format!("\"{}\", ", encoding.name()))
        .collect();
    let about: String = ([REGIONS, MEMBERS, OUTPUT].iter())
        .flat_map(|section| section.of(table))
        .map(about)
        .collect();
    text + &format!(
        "

#: Regions that are parameters by themselves.
REGIONS = ({regions})
#: Which part of the points an answer has.
WINDOW = ({window})
#: The form of an answer.
OUTPUT = ({output})
#: The formats that state the reference system of the plane.
PLACED = ({})
#: The kinds of values by their parameters.
KINDS = {{
{kinds}}}
#: The meaning, the allowed values and the default of each parameter, which docstrings show.
ABOUT = {{
{about}}}
",
        placed.trim_end()
    )
}

fn class(section: &Section, table: &[&Parameter]) -> String {
    let Section { name, about, .. } = section;
    let mut text =
        format!("\n\nclass {name}(TypedDict, total=False):\n    \"\"\"{about}\"\"\"\n\n");
    for parameter in section.of(table) {
        let name = keyword(parameter);
        text += &format!("    {name}: {} | None\n", type_of(parameter));
    }
    text
}

/// The name of a parameter as a keyword of calls.
fn keyword(parameter: &Parameter) -> String {
    let name = parameter.name;
    let mark = if RESERVED.contains(&name) { "_" } else { "" };
    format!("{name}{mark}")
}

/// The entry of a parameter among the texts: its keyword, and its paragraph as a text of several lines.
fn about(parameter: &Parameter) -> String {
    let paragraph = words::paragraph(parameter, "`strew.raster`");
    let mut text = format!("    {:?}: (\n", keyword(parameter));
    for line in words::wrapped(&paragraph, "        ").lines() {
        let line = format!("{} ", line.trim());
        text += &format!("        {line:?}\n");
    }
    text + "    ),\n"
}

/// The type of a parameter's values.
fn type_of(parameter: &Parameter) -> &'static str {
    match parameter.shape {
        _ if *parameter == BBOX => "Numbers",
        Shape::Numbers(_) if parameter.group == Group::Region => "Numbers | Mapping[str, Any]",
        // Vertices, GeoJSON, or an object with `__geo_interface__`.
        Shape::Vertices => "Any",
        // A code, a name, or an object of pyproj.
        _ if *parameter == CRS => "Any",
        Shape::Number { .. } => "Number",
        Shape::Integer { .. } | Shape::Signed { .. } => "Integer",
        Shape::Switch => "bool",
        Shape::Strength { .. } | Shape::Quadratic => "str | Number",
        Shape::Numbers(_) | Shape::Integers { .. } => "Numbers",
        Shape::Offsets { .. } => "Sequence[Numbers]",
        Shape::Names { .. } => "str | Sequence[str]",
        Shape::Weights => "Mapping[str, Number]",
        Shape::Ranges => "Mapping[str, Numbers]",
        Shape::Field => "str | Mapping[str, Any]",
        Shape::Fields => "Mapping[str, str | Mapping[str, Any]]",
        Shape::Choice(_) | Shape::Format | Shape::Pattern(_) | Shape::Text => "str",
    }
}
