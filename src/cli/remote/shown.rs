//! Makes the texts of a server safe for a terminal.

/// Replaces characters that move the cursor, end the line or change the direction of writing by escapes.
pub(super) fn shown(text: &str) -> String {
    let is_odd = |c: char| {
        c.is_control()
            || matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
    };
    let mut clean = String::with_capacity(text.len());
    for c in text.chars() {
        match is_odd(c) {
            true => clean.extend(c.escape_unicode()),
            false => clean.push(c),
        }
    }
    clean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_a_terminal_obeys_is_left() {
        for (text, expected) in [
            ("9 points, α ≤ 2", "9 points, α ≤ 2"),
            ("\u{1b}[2J", "\\u{1b}[2J"),
            ("a\r\nb\u{9b}1m", "a\\u{d}\\u{a}b\\u{9b}1m"),
            (
                "\u{202e}x\u{2066}y\u{2028}",
                "\\u{202e}x\\u{2066}y\\u{2028}",
            ),
        ] {
            assert_eq!(shown(text), expected);
        }
    }
}
