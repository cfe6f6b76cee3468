//! Joins and compresses the pages while the program that embeds them is compiled.
//!
//! It is a macro and not a build script, because an edit of a page then compiles the program's main file and links it,
//! and nothing else.

#![allow(missing_docs, reason = "internal: names say what items are")]

mod joined;

use std::{
    fs,
    io::{self, Write as _},
    path::{Path, PathBuf},
};

use proc_macro::{Literal, TokenStream};

use joined::{joined, whole};

/// `parts!("page/files")`: the files of a folder of the package and of those below it, as an array of
/// `(name, plain, zstd, gzip)`: a `&str` and three `&[u8]`, of which the last two are empty for pictures.
///
/// Each `index.html` has its fragments in it, which are other files of HTML and not in the array, and names the two files
/// into which its modules and styles are joined, which are in the array, too, as `joined/NAME.js` and `.css`; `NAME` is its
/// folder, or `page` for the first one. A page that cannot be joined is an error of the compiler.
#[proc_macro]
pub fn parts(folder: TokenStream) -> TokenStream {
    let folder = folder.to_string();
    let written = embedded(folder.trim_matches('"')).unwrap_or_else(|fault| {
        let fault = Literal::string(&fault);
        format!("compile_error!({fault})")
    });
    written.parse().expect("a Rust expression")
}

/// A file with its name below the folder, its path and its content.
struct File {
    name: String,
    path: PathBuf,
    content: Vec<u8>,
}

fn embedded(folder: &str) -> Result<String, String> {
    let root = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let folder = Path::new(&root).join(folder);
    let mut files = vec![];
    read(&folder, "", &mut files).map_err(|error| format!("{}: {error}", folder.display()))?;
    let texts: Vec<(&str, &str)> = files
        .iter()
        .filter_map(|file| Some((file.name.as_str(), std::str::from_utf8(&file.content).ok()?)))
        .collect();
    let mut items = String::new();
    for file in &files {
        let content = &file.content;
        let is_fragment = file.name.ends_with(".html") && !file.name.ends_with("index.html");
        if is_fragment {
            continue;
        }
        let Some(name) = file.name.strip_suffix("index.html") else {
            items += &item(&file.name, content)?;
            continue;
        };
        let name = match name.trim_end_matches('/') {
            "" => "page",
            folder => folder,
        };
        let path = if name == "page" {
            "/".into()
        } else {
            format!("/{name}")
        };
        let html = std::str::from_utf8(content).map_err(|error| error.to_string())?;
        let html = whole(&path, html, &texts)?;
        let page = joined(name, &html, &texts)?;
        items += &item(&file.name, page.html.as_bytes())?;
        items += &item(&format!("joined/{name}.js"), page.script.as_bytes())?;
        items += &item(&format!("joined/{name}.css"), page.style.as_bytes())?;
    }
    // The compiler watches what it includes.
    let watched: String = files
        .iter()
        .map(|file| format!("include_bytes!({:?}),", file.path.display().to_string()))
        .collect();
    Ok(format!(
        "{{ const _: &[&[u8]] = &[{watched}]; &[{items}] }}"
    ))
}

fn item(name: &str, plain: &[u8]) -> Result<String, String> {
    let is_picture = std::str::from_utf8(plain).is_err();
    let [zstd, gzip] = match is_picture {
        true => [vec![], vec![]],
        false => packed(plain).map_err(|error| format!("{name}: {error}"))?,
    };
    let [plain, zstd, gzip] = [plain, &zstd, &gzip].map(Literal::byte_string);
    Ok(format!("({name:?}, {plain}, {zstd}, {gzip}),"))
}

/// Reads the files of a folder and of those below it, in the order of their names.
fn read(folder: &Path, name: &str, files: &mut Vec<File>) -> io::Result<()> {
    let entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
    let mut paths: Vec<PathBuf> = entries.into_iter().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        let own = path.file_name().unwrap_or_default().to_string_lossy();
        let name = format!("{name}{own}");
        if path.is_dir() {
            read(&path, &format!("{name}/"), files)?;
        } else {
            let content = fs::read(&path)?;
            files.push(File {
                name,
                path,
                content,
            });
        }
    }
    Ok(())
}

/// A text in zstd and gzip, at the highest levels, which are too slow for a request or a start: about a second for a
/// megabyte.
fn packed(text: &[u8]) -> io::Result<[Vec<u8>; 2]> {
    /// The highest level that needs no more than 8 MiB in browsers (RFC 9659).
    const ZSTD: i32 = 19;
    let mut gzip = flate2::write::GzEncoder::new(vec![], flate2::Compression::best());
    gzip.write_all(text)?;
    Ok([zstd::bulk::compress(text, ZSTD)?, gzip.finish()?])
}
