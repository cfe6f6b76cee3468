//! Fields that clients have sent, under their digests: sent once, then named as often as needed.
//!
//! They are held for as long as there is room, of which each client has a fair part: where it runs out, the client
//! that holds the most lets go of the field that was not named for longest. So a client pushes out its own fields,
//! and those of another only while that one holds more. Any client may name any of them.

use std::{
    collections::VecDeque,
    net::IpAddr,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use super::NamedField;

/// What a field takes besides its pixels, at most, in bytes: its shapes and vertices.
const SHAPES: usize = 16 << 10;
/// What a vertex takes, with its place in a tree.
const VERTEX: usize = 64;

/// Who sends a field: the address of a client. All those without one, such as trusted proxies, are one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sender(pub Option<IpAddr>);

/// Fields that were sent.
#[derive(Debug, Default)]
pub struct Sent {
    /// The most memory that they may take, in bytes.
    room: usize,
    /// The last one is the one that was named last.
    held: Mutex<VecDeque<Held>>,
}

#[derive(Debug)]
struct Held {
    sender: Sender,
    field: Arc<NamedField>,
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
    ///
    /// A field that is there already stays with its first sender: others cannot make it theirs to lose.
    pub fn hold(&self, field: NamedField, sender: Sender) -> bool {
        if size(&field) > self.room {
            return false;
        }
        let mut held = self.held();
        let known = held.iter().position(|held| held.field.name == field.name);
        let known = known.and_then(|at| held.remove(at));
        held.push_back(Held {
            sender: known.map_or(sender, |known| known.sender),
            field: Arc::new(field),
        });
        while held.iter().map(Held::size).sum::<usize>() > self.room {
            let Some(at) = first_to_go(&held) else {
                break;
            };
            held.remove(at);
        }
        true
    }

    /// The field of a digest, if it is still there.
    #[must_use]
    pub fn get(&self, digest: &str) -> Option<Arc<NamedField>> {
        let mut held = self.held();
        let at = held.iter().position(|held| held.field.name == digest)?;
        let found = held.remove(at)?;
        let field = found.field.clone();
        held.push_back(found);
        Some(field)
    }

    fn held(&self) -> MutexGuard<'_, VecDeque<Held>> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Held {
    fn size(&self) -> usize {
        size(&self.field)
    }
}

/// The field that was not named for longest, of the sender that holds the most.
fn first_to_go(held: &VecDeque<Held>) -> Option<usize> {
    let taken = |sender: Sender| -> usize {
        let own = held.iter().filter(|held| held.sender == sender);
        own.map(Held::size).sum()
    };
    let most = held.iter().map(|held| taken(held.sender)).max()?;
    held.iter().position(|held| taken(held.sender) == most)
}

/// What a field takes, in bytes.
fn size(field: &NamedField) -> usize {
    SHAPES + field.bytes + VERTEX * field.spec.vertices()
}

#[cfg(test)]
mod tests {
    use strew_core::field::FieldSpec;

    use super::*;

    const A: Sender = Sender(None);
    const B: Sender = Sender(Some(IpAddr::V4(std::net::Ipv4Addr::LOCALHOST)));

    fn field(share: f64) -> NamedField {
        let spec = FieldSpec::constant(share).expect("a share");
        NamedField::of_spec(&share.to_string(), spec)
    }

    #[test]
    fn the_one_that_was_not_named_for_longest_goes_first() {
        let sent = Sent::new(2 * SHAPES);
        assert!(sent.hold(field(0.1), A) && sent.hold(field(0.2), A));
        assert!(sent.get("0.1").is_some());
        assert!(sent.hold(field(0.3), A));
        assert!(sent.get("0.2").is_none());
        assert!(sent.get("0.1").is_some() && sent.get("0.3").is_some());
        // The same again takes no more room.
        assert!(sent.hold(field(0.3), A) && sent.get("0.1").is_some());
        assert!(!Sent::new(SHAPES - 1).hold(field(0.1), A));
    }

    #[test]
    fn the_sender_that_holds_the_most_lets_go_first() {
        let sent = Sent::new(4 * SHAPES);
        assert!(sent.hold(field(0.5), B));
        for i in 1..40 {
            assert!(sent.hold(field(f64::from(i) / 100.0), A));
            // Also where the other one sends the same, too.
            assert!(sent.hold(field(0.0), A) && sent.hold(field(0.0), B));
        }
        assert!(sent.get("0.5").is_some() && sent.get("0.39").is_some());
        // A newcomer takes what is above a fair part.
        assert!(sent.hold(field(0.6), B) && sent.get("0.5").is_some() && sent.get("0.6").is_some());
        // With as much as others it loses its own.
        assert!(sent.hold(field(0.7), B) && sent.get("0.7").is_some());
        assert!(sent.get("0.5").is_none());
    }
}
