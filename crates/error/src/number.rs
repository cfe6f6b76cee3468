//! Numbers in words for clients.

pub fn number(value: f64) -> String {
    zmij::Buffer::new().format(value).into()
}
