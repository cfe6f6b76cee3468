//! `strew parameters`: the table of parameters as types of the bindings (parameters.d.ts and parameters.js for JavaScript,
//! _parameters.py for Python) and as documentation.
//!
//! The repository keeps the output in files, so a parameter is written once. A test compares them;
//! `UPDATE_GOLDEN=1 cargo test -p strew --lib cli::parameters` writes them.

use strew_encode::Encoding;
use strew_query::{
    Group, Parameter, SPACE_PARAMETERS, Shape, groups,
    parameters::{ATTRIBUTES, BBOX, CRS, FORMAT, PARAMETERS},
};

use super::{Failure, output};

/// Flags of `strew parameters`.
#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The form to print: types for TypeScript (dts), names and kinds for JavaScript (js), both for Python (py), or a
    /// table in Markdown (md).
    #[arg(long = "as", value_name = "FORM")]
    form: Form,
}

/// A form of the table.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Form {
    /// bindings/js/lib/parameters.d.ts
    Dts,
    /// bindings/js/lib/parameters.js
    Js,
    /// bindings/python/strew/_parameters.py
    Py,
    /// The table in docs/api.md
    Md,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    output::write(None, args.form.text(PARAMETERS).as_bytes())
}

impl Form {
    fn text(self, table: &[&Parameter]) -> String {
        match self {
            Self::Dts => typescript(table),
            Self::Js => javascript(table),
            Self::Py => python(table),
            Self::Md => markdown(table),
        }
    }
}

fn markdown(table: &[&Parameter]) -> String {
    let row = |parameter: &&Parameter| {
        let place = match parameter.group {
            Group::Nearest => "`/v1/nearest`: ",
            Group::Listed => "`/v1/periods`: ",
            Group::Split => "`/v1/points:split`: ",
            _ => "",
        };
        let default = match parameter.default {
            None if parameter.is_required => "required",
            default => default.unwrap_or_default(),
        };
        let cells = [parameter.about, &parameter.allowed(), default];
        let [about, allowed, default] = cells.map(|cell| cell.replace('|', "\\|"));
        let name = parameter.name;
        format!("| `{name}` | {place}{about} | {allowed} | {default} |\n")
    };
    let rows: String = table.iter().map(row).collect();
    format!("| parameter | meaning | values | default |\n|---|---|---|---|\n{rows}")
}

struct Section {
    name: &'static str,
    about: &'static str,
    groups: &'static [Group],
}

/// The types of a query, and those that only programs in TypeScript have.
const SECTIONS: [Section; 6] = [
    Section {
        name: "Regions",
        about: "Regions that are parameters by themselves: a query has one of them, or a member `region`.",
        groups: &[Group::Region],
    },
    Section {
        name: "Parameters",
        about: "The parameters of a query: which points, and which part of them.",
        groups: groups::QUERY,
    },
    Section {
        name: "Output",
        about: "The options of a document, beside its format.",
        groups: groups::OUTPUT,
    },
    Section {
        name: "Neighbors",
        about: "The bounds of a search for the nearest points.",
        groups: &[Group::Nearest, Group::Neighbors],
    },
    Section {
        name: "VolumeParameters",
        about: "Volumes that are parameters by themselves: a query in space has one of them, or a member `region`.",
        groups: &[Group::Volume],
    },
    Section {
        name: "SpaceParameters",
        about: "The parameters of a query in space: which points, and which part of them.",
        groups: groups::SPACE_QUERY,
    },
];

fn of_query() -> &'static [Section] {
    &SECTIONS[..3]
}

impl Section {
    /// Its parameters in a table. Bindings have arguments of their own for what is required, and for the format. The
    /// options of documents are a section of their own.
    fn of<'a>(&self, table: &[&'a Parameter]) -> Vec<&'a Parameter> {
        let mut taken = within(table, self.groups);
        let is_output = self.groups == groups::OUTPUT;
        taken.retain(|&parameter| {
            let is_own = groups::OUTPUT.contains(&parameter.group) == is_output;
            is_own && !parameter.is_required && *parameter != FORMAT
        });
        taken
    }
}

fn within<'a>(table: &[&'a Parameter], groups: &[Group]) -> Vec<&'a Parameter> {
    let taken = table.iter().copied();
    taken
        .filter(|parameter| groups.contains(&parameter.group))
        .collect()
}

const WIDTH: usize = 120;

/// A parameter's meaning, allowed values and default, as one paragraph. Lists, objects and switches have types of their
/// own in programs: only texts write them with commas and colons. `raster` is how a language names the function that
/// makes fields.
fn paragraph(parameter: &Parameter, raster: &str) -> String {
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

fn wrapped(text: &str, prefix: &str) -> String {
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

/// The largest integer up to which each is a number of JavaScript.
const SAFE: u64 = (1 << 53) - 1;

/// The kind of a shape's values, by which bindings read and write texts, and their types in TypeScript and Python.
const fn words(shape: Shape) -> [&'static str; 3] {
    match shape {
        Shape::Number { .. } => ["number", "number", "Number"],
        // As text, too: so JSON has integers that a number does not hold.
        Shape::Integer { max, .. } if max > SAFE => {
            ["integer", "number | bigint | `${number}`", "Integer"]
        }
        Shape::Integer { .. } | Shape::Signed { .. } => ["integer", "number", "Integer"],
        Shape::Switch => ["switch", "boolean", "bool"],
        Shape::Strength { .. } => ["strength", "\"on\" | \"off\" | number", "str | Number"],
        Shape::Numbers(_) | Shape::Integers { .. } => ["numbers", "Numbers", "Numbers"],
        // In Python vertices, GeoJSON, or an object with `__geo_interface__`.
        Shape::Vertices => ["pairs", "ArrayLike<Numbers> | object | null", "Any"],
        Shape::Offsets { .. } => ["pairs", "ArrayLike<Numbers>", "Sequence[Numbers]"],
        Shape::Names { .. } => ["names", "string | readonly string[]", "str | Sequence[str]"],
        Shape::Weights => ["weights", "Record<string, number>", "Mapping[str, Number]"],
        Shape::Ranges => {
            let of = "Record<string, Tuple<[min: number, max: number]>>";
            ["ranges", of, "Mapping[str, Numbers]"]
        }
        Shape::Field => ["field", "string | object", "str | Mapping[str, Any]"],
        Shape::Fields => {
            let of = "Record<string, string | object>";
            ["fields", of, "Mapping[str, str | Mapping[str, Any]]"]
        }
        Shape::Quadratic => ["text", "string | number", "str | Number"],
        Shape::Choice(_) | Shape::Format | Shape::Pattern(_) | Shape::Text => {
            ["text", "string", "str"]
        }
    }
}

/// The names of regions, of parts of the points and of options of documents; and lines with the kinds of all values.
fn lists(table: &[&Parameter], mark: &str) -> [String; 4] {
    let of = |groups| {
        let names = within(table, groups).into_iter();
        let quoted = names.map(|parameter| format!("\"{}\"", parameter.name));
        quoted.collect::<Vec<_>>().join(", ")
    };
    let kinds = within(table, groups::POINTS).into_iter();
    let kinds =
        kinds.map(|of| format!("    {mark}{}{mark}: \"{}\",\n", of.name, words(of.shape)[0]));
    [
        of(&[Group::Region]),
        of(&[Group::Window]),
        of(groups::OUTPUT),
        kinds.collect(),
    ]
}

fn typescript(table: &[&Parameter]) -> String {
    let mut text = "\
// The parameters of queries. `strew parameters --as dts` writes this file from crates/query/src/parameters.rs.

/** Numbers: a list or a typed array. */
export type Numbers = ArrayLike<number>;

/** A list of a known length, or a typed array, whose length types do not know. */
export type Tuple<List extends readonly number[]> = Readonly<List> | Float64Array | Float32Array;
"
    .to_owned();
    let all = [table, SPACE_PARAMETERS].concat();
    text.extend(SECTIONS.iter().map(|section| interface(section, &all)));
    text
}

fn interface(section: &Section, table: &[&Parameter]) -> String {
    let Section { name, about, .. } = section;
    // Parameters that queries of the plane have as well are written once.
    let plane = &SECTIONS[1];
    let known = plane.of(table);
    let is_known = |of: &&Parameter| known.iter().any(|known| known.about == of.about);
    let in_space = section.groups == groups::SPACE_QUERY;
    let (shared, own): (Vec<&Parameter>, Vec<_>) =
        (section.of(table).into_iter()).partition(|of| in_space && is_known(of));
    let names = shared.iter().map(|of| format!("\"{}\"", of.name));
    let names = wrapped(&names.collect::<Vec<_>>().join(" | "), "    ");
    let base = match shared.as_slice() {
        [] => String::new(),
        _ => format!(" extends Pick<\n    {},\n{names}>", plane.name),
    };
    let mut text = format!("\n/** {about} */\nexport interface {name}{base} {{\n");
    for parameter in own {
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
                let names = names.iter().map(|name| format!("{name}: number"));
                format!("Tuple<[{}]>", names.collect::<Vec<_>>().join(", "))
            };
            // Circles and balls, as JSON has them.
            let or_object = match names {
                [center @ .., "radius"] => {
                    format!(" | {{ center: {}; radius: number }}", tuple(center))
                }
                _ => String::new(),
            };
            format!("{}{or_object}{or_none}", tuple(names))
        }
        Shape::Choice(words) => {
            let words = words.iter().map(|word| format!("\"{word}\""));
            words.collect::<Vec<_>>().join(" | ")
        }
        shape => words(shape)[1].into(),
    }
}

fn javascript(table: &[&Parameter]) -> String {
    let [regions, window, output, kinds] = lists(table, "");
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
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Union

import numpy as np

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

Number: TypeAlias = \"Union[float, np.integer[Any], np.floating[Any]]\"
Integer: TypeAlias = \"Union[int, np.integer[Any]]\"
Numbers: TypeAlias = \"Union[Sequence[Number], np.ndarray[Any, Any]]\"
Attribute: TypeAlias = Literal[
    \"angle\", \"scale\", \"variant\", \"rank\", \"u1\", \"u2\", \"u3\", \"u4\", \"u5\", \"u6\",
    \"u7\", \"u8\", \"u9\", \"u10\", \"u11\", \"u12\", \"u13\", \"u14\", \"u15\", \"u16\",
]
";

/// Parameters that are classes of their own in Python: calls have one of the first and of the second, which their types
/// name one by one, and those of points in space have the last as well.
const APART: [(&str, &str, &[Group]); 3] = [
    (
        "Amounts",
        "How densely points lie: a set has one of them.",
        &[Group::Amount, Group::Count],
    ),
    (
        "World",
        "What a query may leave everything open to.",
        &[Group::World],
    ),
    (
        "Common",
        "The parameters of queries of the plane and in space.",
        &[
            Group::Profile,
            Group::Table,
            Group::Points,
            Group::Except,
            Group::Choices,
            Group::Window,
        ],
    ),
];

/// Words of the language, which cannot be keywords of calls.
const RESERVED: [&str; 32] = [
    "and", "as", "assert", "async", "await", "break", "class", "continue", "def", "del", "elif",
    "else", "except", "finally", "for", "from", "global", "if", "import", "in", "is", "lambda",
    "nonlocal", "not", "or", "pass", "raise", "return", "try", "while", "with", "yield",
];

fn python(table: &[&Parameter]) -> String {
    let mut text = HEAD.to_owned();
    for section in of_query() {
        let mut parameters = section.of(table);
        for (name, about, groups) in APART {
            let own = parameters.extract_if(.., |parameter| groups.contains(&parameter.group));
            let own: Vec<_> = own.collect();
            if !own.is_empty() {
                text += &class(name, about, own);
            }
        }
        text += &class(section.name, section.about, parameters);
    }
    let [regions, window, output, kinds] = lists(table, "\"");
    // A kind stays beside its name.
    let kinds = wrapped(&kinds.replace(": ", ":~"), "    ").replace(":~", ": ");
    let placed: String = (Encoding::every().filter(|encoding| encoding.has_crs()))
        .map(|encoding| format!("\"{}\", ", encoding.name()))
        .collect();
    let about: String = of_query()
        .iter()
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

fn class(name: &str, about: &str, parameters: Vec<&Parameter>) -> String {
    let mut text =
        format!("\n\nclass {name}(TypedDict, total=False):\n    \"\"\"{about}\"\"\"\n\n");
    for parameter in parameters {
        let name = keyword(parameter);
        text += &format!("    {name}: {} | None\n", python_type(parameter));
    }
    text
}

fn keyword(parameter: &Parameter) -> String {
    let name = parameter.name;
    let mark = if RESERVED.contains(&name) { "_" } else { "" };
    format!("{name}{mark}")
}

/// What sets have in Python in place of the headers of answers.
const ATTRIBUTES_FOR_HEADERS: [(&str, &str); 3] = [
    ("The header strew-next is", "`points.next` is"),
    ("the value of its header strew-next", "its `points.next`"),
    ("the header strew-table", "`points.tables`"),
];

/// The entry of a parameter among the texts: its keyword, and its paragraph as a text of several lines.
fn about(parameter: &Parameter) -> String {
    let mut paragraph = paragraph(parameter, "`strew.raster`");
    for (header, own) in ATTRIBUTES_FOR_HEADERS {
        paragraph = paragraph.replace(header, own);
    }
    let name = format!("    {:?}: ", keyword(parameter));
    let indent = " ".repeat(name.len());
    // Quotes and the space between words take three more places.
    let lines = wrapped(&paragraph, &format!("{indent}   "));
    let lines = lines
        .lines()
        .map(|line| format!("{:?}", format!("{} ", line.trim())));
    let lines: Vec<String> = lines.collect();
    format!("{name}{},\n", lines.join(&format!("\n{indent}")))
}

fn python_type(parameter: &Parameter) -> &'static str {
    match parameter.shape {
        // Circles.
        Shape::Numbers(_) if parameter.group == Group::Region && *parameter != BBOX => {
            "Numbers | Mapping[str, Any]"
        }
        // A code, a name, or an object of pyproj.
        _ if *parameter == CRS => "Any",
        _ if *parameter == ATTRIBUTES => "Attribute | Sequence[Attribute]",
        shape => words(shape)[2],
    }
}

#[cfg(test)]
mod tests {
    use std::{fs, path::Path};

    use clap::ValueEnum as _;

    use super::*;
    use crate::recipe::ADDED;

    fn file(form: Form) -> &'static str {
        match form {
            Form::Dts => "bindings/js/lib/parameters.d.ts",
            Form::Js => "bindings/js/lib/parameters.js",
            Form::Py => "bindings/python/strew/_parameters.py",
            Form::Md => "docs/api.md",
        }
    }

    /// The content of a file with a new text in place of the generated one.
    fn renewed(form: Form, content: &str) -> String {
        let text = form.text(PARAMETERS);
        let [begin, end] = ["<!-- strew parameters --as md -->\n\n", "\n<!-- end -->\n"];
        match form {
            Form::Md => {
                let (before, rest) = content.split_once(begin).expect("where the table begins");
                let (_, after) = rest.split_once(end).expect("where it ends");
                [before, begin, &text, end, after].concat()
            }
            _ => text,
        }
    }

    #[test]
    fn the_generated_files_are_the_committed_ones() {
        for &form in Form::value_variants() {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file(form));
            let content = fs::read_to_string(&path).unwrap_or_default();
            let renewed = renewed(form, &content);
            if std::env::var_os("UPDATE_GOLDEN").is_some() {
                fs::write(&path, &renewed).expect("writable");
            } else {
                assert!(
                    content == renewed,
                    "{} differs from the table of parameters. To accept the change: \
                     UPDATE_GOLDEN=1 cargo test -p strew --lib cli::parameters",
                    file(form)
                );
            }
        }
    }

    /// With `recipe.rs` in strew-query: an entry is all that the bindings and the documentation need.
    #[test]
    fn an_added_parameter_is_in_all_of_them() {
        let table = [PARAMETERS, &[&ADDED]].concat();
        for (form, expected) in [
            (Form::Dts, "     */\n    added?: number;\n"),
            (Form::Js, "    added: \"integer\",\n"),
            (Form::Py, "    added: Integer | None\n"),
            (Form::Py, "\"added\": \"integer\","),
            (
                Form::Md,
                "| `added` | Made for a test. | an integer from 1 to 9 | 1 |\n",
            ),
        ] {
            let text = form.text(&table);
            assert!(text.contains(expected), "{form:?}: {text}");
            assert!(!form.text(PARAMETERS).contains("added"));
        }
    }

    #[test]
    fn every_member_is_typed() {
        let typed: Vec<_> = of_query()
            .iter()
            .flat_map(|section| section.of(PARAMETERS))
            .collect();
        for parameter in within(PARAMETERS, groups::POINTS) {
            let is_typed = typed.contains(&parameter) || *parameter == FORMAT;
            assert!(is_typed, "{}", parameter.name);
        }
    }
}
