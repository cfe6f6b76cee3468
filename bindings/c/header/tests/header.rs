//! The committed header is that of the sources. `UPDATE_GOLDEN=1` rewrites it.

use std::{fs, path::Path};

/// The macros of the version in the manifest of the workspace.
fn version_macros(manifest: &str) -> String {
    let found = manifest.lines().find_map(|line| {
        let version = line.strip_prefix("version = \"")?;
        version.strip_suffix('"')
    });
    let version = found.expect("a version");
    let parts: Vec<u32> = version
        .split('.')
        .map(|part| part.parse().expect("a number"))
        .collect();
    let [major, minor, patch] = parts[..] else {
        panic!("{version} has three numbers");
    };
    format!(
        "\n/* The version of this header. strew_version() has that of the library that is loaded. */\n\
         #define STREW_VERSION_MAJOR {major}\n\
         #define STREW_VERSION_MINOR {minor}\n\
         #define STREW_VERSION_PATCH {patch}\n\
         #define STREW_VERSION_STRING \"{version}\""
    )
}

/// The header with comments that C89 has.
fn in_c89(header: &str) -> String {
    let is_comment = |line: &&str| line.trim_start().starts_with("//");
    let mut plain = String::new();
    let mut lines = header.lines().peekable();
    while let Some(line) = lines.next() {
        if !is_comment(&line) {
            // The comments of cbindgen after `#endif` and `}`.
            plain += line.split("//").next().unwrap_or_default().trim_end();
        } else {
            let (indent, text) = line.split_once("//").expect("a comment");
            plain += &format!("{indent}/*{text}");
            while let Some(more) = lines.next_if(is_comment) {
                plain.push('\n');
                plain += &more.replacen("//", " *", 1);
            }
            plain += " */";
        }
        plain.push('\n');
    }
    plain
}

#[test]
fn the_header_is_current() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = root.parent().expect("the folder of the library");
    let manifest = fs::read_to_string(root.join("../Cargo.toml")).expect("the manifest");
    let mut config =
        cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml");
    config.after_includes = Some(version_macros(&manifest));
    let sources = ["handles", "plan", "documents", "single", "failure"];
    let builder = sources
        .iter()
        .fold(cbindgen::Builder::new(), |builder, name| {
            builder.with_src(root.join(format!("src/{name}.rs")))
        });
    let mut header = vec![];
    let bindings = builder.with_config(config).generate().expect("parsed");
    bindings.write(&mut header);
    let header = String::from_utf8(header).expect("UTF-8");
    // C89 has no comma after the last name of an enum.
    let header = header
        .replace("STREW_CODE_", "STREW_")
        .replace(" # Safety", " Arguments:")
        .replace(",\n} strew_code", "\n} strew_code");
    let header = in_c89(&header);
    assert!(header.is_ascii(), "compilers read it in any character set");
    let file = root.join("include/strew.h");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&file, &header).expect("writable");
    }
    let committed = fs::read_to_string(&file).expect("the header");
    assert!(
        committed == header,
        "include/strew.h is old: UPDATE_GOLDEN=1 cargo test -p strew-c-header"
    );
}
