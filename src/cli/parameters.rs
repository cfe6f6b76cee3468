//! `strew parameters`: the table of parameters as types of the bindings (parameters.d.ts and parameters.js for JavaScript,
//! _parameters.py for Python) and as documentation.
//!
//! A parameter is written once. The npm package has the output printed when it is built; the repository keeps that for Python and
//! the documentation, where a test compares it: `UPDATE_GOLDEN=1 cargo test -p strew --lib cli::parameters` writes it.

mod python;
mod sections;

use strew_query::{Group, Parameter, SPACE_PARAMETERS, Shape, groups, parameters::PARAMETERS};

use super::{Failure, output};
use python::python;
use sections::{SECTIONS, Section, lists, paragraph, words, wrapped};

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

#[cfg(test)]
mod tests {
    use std::{fs, path::Path};

    use super::{
        sections::{of_query, within},
        *,
    };
    use crate::recipe::ADDED;
    use strew_query::parameters::FORMAT;

    const COMMITTED: [(Form, &str); 2] = [
        (Form::Py, "bindings/python/strew/_parameters.py"),
        (Form::Md, "docs/api.md"),
    ];

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
        for (form, file) in COMMITTED {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
            let content = fs::read_to_string(&path).unwrap_or_default();
            let renewed = renewed(form, &content);
            if std::env::var_os("UPDATE_GOLDEN").is_some() {
                fs::write(&path, &renewed).expect("writable");
            } else {
                assert!(
                    content == renewed,
                    "{file} differs from the table of parameters. To accept the change: \
                     UPDATE_GOLDEN=1 cargo test -p strew --lib cli::parameters"
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
