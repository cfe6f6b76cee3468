//! The committed header is that of the sources. `UPDATE_GOLDEN=1` rewrites it.

use std::{fs, path::Path};

#[test]
fn the_header_is_current() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = root.parent().expect("the folder of the library");
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml");
    let sources = ["handles", "plan", "single", "space", "failure"];
    let builder = sources
        .iter()
        .fold(cbindgen::Builder::new(), |builder, name| {
            builder.with_src(root.join(format!("src/{name}.rs")))
        });
    let mut header = vec![];
    let bindings = builder.with_config(config).generate().expect("parsed");
    bindings.write(&mut header);
    let header = String::from_utf8(header).expect("UTF-8");
    let header = header
        .replace("STREW_CODE_", "STREW_")
        .replace("// # Safety", "// Arguments:");
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
