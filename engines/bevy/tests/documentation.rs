//! The page on engines shows the example of the crate, which its own tests run.

use std::{fs, path::Path};

#[test]
fn the_page_on_engines_has_the_example_of_the_crate() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    // A published package has no documents beside it.
    let Ok(page) = fs::read_to_string(root.join("../../docs/engines.md")) else {
        return;
    };
    let library = fs::read_to_string(root.join("src/lib.rs")).expect("readable");
    let shown = |text: &str, fence: &str| -> Option<String> {
        let code = text.split_once(fence)?.1.split_once("\n```")?.0;
        Some(code.to_owned())
    };
    let docs: Vec<&str> = library
        .lines()
        .filter_map(|line| line.strip_prefix("//!"))
        .map(|line| line.strip_prefix(' ').unwrap_or(line))
        .collect();
    let example = shown(&docs.join("\n"), "```\n").expect("an example");
    assert_eq!(shown(&page, "```rust\n"), Some(example));
}
