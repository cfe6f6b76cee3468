//! The names of keys, fields, worlds and lists, which are parts of files and addresses, and the titles of layers.

pub const ALLOWED: &str = "1 to 64 ASCII letters, digits, _, - and ., not dots alone";

pub fn is_name(text: &str) -> bool {
    let is_allowed = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
    let is_path = text.bytes().all(|byte| byte == b'.');
    (1..=64).contains(&text.len()) && text.chars().all(is_allowed) && !is_path
}

pub const TITLES: &str =
    "1 to 64 characters, none of them a control character but tabs and line breaks";

/// Whether a text may be the title of a layer: any text, as properties of features are. Marks that change the direction
/// of the text around are left out.
pub fn is_title(text: &str) -> bool {
    let is_hidden = |c| matches!(c, '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}');
    let is_shown = |c: char| matches!(c, '\t' | '\n' | '\r') || !c.is_control() && !is_hidden(c);
    (1..=64).contains(&text.chars().count()) && text.chars().all(is_shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_are_texts_in_any_script() {
        for title in [
            "Bad Tölz",
            "Île-de-France",
            "A,\"B\"\n/c",
            "東京 \"23\", a,b/c",
            "🌲",
            ".",
            "--x",
            &"ö".repeat(64),
        ] {
            assert!(is_title(title), "{title}");
        }
        for no_title in [
            "",
            "a\u{2028}b",
            "\u{1b}[31m",
            "a\u{202e}b",
            "a\u{85}b",
            "\0",
            &"ö".repeat(65),
        ] {
            assert!(!is_title(no_title), "{no_title:?}");
        }
    }
}
