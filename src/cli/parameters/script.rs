//! Parameters for JavaScript: their types (parameters.d.ts), and their names by what they are about (parameters.js).

use strew_query::{Group, Parameter, SPACE_PARAMETERS, Shape, groups};

use super::{
    section::{MEMBERS, NEIGHBORS, OUTPUT, REGIONS, SPACE, Section, VOLUMES, quoted, within},
    words,
};

/// The largest integer up to which each is a number of JavaScript.
const SAFE: u64 = (1 << 53) - 1;

/// The interfaces.
pub(super) fn types(table: &[&Parameter]) -> String {
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
        let lines = words::wrapped(&words::paragraph(parameter, "`raster`"), "     * ");
        let (name, of) = (parameter.name, type_of(parameter));
        text += &format!("    /**\n{lines}     */\n    {name}?: {of};\n");
    }
    text + "}\n"
}

/// The type of a parameter's values. A region that is null is no region.
fn type_of(parameter: &Parameter) -> String {
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

/// The names and kinds.
pub(super) fn names(table: &[&Parameter]) -> String {
    let of = |groups| quoted(&within(table, groups));
    let (regions, window, output) = (of(REGIONS.groups), of(&[Group::Window]), of(OUTPUT.groups));
    let kinds: String = (within(table, groups::POINTS).into_iter())
        .map(|of| format!("    {}: \"{}\",\n", of.name, words::kind(of.shape)))
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
