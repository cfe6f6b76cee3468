//! Every public item has an example.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

/// Types and traits that are public only because the sealed trait `Format` names them. They are not
/// exported, and rustdoc does not show them.
const SEALED: [&str; 10] = [
    "Batch",
    "Double",
    "Emit",
    "Geometry",
    "Lanes",
    "PatchShears",
    "Picks",
    "Row",
    "Scope",
    "Single",
];

/// The sources of the library, as (path from `src`, text).
fn sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut open: Vec<PathBuf> = vec![root.clone()];
    let mut found = Vec::new();
    while let Some(path) = open.pop() {
        if path.is_dir() {
            let entries = fs::read_dir(&path).expect("readable");
            open.extend(entries.map(|entry| entry.expect("readable").path()));
        } else if path.extension().is_some_and(|e| e == "rs") {
            let name = path.strip_prefix(&root).expect("inside");
            let text = fs::read_to_string(&path).expect("UTF-8");
            found.push((name.to_string_lossy().replace('\\', "/"), text));
        }
    }
    found.sort();
    found
}

/// A public item and the lines of its docs and attributes.
struct Item<'a> {
    line: usize,
    /// The type or trait that the item belongs to, or its own name.
    owner: &'a str,
    name: &'a str,
    docs: Vec<&'a str>,
}

/// The public items of a source file, up to its tests.
fn items(text: &str) -> Vec<Item<'_>> {
    let lines: Vec<&str> = text
        .lines()
        .take_while(|line| *line != "#[cfg(test)]")
        .collect();
    let mut found = Vec::new();
    let (mut block, mut is_public_trait) = ("", false);
    for (i, line) in lines.iter().enumerate() {
        let is_indented = line.starts_with(' ');
        if !is_indented && (line.starts_with("impl") || line.starts_with("pub trait")) {
            block = owner(line);
            is_public_trait = line.starts_with("pub trait");
        }
        let Some((kind, name)) = declared(line.trim(), is_indented && is_public_trait) else {
            continue;
        };
        // Bounds and named values, which the examples of constructors show.
        if is_indented && kind == "const" {
            continue;
        }
        found.push(Item {
            line: i + 1,
            owner: if is_indented { block } else { name },
            name,
            docs: docs(&lines[..i]),
        });
    }
    found
}

/// The type of an `impl` or the name of a trait.
fn owner(line: &str) -> &str {
    let line = line.split(" for ").last().unwrap_or(line);
    let line = line.trim_start_matches("pub trait ");
    let line = match line.strip_prefix("impl<") {
        Some(generic) => generic.split_once("> ").map_or(generic, |(_, rest)| rest),
        None => line.trim_start_matches("impl "),
    };
    first_word(line)
}

fn first_word(text: &str) -> &str {
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_');
    &text[..end.unwrap_or(text.len())]
}

/// The kind and the name of the item that a line declares, if that is public. The functions of a public
/// trait are, without the word.
fn declared(line: &str, in_public_trait: bool) -> Option<(&str, &str)> {
    let line = match line.strip_prefix("pub ") {
        Some(line) => line,
        None if in_public_trait => line,
        None => return None,
    };
    let is_qualifiers = |text: &str| text.chars().all(|c| c.is_ascii_lowercase() || c == ' ');
    if let Some((before, name)) = line.split_once("fn ")
        && is_qualifiers(before)
    {
        return Some(("fn", first_word(name)));
    }
    let (kind, name) = line.split_once(' ')?;
    let kinds = [
        "struct", "enum", "union", "trait", "type", "const", "static",
    ];
    kinds.contains(&kind).then(|| (kind, first_word(name)))
}

/// The docs and attributes at the end of some lines, first line first.
fn docs<'a>(before: &[&'a str]) -> Vec<&'a str> {
    let mut docs: Vec<&str> = before
        .iter()
        .rev()
        .map(|line| line.trim())
        .take_while(|line| {
            // An attribute may take several lines.
            line.starts_with("///") || !line.is_empty() && !line.ends_with(['{', '}', ';'])
        })
        .collect();
    docs.reverse();
    docs
}

/// Whether docs have an example that is compiled. One that needs a feature has its fence in an attribute.
fn has_example(docs: &[&str]) -> bool {
    let mut is_inside = false;
    docs.iter().any(|line| {
        let fence = line.strip_prefix("/// ```");
        let opens = fence.filter(|_| !is_inside);
        is_inside ^= fence.is_some();
        opens.is_some_and(|kind| ["", "no_run", "should_panic"].contains(&kind))
            || line.contains("doc = \"```\"")
    })
}

#[test]
fn every_public_item_has_an_example() {
    let mut sealed = BTreeSet::from(SEALED);
    let mut missing = Vec::new();
    let mut count = 0;
    for (file, text) in &sources() {
        for item in items(text) {
            if SEALED.contains(&item.owner) {
                sealed.remove(item.owner);
                continue;
            }
            count += 1;
            if !has_example(&item.docs) {
                let (line, name) = (item.line, item.name);
                let owner = Some(item.owner).filter(|owner| *owner != name);
                let owner = owner.map_or(String::new(), |owner| format!("{owner}::"));
                missing.push(format!("src/{file}:{line}: {owner}{name}"));
            }
        }
    }
    assert!(count > 200, "only {count} items found");
    assert!(sealed.is_empty(), "not found, so not exempt: {sealed:?}");
    assert!(
        missing.is_empty(),
        "without an example:\n{}",
        missing.join("\n")
    );
}

/// The code of the cookbook, without the lines that rustdoc hides.
fn shown_code(text: &str) -> Vec<&str> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("//!"));
    let lines = lines.map(|line| line.strip_prefix(' ').unwrap_or(line));
    lines.filter(|line| !line.starts_with("# ")).collect()
}

#[test]
fn the_rust_of_the_documents_is_that_of_the_cookbook() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    // A published package has no documents beside it.
    let Ok(text) = fs::read_to_string(root.join("../../docs/kinds.md")) else {
        return;
    };
    let cookbook = fs::read_to_string(root.join("src/cookbook.rs")).expect("readable");
    let recipes = shown_code(&cookbook);
    let mut blocks = text.split("```rust\n").skip(1).peekable();
    assert!(blocks.peek().is_some());
    for block in blocks {
        let code: Vec<&str> = block.lines().take_while(|line| *line != "```").collect();
        assert!(
            recipes.windows(code.len()).any(|part| part == code),
            "not in the cookbook:\n{}",
            code.join("\n")
        );
    }
}
