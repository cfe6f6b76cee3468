//! Numbers in words for clients.

/// The shortest digits of any number.
pub fn number(value: f64) -> String {
    zmij::Buffer::new().format(value).into()
}
