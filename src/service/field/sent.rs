//! Fields that clients have sent, under their digests: sent once, then named as often as needed.
//!
//! They are held for as long as there is room; the one that was not named for longest goes first.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use super::NamedField;

/// What a field takes besides its pixels, at most, in bytes: its shapes and vertices.
const SHAPES: usize = 16 << 10;
/// What a vertex takes, with its place in a tree.
const VERTEX: usize = 64;

/// Fields that were sent.
#[derive(Debug, Default)]
pub struct Sent {
    /// The most memory that they may take, in bytes.
    room: usize,
    /// The last one is the one that was named last.
    held: Mutex<VecDeque<Arc<NamedField>>>,
}

impl Sent {
    /// Room for fields of this many bytes.
    #[must_use]
    pub fn new(room: usize) -> Self {
        Self {
            room,
            held: Mutex::default(),
        }
    }

    /// Holds a field, and lets go of others to make room. Whether it fits.
    pub fn hold(&self, field: NamedField) -> bool {
        if size(&field) > self.room {
            return false;
        }
        let mut held = self.held();
        held.retain(|other| other.name != field.name);
        held.push_back(Arc::new(field));
        let mut taken: usize = held.iter().map(|field| size(field)).sum();
        while taken > self.room {
            let Some(oldest) = held.pop_front() else {
                break;
            };
            taken -= size(&oldest);
        }
        true
    }

    /// The field of a digest, if it is still there.
    #[must_use]
    pub fn get(&self, digest: &str) -> Option<Arc<NamedField>> {
        let mut held = self.held();
        let at = held.iter().position(|field| field.name == digest)?;
        let field = held.remove(at)?;
        held.push_back(field.clone());
        Some(field)
    }

    fn held(&self) -> MutexGuard<'_, VecDeque<Arc<NamedField>>> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What a field takes, in bytes.
fn size(field: &NamedField) -> usize {
    SHAPES + field.bytes + VERTEX * field.spec.vertices()
}

#[cfg(test)]
mod tests {
    use strew_core::field::FieldSpec;

    use super::*;

    #[test]
    fn the_one_that_was_not_named_for_longest_goes_first() {
        let field = |share: f64| {
            let spec = FieldSpec::constant(share).expect("a share");
            NamedField::of_spec(&share.to_string(), spec)
        };
        let sent = Sent::new(2 * SHAPES);
        assert!(sent.hold(field(0.1)) && sent.hold(field(0.2)));
        assert!(sent.get("0.1").is_some());
        assert!(sent.hold(field(0.3)));
        assert!(sent.get("0.2").is_none());
        assert!(sent.get("0.1").is_some() && sent.get("0.3").is_some());
        // The same again takes no more room.
        assert!(sent.hold(field(0.3)) && sent.get("0.1").is_some());
        assert!(!Sent::new(SHAPES - 1).hold(field(0.1)));
    }
}
