//! Markup that pages share: a line such as `<!-- pages.html -->` stands for the text of that file.

/// A page with its fragments. Links of a fragment to the page itself, which is at `path`, say that they are.
pub fn whole(path: &str, html: &str, parts: &[(&str, &str)]) -> Result<String, String> {
    let mut text = String::new();
    for line in html.lines() {
        let Some(name) = named(line) else {
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

fn named(line: &str) -> Option<&str> {
    let name = line.trim().strip_prefix("<!-- ")?.strip_suffix(" -->")?;
    name.ends_with(".html").then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

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
