//! Keys that a client sends where they do not belong, as a parameter of an address: they reach neither logs nor errors.

use std::borrow::Cow;

/// The beginning of every key, by which scanners find leaked ones.
pub const KEY_PREFIX: &str = "strew_";

const BLANK: &str = "***";

/// A text, such as an address, without the keys in it: values of parameters whose names say that they are secret, and
/// values and parts of paths that begin as keys do.
pub fn without_keys(text: &str) -> Cow<'_, str> {
    const BETWEEN: [char; 4] = ['/', '?', '&', ';'];
    let is_secret = |piece: &str| match piece.split_once('=') {
        Some((name, value)) => names_a_key(name) && !value.is_empty() || is_key(value),
        None => is_key(piece),
    };
    if !text.split(BETWEEN).any(is_secret) {
        return text.into();
    }
    let mut clean = String::with_capacity(text.len());
    for piece in text.split_inclusive(BETWEEN) {
        let (piece, end) = match piece.char_indices().next_back() {
            Some((at, last)) if BETWEEN.contains(&last) => piece.split_at(at),
            _ => (piece, ""),
        };
        if is_secret(piece) {
            clean += piece.split_once('=').map_or("", |(name, _)| name);
            clean += if piece.contains('=') { "=" } else { "" };
            clean += BLANK;
        } else {
            clean += piece;
        }
        clean += end;
    }
    clean.into()
}

pub(crate) fn names_a_key(name: &str) -> bool {
    const ENDS: [&str; 6] = [
        "key",
        "token",
        "authorization",
        "password",
        "secret",
        "bearer",
    ];
    let name = decoded(name);
    let ends = |end: &&str| {
        let start = name.len().checked_sub(end.len());
        let last = start.and_then(|start| name.get(start..));
        last.is_some_and(|last| last.eq_ignore_ascii_case(end))
    };
    ENDS.iter().any(ends)
}

fn is_key(value: &str) -> bool {
    let value = decoded(value);
    let value = value.trim_start_matches([' ', '"', '\'', '+']);
    let start = value.get(..KEY_PREFIX.len());
    start.is_some_and(|start| start.eq_ignore_ascii_case(KEY_PREFIX))
}

/// A text without percent-encoding, even of what is encoded already; other bytes than ASCII are of no interest.
fn decoded(text: &str) -> Cow<'_, str> {
    let mut text = Cow::Borrowed(text);
    while let Some(at) = (text.match_indices('%')).find_map(|(at, _)| byte_at(&text, at)) {
        let (at, byte) = at;
        let plain = [&text[..at], &char::from(byte).to_string(), &text[at + 3..]].concat();
        text = plain.into();
    }
    text
}

/// The byte that is encoded at a place.
fn byte_at(text: &str, at: usize) -> Option<(usize, u8)> {
    let digits = text.get(at + 1..at + 3)?;
    let is_hex = digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    let byte = is_hex.then(|| u8::from_str_radix(digits, 16).ok());
    Some((at, byte??))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_blank_wherever_they_stand_in_an_address() {
        for (text, expected) in [
            (
                "/v1/points?bbox=0,0,3,2&seed=7",
                "/v1/points?bbox=0,0,3,2&seed=7",
            ),
            (
                "/v1/points?x-api-key=abc&seed=7",
                "/v1/points?x-api-key=***&seed=7",
            ),
            (
                "/v1/points?seed=7&API_KEY=abc",
                "/v1/points?seed=7&API_KEY=***",
            ),
            ("/?key=abc", "/?key=***"),
            ("/?access_token=a=b&x", "/?access_token=***&x"),
            ("/?Authorization=Bearer%20abc", "/?Authorization=***"),
            ("/?x%2Dapi%2Dkey=abc", "/?x%2Dapi%2Dkey=***"),
            ("/?profile=strew_0123", "/?profile=***"),
            ("/?profile=%73trew_0123&a=b", "/?profile=***&a=b"),
            ("/?profile=%2573trew_0123", "/?profile=***"),
            ("/?profile=%20strew_0123", "/?profile=***"),
            ("/?strew_0123", "/?***"),
            ("/v1/points/strew_0123?a=b", "/v1/points/***?a=b"),
            ("strew_0123", "***"),
            ("/?key=&keyless=1", "/?key=&keyless=1"),
            (
                "/strew.v1.PointService/StreamPoints",
                "/strew.v1.PointService/StreamPoints",
            ),
            ("/?a=%zz%", "/?a=%zz%"),
            ("/?ключ=ё&key=ё", "/?ключ=ё&key=***"),
        ] {
            assert_eq!(without_keys(text), expected, "{text}");
        }
    }
}
