//! The pages and their parts: every file of `files/`, embedded in the program. The [README](README.md) explains them.
//!
//! The modules and the styles of a page are joined at the start, because each request takes a round trip; the parts are
//! served as well, for workers and other pages.

mod joined;

use bytes::Bytes;
use include_dir::{Dir, include_dir};
use strew::rest::{Page, Pages};

use joined::joined;

/// The files. The parts of the first page are at the top, those of each other one in a folder of its own.
static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/page/files");

/// Where a page is, the name of its operation, a summary and a description of it, and its file.
type Entry = (
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    &'static str,
);

const PAGES: &[Entry] = &[
    (
        "/",
        "getPage",
        "The page",
        "For people: a view of the plane, with controls for its points and the requests for them. Loads nothing from \
         elsewhere.",
        "index.html",
    ),
    (
        "/docs",
        "getDocs",
        "The API as a page",
        "For people: every operation with its parameters and answers, and a form to try it. Loads nothing from \
         elsewhere.",
        "docs/index.html",
    ),
    (
        "/how",
        "getHow",
        "An essay on how it works",
        "For people: from chance to any point of an endless plane, in nine figures that move and can be touched. Loads \
         nothing from elsewhere.",
        "how/index.html",
    ),
    (
        "/compare",
        "getComparePage",
        "The page that compares ways to scatter points",
        "For people: six ways to scatter points side by side, with spectra, distances and times. Loads nothing from \
         elsewhere.",
        "compare/index.html",
    ),
    (
        "/tile",
        "getTilePage",
        "The page of a tile",
        "For people: a texture of points or a mask for dithering that repeats without a seam, to look at and to save. \
         Loads nothing from elsewhere.",
        "tile/index.html",
    ),
    (
        "/walk",
        "getWalk",
        "A walk through the plane, in three dimensions",
        "For people: a forest whose trees are points of the plane, streamed by chunk. Loads nothing from elsewhere.",
        "walk/index.html",
    ),
    (
        "/space",
        "getSpacePage",
        "The page of points in space",
        "For people: a volume of points to turn and to fly through, streamed by chunk, with slabs of other methods \
         beside it. Loads nothing from elsewhere.",
        "space/index.html",
    ),
];

/// All pages, joined, with their parts.
pub fn all() -> Pages {
    let files = files(&FILES);
    let mut parts: Vec<_> = files
        .iter()
        .filter(|(name, _)| !name.ends_with(".html"))
        .map(|&(name, text)| (name.to_owned(), text.into()))
        .chain(pictures(&FILES))
        .collect();
    let mut pages = vec![];
    for &(path, id, summary, about, file) in PAGES {
        let text = text_of(&files, file);
        let mut html = text.to_owned();
        // A test joins every page; one that could not be joined would work as it is.
        if let Ok(joined) = joined(name_of(path), text, &files) {
            html = joined.html;
            for (ending, text) in [("js", joined.script), ("css", joined.style)] {
                let name = format!("joined/{}.{ending}", name_of(path));
                parts.push((name, text.into()));
            }
        }
        pages.push(Page {
            path,
            id,
            summary,
            about,
            html,
        });
    }
    Pages { pages, parts }
}

/// The names and texts of the files in a folder and in those below it.
fn files(folder: &'static Dir<'_>) -> Vec<(&'static str, &'static str)> {
    let own = folder.files();
    let named = own.filter_map(|file| Some((file.path().to_str()?, file.contents_utf8()?)));
    let below = folder.dirs().flat_map(files);
    named.chain(below).collect()
}

/// The pictures in a folder and in those below it, which no page is joined from.
fn pictures(folder: &'static Dir<'_>) -> Vec<(String, Bytes)> {
    let own = folder.files().filter(|file| file.contents_utf8().is_none());
    let named = own.filter_map(|file| {
        let name = file.path().to_str()?;
        Some((name.to_owned(), Bytes::from_static(file.contents())))
    });
    named.chain(folder.dirs().flat_map(pictures)).collect()
}

fn text_of(files: &[(&str, &'static str)], name: &str) -> &'static str {
    let found = files.iter().find(|(file, _)| *file == name);
    found.map_or("", |(_, text)| text)
}

/// The name of the joined parts of a page.
fn name_of(path: &str) -> &str {
    match path.trim_matches('/') {
        "" => "page",
        name => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_is_joined() {
        for &(path, .., file) in PAGES {
            let files = files(&FILES);
            let joined = joined(name_of(path), text_of(&files, file), &files).expect("known forms");
            assert_eq!(joined.html.matches("/page/joined/").count(), 2, "{path}");
            for form in ["\nimport {", "\nexport ", "import(\"."] {
                assert!(!joined.script.contains(form), "{path} has {form}");
            }
        }
    }

    #[test]
    fn nothing_is_inline_and_nothing_comes_from_elsewhere() {
        for (name, text) in files(&FILES) {
            // Links that people follow load nothing.
            let text = text.replace("<a href=\"https://", "<a href=\"");
            for word in ["style=\"", "innerHTML", "eval(", "onclick=\"", "https://"] {
                assert!(!text.contains(word), "{name} has {word}");
            }
            let is_page = name.ends_with(".html");
            let is_inline = text.contains("<style") || text.contains("<script>");
            assert!(!is_page || !is_inline, "{name} has a style or a script");
        }
    }

    #[test]
    fn every_page_has_a_file_and_every_file_of_a_page_is_one() {
        let of_entries = PAGES.iter().map(|(.., file)| *file);
        let mut of_entries: Vec<_> = of_entries.collect();
        of_entries.sort_unstable();
        let names = files(&FILES).into_iter().map(|(name, _)| name);
        let mut of_files: Vec<_> = names.filter(|name| name.ends_with(".html")).collect();
        of_files.sort_unstable();
        assert_eq!(of_entries, of_files);
    }
}
