//! The names of keys, fields, worlds, lists and layers.

/// The rule for names, as messages state it.
pub const ALLOWED: &str = "1 to 64 ASCII letters, digits, _, - and ., not dots alone";

/// Whether a text may be a name.
#[must_use]
pub fn is_name(text: &str) -> bool {
    let is_allowed = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
    let is_path = text.bytes().all(|byte| byte == b'.');
    (1..=64).contains(&text.len()) && text.chars().all(is_allowed) && !is_path
}
