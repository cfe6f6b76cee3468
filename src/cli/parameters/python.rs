//! The parameters as Python has them: classes of keywords, and their meaning for docstrings.

use strew_encode::Encoding;
use strew_query::{
    Group, Parameter, Shape,
    parameters::{ATTRIBUTES, BBOX, CRS},
};

use super::sections::{lists, of_query, paragraph, words, wrapped};

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

pub(super) fn python(table: &[&Parameter]) -> String {
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
    let placed = Encoding::ALL.iter().filter(|of| of.traits().has_crs);
    let placed: String = placed.map(|of| format!("\"{}\", ", of.name())).collect();
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

/// What sets in Python offer where answers have headers.
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
