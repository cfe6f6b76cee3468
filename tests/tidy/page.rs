//! The files of the pages: what they import is there, and what they have is used.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

/// The files below a folder, as paths relative to it, with their texts; pictures have none.
fn files(folder: &str) -> Vec<(String, String)> {
    let mut found = vec![];
    let mut open = vec![PathBuf::new()];
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    while let Some(inner) = open.pop() {
        for entry in fs::read_dir(folder.join(&inner)).expect("readable") {
            let name = inner.join(entry.expect("readable").file_name());
            if folder.join(&name).is_dir() {
                open.push(name);
            } else {
                let text = fs::read_to_string(folder.join(&name)).unwrap_or_default();
                found.push((name.to_string_lossy().replace('\\', "/"), text));
            }
        }
    }
    found
}

/// The words of a text, in which a hyphen is a letter.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && !"_$-".contains(c))
}

#[test]
fn every_import_leads_to_a_file() {
    let files = files("page/files");
    assert!(files.len() > 80, "the pages are where they are looked for");
    for (name, text) in &files {
        assert!(
            text.lines().count() <= 500,
            "{name} has more than 500 lines"
        );
        let beside = Path::new(name).parent().expect("a file");
        for (word, from) in [
            ("from \"./", beside),
            ("from \"../", beside.parent().unwrap_or(beside)),
            ("\"/page/", Path::new("")),
        ] {
            for piece in text.split(word).skip(1) {
                let part = piece.split('"').next().unwrap_or_default();
                let leads_to = from.join(part).to_string_lossy().replace('\\', "/");
                let is_there = files.iter().any(|(other, _)| *other == leads_to);
                assert!(is_there, "{name} names {part}");
            }
        }
    }
}

#[test]
fn every_export_is_imported() {
    let tests = files("tests/suite/page");
    let files = files("page/files");
    let others: Vec<_> = files
        .iter()
        .chain(&tests)
        .map(|(name, text)| (name.clone(), words(text).collect::<BTreeSet<_>>()))
        .collect();
    for (name, text) in &files {
        for line in text.lines() {
            let Some(declaration) = line.strip_prefix("export ") else {
                continue;
            };
            let mut kinds = declaration.split([' ', '(']);
            let exported =
                kinds.find(|word| !["async", "class", "const", "function"].contains(word));
            let exported = exported.unwrap_or_default();
            let is_used = others
                .iter()
                .any(|(other, words)| other != name && words.contains(exported));
            assert!(is_used, "{name} exports {exported}, which nothing imports");
        }
    }
}

#[test]
fn every_style_is_of_something() {
    let files = files("page/files");
    let is_style = |name: &str| name.ends_with(".css");
    let code = files.iter().filter(|(name, _)| !is_style(name));
    let code: String = code.map(|(_, text)| text.as_str()).collect();
    let known: BTreeSet<_> = words(&code).collect();
    // Names that code puts together, such as `swatch-${i}`.
    let begun: Vec<_> = known.iter().filter(|word| word.ends_with("-$")).collect();
    for (name, text) in files.iter().filter(|(name, _)| is_style(name)) {
        let text: String = text
            .split("/*")
            .map(|part| part.rsplit("*/").next().unwrap_or(part))
            .collect();
        for selectors in text
            .split('{')
            .filter_map(|part| part.rsplit(['}', ';']).next())
        {
            for piece in selectors.split(['.', '#']).skip(1) {
                let word = words(piece).next().unwrap_or_default();
                let is_begun = begun
                    .iter()
                    .any(|one| word.starts_with(one.trim_end_matches('$')));
                let is_number = word.starts_with(|c: char| c.is_ascii_digit());
                assert!(
                    is_number || is_begun || known.contains(word),
                    "{name} has a style of {word}, which nothing has"
                );
            }
        }
    }
}
