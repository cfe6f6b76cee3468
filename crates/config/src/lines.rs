//! The lines of keys in a file of settings, for messages.

use toml::de::{DeTable, DeValue};

/// `:LINE` of a dotted key in a text of TOML, or nothing where it cannot be found.
pub(super) fn suffix(text: &str, key: &str) -> String {
    let Ok(document) = DeTable::parse(text) else {
        return String::new();
    };
    let mut table = document.get_ref();
    let mut start = None;
    for name in key.split('.') {
        let found = table.iter().find(|(known, _)| known.get_ref() == name);
        let Some((known, value)) = found else { break };
        start = Some(known.span().start);
        let DeValue::Table(inner) = value.get_ref() else {
            break;
        };
        table = inner;
    }
    start.map_or_else(String::new, |start| {
        format!(":{}", 1 + text[..start].matches('\n').count())
    })
}
