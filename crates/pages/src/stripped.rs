//! Scripts and styles without comments, indentation and empty lines, which are a quarter of them; scripts also without
//! spaces beside brackets and the like.
//!
//! Line ends stay, because JavaScript ends statements at some; so do all names, and every character of strings,
//! templates and regular expressions. Nothing else is changed: this is no minifier, and what a browser reports of a
//! script can still be read.

use std::mem::take;

/// A script without comments and indentation.
///
/// # Errors
/// The line of a string, template, comment or regular expression without an end, and of a slash that is not clearly one or
/// the other: a division has a space after it, and a regular expression has none and stands where a value is due.
pub fn script(text: &str) -> Result<String, String> {
    let mut left = Left {
        is_tight: true,
        ..Left::default()
    };
    let mut rest = text;
    // The braces that are open in each template whose expression the text is in.
    let mut templates: Vec<usize> = vec![];
    while let Some(first) = rest.chars().next() {
        let failed = |what: &str| {
            let line = text[..text.len() - rest.len()].lines().count().max(1);
            format!("line {line}: {what}")
        };
        let length = match first {
            '/' if rest.starts_with("//") => {
                rest = &rest[rest.find('\n').unwrap_or(rest.len())..];
                continue;
            }
            '/' if rest.starts_with("/*") => {
                let end = rest.find("*/").ok_or_else(|| failed("a comment"))?;
                left.space(rest[..end].contains('\n'));
                rest = &rest[end + 2..];
                continue;
            }
            '/' => {
                let is_division = rest[1..].starts_with([' ', '=']);
                match (is_division, left.awaits_a_value()) {
                    (true, false) => 1,
                    (false, true) => expression(rest).ok_or_else(|| failed("a regex"))?,
                    _ => return Err(failed("a slash")),
                }
            }
            '"' | '\'' => string(rest).ok_or_else(|| failed("a string"))?,
            '`' => {
                let (length, is_open) = template(&rest[1..]).ok_or_else(|| failed("a template"))?;
                templates.extend(is_open.then_some(0));
                1 + length
            }
            '{' => {
                templates.iter_mut().rev().take(1).for_each(|n| *n += 1);
                1
            }
            '}' if templates.last() == Some(&0) => {
                let (length, is_open) = template(&rest[1..]).ok_or_else(|| failed("a template"))?;
                if !is_open {
                    templates.pop();
                }
                1 + length
            }
            '}' => {
                templates.iter_mut().rev().take(1).for_each(|n| *n -= 1);
                1
            }
            space if space.is_whitespace() => {
                left.space(space == '\n');
                rest = &rest[space.len_utf8()..];
                continue;
            }
            other => other.len_utf8(),
        };
        left.push(&rest[..length]);
        rest = &rest[length..];
    }
    if templates.is_empty() {
        Ok(left.text)
    } else {
        Err("a template without an end".into())
    }
}

/// A style without comments and indentation.
///
/// # Errors
/// The line of a string or comment without an end.
pub fn style(text: &str) -> Result<String, String> {
    let mut left = Left::default();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let line = || text[..text.len() - rest.len()].lines().count().max(1);
        if rest.starts_with("/*") {
            let end = rest.find("*/").ok_or_else(|| format!("line {}", line()))?;
            left.space(rest[..end].contains('\n'));
            rest = &rest[end + 2..];
        } else if first.is_whitespace() {
            left.space(first == '\n');
            rest = &rest[first.len_utf8()..];
        } else {
            let length = match first {
                '"' | '\'' => string(rest).ok_or_else(|| format!("line {}", line()))?,
                other => other.len_utf8(),
            };
            left.push(&rest[..length]);
            rest = &rest[length..];
        }
    }
    Ok(left.text)
}

/// The text that is left, and the white space before what comes next.
#[derive(Default)]
struct Left {
    text: String,
    space: Option<char>,
    /// Whether no space stands beside the characters of `TIGHT`.
    is_tight: bool,
}

/// Characters that are whole tokens, or form none with those beside them here.
const TIGHT: [char; 14] = [
    '{', '}', '(', ')', '[', ']', ';', ',', '=', '?', ':', '&', '|', '>',
];

impl Left {
    /// White space, or a comment, with a line end or without one.
    fn space(&mut self, has_line_end: bool) {
        let is_end = has_line_end || self.space == Some('\n');
        self.space = Some(if is_end { '\n' } else { ' ' });
    }

    fn push(&mut self, text: &str) {
        let space = take(&mut self.space).filter(|_| !self.text.is_empty());
        let needs_none = self.is_tight && (self.text.ends_with(TIGHT) || text.starts_with(TIGHT));
        self.text
            .extend(space.filter(|&space| space == '\n' || !needs_none));
        self.text += text;
    }

    /// Whether a value comes next, so that a slash begins a regular expression.
    fn awaits_a_value(&self) -> bool {
        const WORDS: [&str; 9] = [
            "return", "typeof", "case", "in", "of", "void", "delete", "else", "await",
        ];
        let is_of_words = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
        let Some(last) = self.text.chars().next_back() else {
            return true;
        };
        if is_of_words(last) {
            let before = self.text.trim_end_matches(is_of_words);
            return WORDS.contains(&&self.text[before.len()..]);
        }
        // After a brace it is not clear.
        !matches!(last, ')' | ']' | '}' | '"' | '\'' | '`')
    }
}

fn string(text: &str) -> Option<usize> {
    let quote = text.chars().next()?;
    ended(text, |c| c == quote)
}

/// The length of the regular expression that a text begins with, without its flags.
fn expression(text: &str) -> Option<usize> {
    let mut is_class = false;
    ended(text, |c| {
        match c {
            '[' => is_class = true,
            ']' => is_class = false,
            _ => {}
        }
        c == '/' && !is_class
    })
}

/// The length of a text up to the character after the first that ends it, on the same line; what a backslash precedes
/// ends nothing.
fn ended(text: &str, mut is_end: impl FnMut(char) -> bool) -> Option<usize> {
    let mut is_escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        if c == '\n' {
            return None;
        }
        if !is_escaped && is_end(c) {
            return Some(at + c.len_utf8());
        }
        is_escaped = c == '\\' && !is_escaped;
    }
    None
}

/// The length of the rest of a template up to its end, or up to the beginning of an expression in it: then `true`.
fn template(text: &str) -> Option<(usize, bool)> {
    let mut is_escaped = false;
    let mut last = ' ';
    for (at, c) in text.char_indices() {
        match c {
            '`' if !is_escaped => return Some((at + 1, false)),
            '{' if !is_escaped && last == '$' => return Some((at + 1, true)),
            _ => {}
        }
        // An escaped dollar begins nothing.
        last = if is_escaped { ' ' } else { c };
        is_escaped = c == '\\' && !is_escaped;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_indentation_go() {
        for (text, left) in [
            (
                "// A.\n\n  let a = 1; // one\n\n\n  b();\n",
                "let a=1;\nb();",
            ),
            (
                "/** A\n *  B. */\nexport const a = 1;\n",
                "export const a=1;",
            ),
            ("a /* x */ + b", "a + b"),
            ("return /* x\n */ 1", "return\n1"),
            ("a\t+  b", "a + b"),
            ("`${a // x\n}`", "`${a\n}`"),
            (
                "const { a } = b ? [c, d] : e && (f);",
                "const{a}=b?[c,d]:e&&(f);",
            ),
            ("a + +b - -c < d / (e)", "a + +b - -c < d /(e)"),
        ] {
            assert_eq!(script(text).as_deref(), Ok(left), "{text}");
        }
        assert_eq!(
            style("/* A.\n */\na {\n  color: red; /* x */\n}\n\nb { content: \"/*  */\"; }\n")
                .as_deref(),
            Ok("a {\ncolor: red;\n}\nb { content: \"/*  */\"; }")
        );
    }

    #[test]
    fn strings_templates_and_regular_expressions_stay() {
        for text in [
            "a=\"//  no\" + '/*  no' + \"\\\"  //\" + '\\\\'",
            "`  //  ${a + `  ${b({c:\"}\"})}  /*`}  \\`  \\${  //`",
            "`a\n   b  // c\n`",
            "`$${a}$`",
            "a.replace(/\\/\\/  [/\"'`]/g,\"\")",
            "return /\"  /.test(a)",
            "const a=/^\\d{1,3}  '$/;",
            "[/`  /,/'  /]",
            "`${a}` / 2",
            "x=>/\"  /",
            "const f=()=>({a:`${b}`});",
        ] {
            assert_eq!(script(text).as_deref(), Ok(text));
        }
        for (text, left) in [
            ("(a) / b", "(a)/ b"),
            ("a[1] / 2 / c", "a[1]/ 2 / c"),
            ("`${{ a: 1 }.a}  // b`;  // c", "`${{a:1}.a}  // b`;"),
        ] {
            assert_eq!(script(text).as_deref(), Ok(left));
        }
    }

    #[test]
    fn what_has_no_end_is_refused() {
        for text in [
            "\n'a",
            "\n\"a\n\"",
            "\n`a",
            "\n/* a",
            "\n= /a",
            "\n`${a",
            "(a) /b/",
            "a = / b/",
        ] {
            assert!(script(text).is_err(), "{text}");
        }
        assert!(style("a { b: \"c }").is_err() && style("/* a").is_err());
    }
}
