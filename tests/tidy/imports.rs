//! The import graph of a crate's files, read from their text, and its circles.
//!
//! A file depends on each file that defines an item it names, whether it imports the item or writes
//! its path in the code. Paths are followed through `use` and `pub use` declarations to the
//! definition. A re-export is a dependency only if the code of the same file uses the name. So an
//! index, which is a `mod.rs` or `lib.rs` of modules and re-exports, depends on nothing.
//!
//! Test modules do not count. A glob import is a dependency on its module; names are not looked up
//! through it.

mod modules;
mod tokens;

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use modules::{Import, Module, Path, modules};

/// The files of a crate: the path in its source folder, such as `judge/mod.rs`, and the text.
pub type Files = BTreeMap<String, String>;

/// Files that all lead to each other (a strongly connected component), each with the shortest circle
/// back to it, such as `a.rs -> b.rs -> a.rs`.
pub type Component = BTreeMap<String, String>;

/// Returns all components of two and more files.
pub fn components(files: &Files) -> Vec<Component> {
    let all = Crate::new(files);
    let edges = all.edges();
    let leads_to: BTreeMap<&str, BTreeSet<&str>> = edges
        .keys()
        .map(|file| (*file, reached_from(&edges, file)))
        .collect();
    let mut found = BTreeMap::<&str, Component>::new();
    for (&file, reached) in &leads_to {
        if let Some(circle) = path_back(&edges, file) {
            let returns = |other: &&&str| leads_to[**other].contains(file);
            let first = reached.iter().find(returns).expect("itself");
            let component = found.entry(first).or_default();
            component.insert(file.to_owned(), circle.join(" -> "));
        }
    }
    found.into_values().collect()
}

/// The files that each file depends on.
type Edges<'a> = BTreeMap<&'a str, BTreeSet<&'a str>>;

/// All files that a file depends on, itself only if one of them depends on it.
fn reached_from<'a>(edges: &Edges<'a>, start: &'a str) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open = vec![start];
    while let Some(file) = open.pop() {
        open.extend(edges[file].iter().filter(|&&next| reached.insert(next)));
    }
    reached
}

/// The shortest path along the edges from a file back to itself.
fn path_back<'a>(edges: &Edges<'a>, start: &'a str) -> Option<Vec<&'a str>> {
    let mut paths = VecDeque::from([vec![start]]);
    let mut reached = BTreeSet::new();
    while let Some(path) = paths.pop_front() {
        for &next in &edges[path[path.len() - 1]] {
            let longer = [&path[..], &[next]].concat();
            if next == start {
                return Some(longer);
            }
            if reached.insert(next) {
                paths.push_back(longer);
            }
        }
    }
    None
}

/// The modules of a crate, each with its file.
struct Crate<'a> {
    modules: BTreeMap<Path, (&'a str, Module)>,
}

impl<'a> Crate<'a> {
    fn new(files: &'a Files) -> Self {
        let mut all = Self {
            modules: BTreeMap::new(),
        };
        let root = ["lib.rs", "main.rs"]
            .into_iter()
            .find_map(|name| files.get_key_value(name));
        let (file, text) = root.expect("a lib.rs or a main.rs");
        all.load(files, Path::new(), file, text);
        all
    }

    /// Reads a file and the files of the modules that it declares.
    fn load(&mut self, files: &'a Files, path: Path, file: &'a str, text: &str) {
        for (path, module) in modules(text, path) {
            for child in &module.children {
                let child: Path = path.iter().chain([child]).cloned().collect();
                let stem = child.join("/");
                let names = [format!("{stem}.rs"), format!("{stem}/mod.rs")];
                // A module written in braces has no file of its own.
                if let Some((file, text)) = names.iter().find_map(|n| files.get_key_value(n)) {
                    self.load(files, child, file, text);
                }
            }
            self.modules.insert(path, (file, module));
        }
    }

    fn edges(&self) -> Edges<'_> {
        let mut edges = Edges::new();
        for (place, (file, module)) in &self.modules {
            let used = |import: &&Import| !import.is_public || module.names.contains(&import.name);
            let imports = module
                .imports
                .iter()
                .filter(used)
                .map(|import| &import.path);
            let targets = edges.entry(file).or_default();
            for path in imports.chain(&module.globs).chain(&module.paths) {
                self.follow(place, path, &mut Vec::new(), targets);
            }
            targets.remove(file);
        }
        edges
    }

    /// Adds the files that define what `path` means in the module `place` to `found`: none for
    /// other crates, several if a module and an item have the same name. `open` holds the imports
    /// on the way, none of which is followed twice.
    fn follow<'b>(
        &'b self,
        place: &[String],
        path: &[String],
        open: &mut Vec<&'b Import>,
        found: &mut BTreeSet<&'b str>,
    ) {
        let (mut place, mut rest) = (place, path);
        let mut is_local = false;
        while let Some((head, tail)) = rest.split_first() {
            place = match head.as_str() {
                "crate" => &[],
                "self" => place,
                "super" => &place[..place.len().saturating_sub(1)],
                _ => break,
            };
            (rest, is_local) = (tail, true);
        }
        let Some((file, module)) = self.modules.get(place) else {
            return;
        };
        let Some((name, tail)) = rest.split_first() else {
            found.insert(*file);
            return;
        };
        let is_child = module.children.contains(name);
        if is_child {
            let child: Path = place.iter().chain([name]).cloned().collect();
            let inner: Path = ["self".to_owned()].iter().chain(tail).cloned().collect();
            self.follow(&child, &inner, open, found);
        }
        // Only a module can have a longer path, so an import of the same name does not count then.
        let is_module = is_child && !tail.is_empty();
        let is_open = |import: &Import| open.iter().any(|other| std::ptr::eq(*other, import));
        let imports: Vec<&Import> = (module.imports.iter())
            .filter(|import| import.name == *name && !is_module && !is_open(import))
            .collect();
        for import in &imports {
            let path: Path = import.path.iter().chain(tail).cloned().collect();
            open.push(import);
            self.follow(place, &path, open, found);
            open.pop();
        }
        if is_local && !is_child && imports.is_empty() {
            found.insert(*file);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn components_of(files: &[(&str, &str)]) -> Vec<Component> {
        let owned = |(name, text): &(&str, &str)| ((*name).to_owned(), (*text).to_owned());
        components(&files.iter().map(owned).collect())
    }

    /// A circle of each component.
    fn circles_of(files: &[(&str, &str)]) -> Vec<String> {
        let components = components_of(files).into_iter();
        components
            .filter_map(|component| component.into_values().next())
            .collect()
    }

    const ROOT: (&str, &str) = (
        "lib.rs",
        "mod a; mod b; pub use a::A; pub use b::{B, make as b};",
    );

    #[test]
    fn a_circle_is_found_in_any_notation() {
        for back in [
            "use crate::a::A;",
            "use crate::A;",
            "use super::{A as Other};",
            "use crate::{a::{self, A}, b as c};",
            "use super::a; fn f() { a::made() }",
            "fn f(a: &'static crate::a::A) { print('{', \"}\", r#\"\"}\"#) }",
            "mod inner { use super::super::A; }",
            "#[cfg(not(test))] use crate::a::A;",
        ] {
            let a = ("a.rs", "use crate::B; pub struct A(B);");
            let found = circles_of(&[ROOT, a, ("b.rs", back)]);
            assert_eq!(found, ["a.rs -> b.rs -> a.rs"], "{back}");
        }
    }

    #[test]
    fn comments_strings_tests_and_other_crates_do_not_count() {
        for back in [
            "// use crate::A;\n/* crate::A /* nested */ crate::A */",
            "fn f() { \"crate::A\"; r#\"crate::A\"#; b'\\''; a::other() }",
            "#[cfg(test)] mod tests { use super::super::A; }",
            "#[cfg(test)] use crate::A; fn f() {}",
            "use std::{a::A, fmt}; fn f(a: ::a::A<'a>) -> impl A + use<'a> {}",
        ] {
            let a = ("a.rs", "use crate::B; pub struct A(B);");
            assert_eq!(circles_of(&[ROOT, a, ("b.rs", back)]), [""; 0], "{back}");
        }
    }

    #[test]
    fn a_re_export_counts_only_if_the_code_beside_it_uses_the_name() {
        let part = ("a/part.rs", "use super::{Whole, other::Other};");
        let other = ("a/other.rs", "pub struct Other;");
        let index = "mod part; mod other; pub use part::Part; pub use other::*; mod whole; ";
        let whole = ("a/whole.rs", "pub struct Whole;");
        let lib = ("lib.rs", "mod a;");
        let files = |text| circles_of(&[lib, ("a/mod.rs", text), part, other, whole]);
        let clean = format!("{index} pub use whole::Whole;");
        assert_eq!(files(&clean), [""; 0]);
        let code = format!("{index} pub struct Whole;");
        assert_eq!(files(&code), [""; 0]);
        let circle = format!("{index} pub struct Whole(Part);");
        assert_eq!(files(&circle), ["a/mod.rs -> a/part.rs -> a/mod.rs"]);
    }

    #[test]
    fn circles_that_share_files_are_one_component() {
        let lib = ("lib.rs", "mod a; mod b; mod c; mod d; mod e; mod f;");
        let files = [
            lib,
            ("a.rs", "use crate::{b, c};"),
            ("b.rs", "use crate::c;"),
            ("c.rs", "use crate::a;"),
            ("d.rs", "use crate::{a, d};"),
            ("e.rs", "use crate::{a, f};"),
            ("f.rs", "use crate::e;"),
        ];
        let shown = components_of(&files).into_iter().map(|component| {
            let circles = component.into_values();
            circles.collect::<Vec<_>>()
        });
        let shown: Vec<_> = shown.collect();
        let first = [
            "a.rs -> c.rs -> a.rs",
            "b.rs -> c.rs -> a.rs -> b.rs",
            "c.rs -> a.rs -> c.rs",
        ];
        assert_eq!(shown[0], first);
        assert_eq!(shown[1], ["e.rs -> f.rs -> e.rs", "f.rs -> e.rs -> f.rs"]);
        assert_eq!(shown.len(), 2);
    }
}
