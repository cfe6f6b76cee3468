//! The pages and their parts: every file of `files/`, embedded in the program. The [README](README.md) explains them.
//!
//! The modules and the styles of a page are joined, because each request takes a round trip; the parts are served as
//! well, for workers and other pages.

use strew::rest::{Page, Pages, Part};

/// A file: its name, and its bytes as they are, by zstd and by gzip.
type File = (&'static str, &'static [u8], &'static [u8], &'static [u8]);

/// The files, joined and compressed by the compiler. The parts of the first page are at the top, those of each other one
/// in a folder of its own.
static FILES: &[File] = strew_pages::parts!("page/files");

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
        "For people: Strew, Poisson disk and white noise side by side, with spectra, distances and what each has to make. \
         Loads nothing from elsewhere.",
        "compare/index.html",
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
        "For people: a volume of points to turn and to fly through, streamed by chunk. Loads nothing from elsewhere.",
        "space/index.html",
    ),
];

/// All pages, with their parts.
pub fn all() -> Pages {
    let text = |file| {
        let (_, text, ..) = FILES.iter().find(|(name, ..)| *name == file)?;
        str::from_utf8(text).ok()
    };
    let page = |&(path, id, summary, about, file): &Entry| Page {
        path,
        id,
        summary,
        about,
        // A test finds every file.
        html: text(file).unwrap_or_default(),
    };
    let parts = FILES.iter().filter(|(name, ..)| !name.ends_with(".html"));
    let part = |&(name, plain, zstd, gzip): &_| Part {
        name,
        plain,
        zstd,
        gzip,
    };
    Pages {
        pages: PAGES.iter().map(page).collect(),
        parts: parts.map(part).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The most bytes of the script of the first page, compressed for the browsers that accept least.
    const MOST: usize = 55_000;

    #[test]
    fn every_page_is_joined() {
        for page in all().pages {
            assert_eq!(
                page.html.matches("/page/joined/").count(),
                2,
                "{}",
                page.path
            );
        }
        let (_, plain, zstd, gzip) = FILES
            .iter()
            .find(|(name, ..)| *name == "joined/page.js")
            .expect("the script of the first page");
        assert!(zstd.len() < gzip.len() && gzip.len() < plain.len() / 2);
        assert!(gzip.len() <= MOST, "{} bytes", gzip.len());
    }

    #[test]
    fn nothing_is_inline_and_nothing_comes_from_elsewhere() {
        for (name, text, ..) in FILES {
            let Ok(text) = str::from_utf8(text) else {
                continue;
            };
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
        let names = FILES.iter().map(|(name, ..)| *name);
        let mut of_files: Vec<_> = names.filter(|name| name.ends_with(".html")).collect();
        of_files.sort_unstable();
        assert_eq!(of_entries, of_files);
    }
}
