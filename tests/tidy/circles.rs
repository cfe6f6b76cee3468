//! The circles of imports that are known, `circles.txt`, beside those that there are.

use std::{collections::BTreeSet, fs, path::Path};

use super::imports::{Component, components};

/// The files of each known component.
type Known = BTreeSet<BTreeSet<String>>;

/// The beginning of `circles.txt`.
const ABOUT: &str = "\
# Files that still import each other in circles: a paragraph for each strongly connected component.
# The test fails for a file that joins one and for one that has left. Untie circles instead of adding to them;
# UPDATE_GOLDEN=1 cargo test --test tidy circles   writes those that are left.
";

/// Fails unless the components of these source folders are those of `circles.txt`.
pub fn check(folders: &[&str], sources: &[(String, String)]) {
    let found: Vec<Component> = folders
        .iter()
        .flat_map(|folder| components_of(folder, sources))
        .collect();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tidy/circles.txt");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&file, text(&found)).expect("writable");
    }
    let known = known(&fs::read_to_string(&file).expect("UTF-8"));
    let differences = differences(&found, &known);
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

/// The components of a crate, with paths from the root of the repository.
fn components_of(folder: &str, sources: &[(String, String)]) -> Vec<Component> {
    let inside = |(name, text): &(String, String)| {
        let name = name.strip_prefix(folder)?.strip_prefix('/')?;
        Some((name.to_owned(), text.clone()))
    };
    let whole = |component: Component| {
        let files = component.into_iter();
        files
            .map(|(file, circle)| (format!("{folder}/{file}"), circle))
            .collect()
    };
    let components = components(&sources.iter().filter_map(inside).collect());
    components.into_iter().map(whole).collect()
}

fn text(found: &[Component]) -> String {
    let paragraph = |component: &Component| {
        let files = component.keys().flat_map(|file| [file, "\n"]);
        format!("\n{}", files.collect::<String>())
    };
    let paragraphs: String = found.iter().map(paragraph).collect();
    format!("{ABOUT}{paragraphs}")
}

fn known(text: &str) -> Known {
    let paragraphs = text.split("\n\n").skip(1);
    paragraphs
        .map(|files| files.lines().map(str::to_owned).collect())
        .collect()
}

/// A line for each file that has joined a component or left it.
fn differences(found: &[Component], known: &Known) -> Vec<String> {
    let files = |component: &Component| component.keys().cloned().collect();
    let present: Known = found.iter().map(files).collect();
    let mut lines = vec![];
    for component in found {
        let is_new = |file: &str| !known.iter().any(|old| old.contains(file));
        for (file, circle) in component.iter().filter(|(file, _)| is_new(file)) {
            lines.push(format!("{file} is in a new circle: {circle}"));
        }
        let is_part = |old: &&BTreeSet<String>| old.iter().any(|file| component.contains_key(file));
        let joins: Vec<_> = known.iter().filter(is_part).collect();
        if joins.len() > 1 {
            let firsts = joins.iter().filter_map(|old| old.first());
            let firsts: Vec<_> = firsts.map(String::as_str).collect();
            lines.push(format!(
                "circles have grown together: {}",
                firsts.join(", ")
            ));
        }
    }
    for old in known.difference(&present) {
        let is_in_one = |file: &&String| !found.iter().any(|now| now.contains_key(*file));
        for file in old.iter().filter(is_in_one) {
            lines.push(format!(
                "{file} is in no circle any more: remove it from circles.txt"
            ));
        }
    }
    if lines.is_empty() && present != *known {
        lines.push("components have parted: write circles.txt again".into());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn component(files: &[&str]) -> Component {
        let circle = |file: &&str| ((*file).to_owned(), format!("{file} -> {file}"));
        files.iter().map(circle).collect()
    }

    fn differences_of(found: &[&[&str]], listed: &str) -> Vec<String> {
        let found: Vec<Component> = found.iter().map(|files| component(files)).collect();
        differences(&found, &known(listed))
    }

    #[test]
    fn a_list_is_read_as_it_is_written() {
        let found = [component(&["a", "b"]), component(&["c", "d"])];
        assert_eq!(differences(&found, &known(&text(&found))), [""; 0]);
    }

    #[test]
    fn files_that_join_or_leave_a_component_are_named() {
        let listed = "#\n\na\nb\n\nc\nd\n";
        let joined = differences_of(&[&["a", "b", "x"], &["c", "d"]], listed);
        assert_eq!(joined, ["x is in a new circle: x -> x"]);
        let left = differences_of(&[&["a", "b"]], listed);
        assert_eq!(left.len(), 2, "{left:?}");
        assert!(left[0].starts_with("c is in no circle any more"));
        let grown = differences_of(&[&["a", "b", "c", "d"]], listed);
        assert_eq!(grown, ["circles have grown together: a, c"]);
        let parted = differences_of(&[&["a", "b"], &["c", "d"]], "#\n\na\nb\nc\nd\n");
        assert_eq!(parted, ["components have parted: write circles.txt again"]);
    }
}
