//! The modules and styles of a page as one script and one style: a browser requests two files instead of forty.
//!
//! Each module becomes a function that returns what it exports, in the order in which modules need each other.
//! It knows the few forms of imports and exports that the pages use, and refuses others.

use std::fmt::Write as _;

#[derive(Debug)]
pub struct Joined {
    pub html: String,
    pub script: String,
    pub style: String,
}

const STYLE: &str = "<link rel=\"stylesheet\" href=\"/page/";
const SCRIPT: &str = "<script type=\"module\" src=\"/page/";

/// A page with its fragments, markup that pages share: a line such as `<!-- pages.html -->` stands for the text of that
/// file. Links of a fragment to the page itself, which is at `path`, say that they are.
pub fn whole(path: &str, html: &str, parts: &[(&str, &str)]) -> Result<String, String> {
    let mut text = String::new();
    for line in html.lines() {
        let Some(name) = fragment(line) else {
            text += line;
            text.push('\n');
            continue;
        };
        let found = parts.iter().find(|(part, _)| *part == name);
        let (_, fragment) = found.ok_or_else(|| format!("there is no fragment {name}"))?;
        let own = format!("<a href=\"{path}\"");
        let marked = format!("{own} aria-current=\"page\"");
        text += &fragment.replace(&own, &marked);
    }
    Ok(text)
}

fn fragment(line: &str) -> Option<&str> {
    let name = line.trim().strip_prefix("<!-- ")?.strip_suffix(" -->")?;
    name.ends_with(".html").then_some(name)
}

/// Joins the parts that a page names; the two files are to be served as `/page/joined/NAME.js` and `.css`.
///
/// # Errors
/// The piece of the page or its modules that has an unknown form or names no part.
pub fn joined(name: &str, html: &str, parts: &[(&str, &str)]) -> Result<Joined, String> {
    let mut style = String::new();
    let mut lines: Vec<String> = vec![];
    let mut script = None;
    for line in html.lines() {
        if let Some(part) = named(line, STYLE) {
            if style.is_empty() {
                lines.push(format!("{STYLE}joined/{name}.css\">"));
            }
            let text = text_of(parts, part)?;
            style += &bare(text).map_err(|fault| format!("{part}: {fault}"))?;
            style.push('\n');
        } else if let Some(part) = named(line, SCRIPT) {
            let mut modules = Modules {
                parts,
                done: vec![],
                open: vec![],
                text: String::new(),
            };
            modules.add(part)?;
            script = Some(modules.text);
            lines.push(format!("{SCRIPT}joined/{name}.js\"></script>"));
        } else {
            lines.push(line.to_owned());
        }
    }
    let script = script.ok_or_else(|| format!("{name} has no module"))?;
    let html = lines.join("\n") + "\n";
    Ok(Joined {
        html,
        script,
        style,
    })
}

fn named<'a>(line: &'a str, before: &str) -> Option<&'a str> {
    line.trim().strip_prefix(before)?.split('"').next()
}

fn text_of<'a>(parts: &[(&str, &'a str)], name: &str) -> Result<&'a str, String> {
    let found = parts.iter().find(|(part, _)| *part == name);
    found
        .map(|(_, text)| *text)
        .ok_or_else(|| format!("there is no part {name}"))
}

/// A script or a style without comments on lines of their own, indentation and empty lines, which are a quarter of it. A
/// text over several lines may lose some of these, too: in the pages those are shaders.
fn bare(text: &str) -> Result<String, String> {
    let (mut bare, mut is_comment) = (vec![], false);
    for line in text.lines().map(str::trim) {
        let has_end = line.contains("*/");
        // Code after a comment stays, with it.
        let begins = line.starts_with("/*") && (!has_end || line.ends_with("*/"));
        let is_of_comment = is_comment || begins;
        if is_comment && has_end && !line.ends_with("*/") {
            return Err(format!("code behind a comment: {line}"));
        }
        is_comment = is_of_comment && !has_end;
        if !is_of_comment && !line.is_empty() && !line.starts_with("//") {
            bare.push(line);
        }
    }
    match is_comment {
        true => Err("a comment without an end".into()),
        false => Ok(bare.join("\n")),
    }
}

/// The modules that are joined so far.
struct Modules<'a> {
    parts: &'a [(&'a str, &'a str)],
    done: Vec<String>,
    open: Vec<String>,
    text: String,
}

impl Modules<'_> {
    /// Adds a module after those that it imports. Returns the name of its exports.
    fn add(&mut self, name: &str) -> Result<String, String> {
        if let Some(index) = self.done.iter().position(|done| done == name) {
            return Ok(format!("$module{index}"));
        }
        if self.open.iter().any(|open| open == name) {
            return Err(format!("{name} imports itself, through {:?}", self.open));
        }
        self.open.push(name.to_owned());
        let (body, exports) = self.body(name)?;
        let body = bare(&body).map_err(|fault| format!("{name}: {fault}"))?;
        self.open.pop();
        let known = format!("$module{}", self.done.len());
        self.done.push(name.to_owned());
        let exports = exports.join(",");
        let _ = writeln!(
            self.text,
            "// {name}\nconst {known}=(()=>{{\n{body}\nreturn{{{exports}}};\n}})();"
        );
        Ok(known)
    }

    /// The text of a module as that of a function, and the names that it exports.
    fn body(&mut self, name: &str) -> Result<(String, Vec<String>), String> {
        let text = text_of(self.parts, name)?;
        let (mut body, mut exports) = (String::new(), vec![]);
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            let mut line = line.to_owned();
            if line.starts_with("import ") {
                while !line.ends_with(';') {
                    line += lines
                        .next()
                        .ok_or_else(|| format!("{name}: an import without end"))?;
                }
                body += &self.import(name, &line)?;
            } else if let Some(rest) = line.strip_prefix("export ") {
                exports.push(exported(rest).ok_or_else(|| format!("{name}: {line}"))?);
                body += rest;
            } else {
                body += &line;
            }
            body.push('\n');
        }
        Ok((body, exports))
    }

    fn import(&mut self, name: &str, line: &str) -> Result<String, String> {
        let unknown = || format!("{name}: {line}");
        let mut quoted = line.split('"');
        let (what, from) = (
            quoted.next().unwrap_or_default(),
            quoted.next().ok_or_else(unknown)?,
        );
        let module = self.add(&resolved(name, from).ok_or_else(unknown)?)?;
        let what = what.trim_start_matches("import").trim();
        let what = what.strip_suffix("from").unwrap_or(what).trim();
        if let Some(space) = what.strip_prefix("* as ") {
            return Ok(format!("const {space} = {module};"));
        }
        if what.is_empty() {
            return Ok(String::new());
        }
        let is_list = what.starts_with('{') && what.ends_with('}');
        let list = what.replace(" as ", ": ");
        if is_list {
            Ok(format!("const {list} = {module};"))
        } else {
            Err(unknown())
        }
    }
}

fn exported(declaration: &str) -> Option<String> {
    let kinds = [
        "function* ",
        "async function ",
        "function ",
        "class ",
        "const ",
    ];
    let rest = kinds
        .iter()
        .find_map(|kind| declaration.strip_prefix(kind))?;
    let name = rest
        .split(|c: char| !c.is_alphanumeric() && c != '_' && c != '$')
        .next()?;
    (!name.is_empty()).then(|| name.to_owned())
}

/// The name of the part that an import of a module leads to.
fn resolved(module: &str, from: &str) -> Option<String> {
    if let Some(name) = from.strip_prefix("/page/") {
        return Some(name.to_owned());
    }
    let mut folder: Vec<&str> = module.split('/').collect();
    folder.pop();
    for step in from.split('/') {
        match step {
            "." => {}
            ".." => drop(folder.pop()?),
            step => folder.push(step),
        }
    }
    from.starts_with('.').then(|| folder.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HTML: &str = "<link rel=\"stylesheet\" href=\"/page/a.css\">\n<link rel=\"stylesheet\" href=\"/page/b.css\">\n\
                        <script type=\"module\" src=\"/page/in/main.js\"></script>\n<p>\n";

    #[test]
    fn modules_come_after_those_that_they_import() {
        let parts = [
            ("a.css", "a {}\n"),
            ("b.css", "b {}\n"),
            (
                "in/main.js",
                "import { two as deux,\n  one } from \"../b.js\";\nimport * as c from \"../c.js\";\none(deux);\n",
            ),
            (
                "b.js",
                "import { one } from \"./c.js\";\nexport const two = 2;\nexport async function other() {}\n",
            ),
            ("c.js", "export function one() {}\n"),
        ];
        let joined = joined("x", HTML, &parts).expect("known forms");
        assert_eq!(joined.style, "a {}\nb {}\n");
        assert!(
            joined.html.contains("/page/joined/x.css") && joined.html.contains("/page/joined/x.js")
        );
        assert_eq!(joined.html.lines().count(), 3);
        let script = joined.script;
        let expected = "// c.js\nconst $module0=(()=>{\nfunction one() {}\nreturn{one};\n})();\n\
            // b.js\nconst $module1=(()=>{\nconst { one } = $module0;\nconst two = 2;\nasync function other() {}\n\
            return{two,other};\n})();\n\
            // in/main.js\nconst $module2=(()=>{\nconst { two: deux,  one } = $module1;\nconst c = $module0;\n\
            one(deux);\nreturn{};\n})();\n";
        assert_eq!(script, expected);
    }

    #[test]
    fn comments_on_lines_of_their_own_and_indentation_go() {
        let text =
            "// A.\n\n  let a = 1; // one\n/** B\n *  C. */\n/* D */\n  /** E */ b(\"// \");\n";
        assert_eq!(
            bare(text).as_deref(),
            Ok("let a = 1; // one\n/** E */ b(\"// \");")
        );
        assert!(bare("/* a").is_err() && bare("/* a\n */ b();").is_err());
    }

    #[test]
    fn forms_that_are_not_known_are_refused() {
        for text in [
            "import three from \"./b.js\";",
            "import { one } from \"./none.js\";",
            "export default 1;",
            "export let x = 1;",
            "import { one } from \"./in/main.js\";",
        ] {
            let parts = [
                ("a.css", ""),
                ("b.css", ""),
                ("in/main.js", text),
                ("b.js", ""),
            ];
            assert!(joined("x", HTML, &parts).is_err(), "{text}");
        }
    }

    #[test]
    fn a_line_becomes_the_fragment_and_its_link_to_the_page_is_marked() {
        let parts = [("nav.html", "<a href=\"/\">A</a>\n<a href=\"/b\">B</a>\n")];
        let page = "<p>\n  <!-- nav.html -->\n<!-- no fragment -->\n";
        assert_eq!(
            whole("/b", page, &parts).as_deref(),
            Ok(
                "<p>\n<a href=\"/\">A</a>\n<a href=\"/b\" aria-current=\"page\">B</a>\n<!-- no fragment -->\n"
            )
        );
        assert!(whole("/", "<!-- other.html -->", &parts).is_err());
    }
}
