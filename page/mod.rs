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

/// Where a page is, the name of its operation, and its file.
const PAGES: [(&str, &str, &str); 6] = [
    ("/", "getPage", "index.html"),
    ("/docs", "getDocs", "docs/index.html"),
    ("/how", "getHow", "how/index.html"),
    ("/compare", "getComparePage", "compare/index.html"),
    ("/walk", "getWalk", "walk/index.html"),
    ("/space", "getSpacePage", "space/index.html"),
];

/// All pages, with their parts.
pub fn all() -> Pages {
    let text = |file| {
        let (_, text, ..) = FILES.iter().find(|(name, ..)| *name == file)?;
        str::from_utf8(text).ok()
    };
    // A test finds every file, with a title and a description.
    let between = |html: &'static str, [before, after]: [&str; 2]| {
        let (_, rest) = html.split_once(before)?;
        rest.split_once(after).map(|(words, _)| words)
    };
    let page = |&(path, id, file): &_| {
        let html = text(file).unwrap_or_default();
        Page {
            path,
            id,
            summary: between(html, ["<title>", " · Strew</title>"]).unwrap_or_default(),
            about: between(html, ["name=\"description\" content=\"", "\">"]).unwrap_or_default(),
            html,
        }
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
            let joined = page.html.matches("/page/joined/").count();
            assert!(
                joined == 2 && !page.summary.is_empty() && page.about.len() > 40,
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
