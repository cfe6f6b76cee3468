//! Rust source text cut into tokens.

/// Returns names, numbers, `::` and single punctuation marks, without comments, string and
/// character literals, and lifetimes.
pub fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        // Strings may begin with a prefix and hash signs.
        let word = &rest[..word_length(rest)];
        let after = rest[word.len()..].trim_start_matches('#');
        let hashes = rest.len() - word.len() - after.len();
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            block_comment(rest)
        } else if matches!(word, "" | "b" | "c") && hashes == 0 && after.starts_with('"') {
            word.len() + string(after)
        } else if matches!(word, "r" | "br" | "cr") && after.starts_with('"') {
            word.len() + hashes + raw_string(after, hashes)
        } else if matches!(word, "" | "b") && hashes == 0 && after.starts_with('\'') {
            word.len() + character_or_lifetime(after)
        } else if word == "r" && hashes > 0 {
            2 // a raw name, such as `r#type`
        } else if !word.is_empty() {
            tokens.push(word.to_owned());
            word.len()
        } else if rest.starts_with("::") {
            tokens.push("::".to_owned());
            2
        } else {
            if !first.is_whitespace() {
                tokens.push(first.to_string());
            }
            first.len_utf8()
        };
        rest = &rest[length..];
    }
    tokens
}

/// The length of the name or number that `text` begins with.
fn word_length(text: &str) -> usize {
    let end = text.find(|c: char| c != '_' && !c.is_alphanumeric());
    end.unwrap_or(text.len())
}

/// The length of a block comment, which may hold others.
fn block_comment(text: &str) -> usize {
    let (mut at, mut depth) = (2, 1);
    while depth > 0 && at < text.len() {
        let (step, length) = match &text.as_bytes()[at..] {
            [b'/', b'*', ..] => (1, 2),
            [b'*', b'/', ..] => (-1, 2),
            _ => (0, 1),
        };
        depth += step;
        at += length;
    }
    at
}

/// The length of a string literal.
fn string(text: &str) -> usize {
    let mut is_escaped = false;
    let end = text[1..].find(|c: char| {
        let is_end = c == '"' && !is_escaped;
        is_escaped = c == '\\' && !is_escaped;
        is_end
    });
    end.map_or(text.len(), |at| at + 2)
}

/// The length of a raw string literal from its first quote on.
fn raw_string(text: &str, hashes: usize) -> usize {
    let end = format!("\"{}", "#".repeat(hashes));
    let found = text[1..].find(&end);
    found.map_or(text.len(), |at| at + 1 + end.len())
}

/// The length of a character literal or a lifetime.
fn character_or_lifetime(text: &str) -> usize {
    let mut inner = text[1..].chars();
    match (inner.next(), inner.next()) {
        (Some('\\'), _) => text[3..].find('\'').map_or(text.len(), |at| at + 4),
        (Some(c), Some('\'')) => c.len_utf8() + 2,
        _ => 1 + word_length(&text[1..]),
    }
}
