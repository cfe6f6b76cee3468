//! Cases as tables of text: a line each, which is easier to read and to compare than tuples over several.

/// The rows of a table, as cells between bars. Lines that begin with `#` are comments.
pub fn rows(table: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    let lines = table.lines().map(str::trim);
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.map(|line| line.split(" | ").collect())
}
