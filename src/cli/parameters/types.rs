//! Parameters for programs: their types (parameters.d.ts) and their names by what they are about (parameters.js) for
//! JavaScript, both for Python (_parameters.py).

use strew_encode::Encoding;
use strew_query::{
    Group, Parameter, SPACE_PARAMETERS, Shape, groups,
    parameters::{BBOX, CRS},
};

use super::words::{
    MEMBERS, NEIGHBORS, OUTPUT, REGIONS, SPACE, Section, VOLUMES, kind, paragraph, quoted, within,
    wrapped,
};

/// The largest integer up to which each is a number of JavaScript.
const SAFE: u64 = (1 << 53) - 1;

/// The interfaces of TypeScript.
pub(super) fn typescript(table: &[&Parameter]) -> String {
    let mut text = "\
// The parameters of queries. `strew parameters --as dts` writes this file from crates/query/src/parameters.rs.

/** Numbers: a list or a typed array. */
export type Numbers = ArrayLike<number>;

/** A list of a known length, or a typed array, whose length types do not know. */
export type Tuple<List extends readonly number[]> = Readonly<List> | Float64Array | Float32Array;
"
    .to_owned();
    for section in [REGIONS, MEMBERS, OUTPUT, NEIGHBORS] {
        text += &interface(&section, table);
    }
    let in_space = [table, SPACE_PARAMETERS].concat();
    for section in [VOLUMES, SPACE] {
        text += &interface(&section, &in_space);
    }
    text
}

fn interface(section: &Section, table: &[&Parameter]) -> String {
    let Section { name, about, .. } = section;
    let mut text = format!("\n/** {about} */\nexport interface {name} {{\n");
    for parameter in section.of(table) {
        let lines = wrapped(&paragraph(parameter, "`raster`"), "     * ");
        let (name, of) = (parameter.name, script_type(parameter));
        text += &format!("    /**\n{lines}     */\n    {name}?: {of};\n");
    }
    text + "}\n"
}

/// The type of a parameter's values. A region that is null is no region.
fn script_type(parameter: &Parameter) -> String {
    match parameter.shape {
        Shape::Numbers(names) => {
            let is_region = matches!(parameter.group, Group::Region | Group::Volume);
            let or_none = if is_region { " | null" } else { "" };
            let tuple = |names: &[&str]| {
                let names: Vec<String> =
                    names.iter().map(|name| format!("{name}: number")).collect();
                format!("Tuple<[{}]>", names.join(", "))
            };
            // Circles and balls, as JSON has them.
            let or_object = match names {
                [center @ .., "radius"] => {
                    format!(" | {{ center: {}; radius: number }}", tuple(center))
                }
                _ => String::new(),
            };
            return format!("{}{or_object}{or_none}", tuple(names));
        }
        Shape::Vertices => "ArrayLike<Numbers> | object | null",
        Shape::Number { .. } | Shape::Signed { .. } => "number",
        // As text, too: so JSON has integers that a number does not hold.
        Shape::Integer { max, .. } if max > SAFE => "number | bigint | `${number}`",
        Shape::Integer { .. } => "number",
        Shape::Switch => "boolean",
        Shape::Strength { .. } => "\"on\" | \"off\" | number",
        Shape::Integers { .. } => "Numbers",
        Shape::Offsets { .. } => "ArrayLike<Numbers>",
        Shape::Names { .. } => "string | readonly string[]",
        Shape::Weights => "Record<string, number>",
        Shape::Ranges => "Record<string, Tuple<[min: number, max: number]>>",
        Shape::Field => "string | object",
        Shape::Fields => "Record<string, string | object>",
        Shape::Choice(words) => {
            let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
            return words.join(" | ");
        }
        Shape::Quadratic => "string | number",
        Shape::Format | Shape::Pattern(_) | Shape::Text => "string",
    }
    .into()
}

/// The names and kinds for JavaScript.
pub(super) fn javascript(table: &[&Parameter]) -> String {
    let of = |groups| quoted(&within(table, groups));
    let (regions, window, output) = (of(REGIONS.groups), of(&[Group::Window]), of(OUTPUT.groups));
    let kinds: String = (within(table, groups::POINTS).into_iter())
        .map(|of| format!("    {}: \"{}\",\n", of.name, kind(of.shape)))
        .collect();
    format!(
        "\
// The names of parameters. `strew parameters --as js` writes this file from crates/query/src/parameters.rs.

/** Regions that are parameters by themselves. */
export const REGIONS = [{regions}];
/** Which part of the points an answer has. */
export const WINDOW = [{window}];
/** The form of an answer. */
export const OUTPUT = [{output}];
/** The kinds of values by their parameters. */
export const KINDS = {{
{kinds}}};
"
    )
}

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

/// The module of Python.
pub(super) fn python(table: &[&Parameter]) -> String {
    let mut text = HEAD.to_owned();
    for section in [REGIONS, MEMBERS, OUTPUT] {
        text += &class(&section, table);
    }
    let of = |groups| quoted(&within(table, groups));
    let (regions, window, output) = (of(REGIONS.groups), of(&[Group::Window]), of(OUTPUT.groups));
    let kinds: String = (within(table, groups::POINTS).into_iter())
        .map(|of| format!("    \"{}\": \"{}\",\n", of.name, kind(of.shape)))
        .collect();
    let placed: String = (Encoding::every().filter(|encoding| encoding.has_crs()))
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
        text += &format!("    {name}: {} | None\n", python_type(parameter));
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
    let paragraph = paragraph(parameter, "`strew.raster`");
    let mut text = format!("    {:?}: (\n", keyword(parameter));
    for line in wrapped(&paragraph, "        ").lines() {
        let line = format!("{} ", line.trim());
        text += &format!("        {line:?}\n");
    }
    text + "    ),\n"
}

/// The type of a parameter's values.
fn python_type(parameter: &Parameter) -> &'static str {
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
