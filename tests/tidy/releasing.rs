//! A release is complete: docs/releasing.md lists each part that `deploy/release` makes and each crate that is published.

use std::{fs, path::Path};

/// Fails if the page lacks a part, or a name that an owner claims. `folders` are those of `crates/`.
pub fn check(folders: &[String]) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |name: &str| fs::read_to_string(root.join(name)).expect(name);
    let (page, script) = (read("docs/releasing.md"), read("deploy/release"));
    let parts = script.split_once("\nPARTS=(").expect("a list of parts").1;
    for part in parts.split(')').next().expect("words").split(' ') {
        assert!(
            page.contains(&format!("| `{part}` |")),
            "docs/releasing.md has no row for the part {part}"
        );
        assert!(
            script.contains(&format!("\nmake_{part}() {{")),
            "deploy/release does not make {part}"
        );
        assert!(
            script.contains(&format!("[{part}]=")),
            "deploy/release does not know the cost of {part}"
        );
    }
    let manifests = folders.iter().map(|it| format!("crates/{it}/Cargo.toml"));
    let published: Vec<String> = manifests
        .map(|it| read(&it))
        .filter(|it| !it.contains("publish = false"))
        .map(|it| it.split('"').nth(1).expect("a name").to_owned())
        .collect();
    for name in &published {
        assert!(
            name.starts_with("strew-") && page.contains(&format!("`{name}`")),
            "docs/releasing.md does not list the crate {name}"
        );
    }
    // With `strew` itself; the plugin for Bevy is a workspace and a part of its own.
    let count = published.len() + 1;
    assert!(
        page.contains(&format!("| `crates` | {count} `.crate` files |")),
        "docs/releasing.md: {count} crates of the workspace are published"
    );
}
