//! `strew parameters`: the table of parameters as types of the bindings and as documentation.
//!
//! The repository keeps the output in files, so a parameter is written once. A test compares them;
//! `UPDATE_GOLDEN=1 cargo test -p strew --lib cli::parameters` writes them.

mod types;
mod words;

use strew_query::{Group, Parameter, parameters::PARAMETERS};

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

/// Prints the table.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    output::write(None, args.form.text(PARAMETERS).as_bytes())
}

impl Form {
    /// The text of a table.
    fn text(self, table: &[&Parameter]) -> String {
        match self {
            Self::Dts => types::typescript(table),
            Self::Js => types::javascript(table),
            Self::Py => types::python(table),
            Self::Md => markdown(table),
        }
    }
}

/// A table in Markdown.
fn markdown(table: &[&Parameter]) -> String {
    let rows: String = table.iter().map(|parameter| row(parameter)).collect();
    format!("| parameter | meaning | values | default |\n|---|---|---|---|\n{rows}")
}

fn row(parameter: &Parameter) -> String {
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
    let cells =
        [parameter.about, &parameter.allowed(), default].map(|cell| cell.replace('|', "\\|"));
    let [about, allowed, default] = cells;
    format!(
        "| `{}` | {place}{about} | {allowed} | {default} |\n",
        parameter.name
    )
}

#[cfg(test)]
mod tests {
    use std::{fs, path::Path};

    use clap::ValueEnum as _;

    use strew_query::{groups, parameters::FORMAT};

    use super::{
        words::{MEMBERS, OUTPUT, REGIONS, within},
        *,
    };
    use crate::recipe::ADDED;

    /// The file that keeps a form.
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
            (Form::Py, "    \"added\": \"integer\",\n"),
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
    fn every_parameter_is_documented_and_every_member_typed() {
        let documented = Form::Md.text(PARAMETERS);
        for parameter in PARAMETERS {
            let row = format!("\n| `{}` | ", parameter.name);
            assert!(documented.contains(&row), "{}", parameter.name);
        }
        let sections = [REGIONS, MEMBERS, OUTPUT].map(|section| section.of(PARAMETERS));
        let typed = sections.concat();
        for parameter in within(PARAMETERS, groups::POINTS) {
            let is_typed = typed.contains(&parameter) || *parameter == FORMAT;
            assert!(is_typed, "{}", parameter.name);
        }
    }
}
