//! The modules of a source file and the paths in them, read from its tokens.

use std::collections::BTreeSet;

use super::tokens::tokens;

/// The segments of a path. The path of a module is that from the root of its crate.
pub type Path = Vec<String>;

/// A name that a `use` declaration brings into a module.
pub struct Import {
    pub name: String,
    pub path: Path,
    /// Whether it is a re-export, `pub` or `pub(…)`.
    pub is_public: bool,
}

/// A module, without its test code.
#[derive(Default)]
pub struct Module {
    /// The names of the modules declared in it.
    pub children: BTreeSet<String>,
    pub imports: Vec<Import>,
    /// The paths of glob imports, without the `*`.
    pub globs: Vec<Path>,
    /// The paths of two and more segments in the code.
    pub paths: Vec<Path>,
    /// The names in the code, without those that follow a `::`.
    pub names: BTreeSet<String>,
}

/// Reads the module `place`, whose file has this text, and the modules inside it.
pub fn modules(text: &str, place: Path) -> Vec<(Path, Module)> {
    let tokens = tokens(text);
    let mut reader = Reader {
        tokens: &tokens,
        at: 0,
        modules: Vec::new(),
    };
    reader.module(place);
    reader.modules
}

struct Reader<'a> {
    tokens: &'a [String],
    /// The index of the next token.
    at: usize,
    modules: Vec<(Path, Module)>,
}

impl Reader<'_> {
    fn is_at_end(&self) -> bool {
        self.at >= self.tokens.len()
    }

    /// The next token; empty at the end.
    fn peek(&self) -> &str {
        self.tokens.get(self.at).map_or("", String::as_str)
    }

    /// Takes the next token; empty at the end.
    fn take(&mut self) -> String {
        let token = self.peek().to_owned();
        self.at += 1;
        token
    }

    /// Takes the next token if it is `token`.
    fn takes(&mut self, token: &str) -> bool {
        let is_next = self.peek() == token;
        self.at += usize::from(is_next);
        is_next
    }

    /// Reads a module up to the end of the file or to the brace that closes it.
    fn module(&mut self, place: Path) {
        let mut module = Module::default();
        let (mut depth, mut is_public) = (0, false);
        while !self.is_at_end() {
            let token = self.take();
            match token.as_str() {
                "{" => depth += 1,
                "}" if depth == 0 => break,
                "}" => depth -= 1,
                "#" => self.attribute(),
                "pub" => {
                    if self.peek() == "(" {
                        self.skip_group();
                    }
                    is_public = true;
                    continue;
                }
                // `impl Trait + use<'a>` is no import.
                "use" if self.peek() != "<" => self.imports(Path::new(), is_public, &mut module),
                "mod" => {
                    let name = self.take();
                    if self.takes("{") {
                        self.module(place.iter().chain([&name]).cloned().collect());
                    }
                    module.children.insert(name);
                }
                // Paths that begin with `::` lead to other crates.
                "::" => {
                    self.path(String::new());
                }
                _ if is_name(&token) => {
                    module.names.insert(token.clone());
                    module.paths.push(self.path(token));
                }
                _ => {}
            }
            is_public = false;
        }
        module.paths.retain(|path| path.len() > 1);
        self.modules.push((place, module));
    }

    /// Reads the rest of a path.
    fn path(&mut self, first: String) -> Path {
        let mut path = vec![first];
        while self.peek() == "::" && self.tokens.get(self.at + 1).is_some_and(|t| is_name(t)) {
            self.at += 1;
            path.push(self.take());
        }
        path
    }

    /// Reads a tree of imports below `path`.
    fn imports(&mut self, mut path: Path, is_public: bool, module: &mut Module) {
        loop {
            match self.take().as_str() {
                "::" => {}
                "*" => {
                    module.globs.push(path);
                    return;
                }
                "{" => {
                    while !self.is_at_end() && !self.takes("}") {
                        self.imports(path.clone(), is_public, module);
                        self.takes(",");
                    }
                    return;
                }
                name => {
                    if name != "self" || path.is_empty() {
                        path.push(name.to_owned());
                    }
                    if self.peek() != "::" {
                        break;
                    }
                }
            }
        }
        let name = match self.takes("as") {
            true => self.take(),
            false => path[path.len() - 1].clone(),
        };
        module.imports.push(Import {
            name,
            path,
            is_public,
        });
    }

    /// Skips an attribute after its `#`, and its item if it is `#[cfg(test)]` or the like.
    fn attribute(&mut self) {
        self.takes("!");
        let first = self.at;
        self.skip_group();
        let words = &self.tokens[first..self.at];
        let has = |word: &str| words.iter().any(|token| token == word);
        if has("cfg") && has("test") && !has("not") {
            self.skip_item();
        }
    }

    /// Skips an item: up to a semicolon, or a group in braces unless it is that of a `use`.
    fn skip_item(&mut self) {
        let mut is_use = false;
        while !self.is_at_end() {
            match self.peek() {
                "{" => {
                    self.skip_group();
                    if !is_use {
                        break;
                    }
                }
                "(" | "[" => self.skip_group(),
                "}" => break,
                _ => match self.take().as_str() {
                    ";" => break,
                    "use" => is_use = true,
                    _ => {}
                },
            }
        }
    }

    /// Skips a group in parentheses, brackets or braces, which comes next.
    fn skip_group(&mut self) {
        let mut depth = 0;
        while !self.is_at_end() {
            match self.take().as_str() {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
            if depth <= 0 {
                break;
            }
        }
    }
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c == '_' || c.is_alphabetic())
}
