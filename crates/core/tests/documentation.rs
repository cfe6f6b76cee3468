//! Every public type has an example, and the documents have those of the cookbook.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// Types and traits that are public only because a sealed trait names them. They are not
/// exported, and rustdoc does not show them.
const SEALED: &str = "Batch Copies Double Emit Geometry Hashed Held Lanes Made Outlined Parts PatchShears Picks Row Scope Single \
                      Vector WarpedColumns";

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

/// The name of the type or trait that a line declares, if that is public.
fn declared(line: &str) -> Option<&str> {
    let line = line.strip_prefix("pub ")?;
    let name = ["struct ", "enum ", "union ", "trait "];
    let name = name.iter().find_map(|kind| line.strip_prefix(kind))?;
    let end = name.find(|c: char| !c.is_alphanumeric() && c != '_');
    Some(&name[..end.unwrap_or(name.len())])
}

/// Whether the docs at the end of some lines have an example that is compiled. One that needs a feature has its fence in
/// an attribute.
fn have_example(before: &[&str]) -> bool {
    let docs = before.iter().rev().take_while(|line| {
        // An attribute may take several lines.
        line.starts_with("///") || !line.is_empty() && !line.ends_with(['{', '}', ';'])
    });
    let mut fences =
        docs.filter(|line| line.starts_with("/// ```") || line.contains("doc = \"```\""));
    // From the end: the first fence closes an example, the second opens it.
    let opened = fences.nth(1).unwrap_or(&"");
    let kinds = ["/// ```", "/// ```no_run", "/// ```should_panic"];
    kinds.contains(opened) || opened.contains("doc = ")
}

#[test]
fn every_public_type_has_an_example() {
    let (mut missing, mut count) = (vec![], 0);
    for (file, text) in &sources() {
        let tests = text.find("#[cfg(test)]\nmod ").unwrap_or(text.len());
        let lines: Vec<&str> = text[..tests].lines().collect();
        let declared = lines.iter().map(|line| declared(line)).enumerate();
        for (i, name) in declared.filter_map(|(i, name)| Some((i, name?))) {
            if SEALED.split(' ').any(|sealed| sealed == name) {
                continue;
            }
            count += 1;
            if !have_example(&lines[..i]) {
                missing.push(format!("src/{file}:{}: {name}", i + 1));
            }
        }
    }
    assert!(count > 60, "only {count} types found");
    assert!(missing.is_empty(), "without an example: {missing:#?}");
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
        let is_shown = recipes.windows(code.len()).any(|part| part == code);
        assert!(is_shown, "not in the cookbook: {code:#?}");
    }
}
