//! Parameters as a table in Markdown.

use strew_query::{Group, Parameter};

/// The table.
pub(super) fn table(table: &[&Parameter]) -> String {
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
