//! What clients have sent to name it later, under its digest: fields, and lists of points.
//!
//! It is held while there is room, of which each client has a fair part: where it runs out, the client that holds the
//! most lets go of the one that was not named for longest. So a client pushes out its own, and those of another only
//! while that one holds more. Any client may name any of them.

use std::{
    collections::HashMap,
    net::IpAddr,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

/// Who sends something: the address of a client. All those without one, such as trusted proxies, are one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sender(pub Option<IpAddr>);

/// Something that can be sent once and named later.
pub trait Sendable {
    /// The digest by which it is named.
    fn name(&self) -> &str;

    /// The memory that it takes, at most, in bytes.
    fn size(&self) -> usize;
}

/// Everything of a kind that was sent.
#[derive(Debug)]
pub struct Sent<T> {
    /// The most memory that it may take, in bytes.
    room: usize,
    shelf: Mutex<Shelf<T>>,
}

#[derive(Debug)]
struct Shelf<T> {
    held: HashMap<String, Held<T>>,
    /// Rises with every name.
    now: u64,
}

#[derive(Debug)]
struct Held<T> {
    sender: Sender,
    item: Arc<T>,
    /// When it was named last.
    named: u64,
}

impl<T> Default for Sent<T> {
    /// No room.
    fn default() -> Self {
        let (held, now) = (HashMap::new(), 0);
        Self {
            room: 0,
            shelf: Mutex::new(Shelf { held, now }),
        }
    }
}

impl<T: Sendable> Sent<T> {
    /// Room of this many bytes.
    #[must_use]
    pub fn new(room: usize) -> Self {
        Self {
            room,
            ..Self::default()
        }
    }

    /// Holds something, and lets go of others to make room. Returns it if it fits.
    ///
    /// What is there already stays with its first sender: others cannot make it theirs to lose.
    pub fn hold(&self, item: T, sender: Sender) -> Option<Arc<T>> {
        if item.size() > self.room {
            return None;
        }
        let name = item.name().to_owned();
        let mut shelf = self.shelf();
        shelf.now += 1;
        let known = shelf.held.get(&name);
        let held = Held {
            sender: known.map_or(sender, |known| known.sender),
            item: Arc::new(item),
            named: shelf.now,
        };
        shelf.held.insert(name.clone(), held);
        shelf.make_room(self.room);
        shelf.held.get(&name).map(|held| held.item.clone())
    }

    /// What has a digest, if it is still there.
    #[must_use]
    pub fn get(&self, digest: &str) -> Option<Arc<T>> {
        let mut shelf = self.shelf();
        shelf.now += 1;
        let now = shelf.now;
        let held = shelf.held.get_mut(digest)?;
        held.named = now;
        Some(held.item.clone())
    }

    fn shelf(&self) -> MutexGuard<'_, Shelf<T>> {
        self.shelf.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T: Sendable> Shelf<T> {
    /// Lets go of what is too much: each time of the sender that holds the most, the one not named for longest.
    fn make_room(&mut self, room: usize) {
        let mut taken: HashMap<Sender, usize> = HashMap::new();
        for held in self.held.values() {
            *taken.entry(held.sender).or_default() += held.item.size();
        }
        while taken.values().sum::<usize>() > room {
            let most = taken.values().max().copied();
            let of_most = |held: &&Held<T>| taken.get(&held.sender).copied() == most;
            let of_most = self.held.values().filter(of_most);
            let Some(first) = of_most.min_by_key(|held| held.named) else {
                return;
            };
            let (name, sender) = (first.item.name().to_owned(), first.sender);
            if let (Some(gone), Some(taken)) = (self.held.remove(&name), taken.get_mut(&sender)) {
                *taken -= gone.item.size();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Sender = Sender(None);
    const B: Sender = Sender(Some(IpAddr::V4(std::net::Ipv4Addr::LOCALHOST)));

    /// Takes one byte.
    struct Item(String);

    impl Sendable for Item {
        fn name(&self) -> &str {
            &self.0
        }

        fn size(&self) -> usize {
            1
        }
    }

    fn hold(sent: &Sent<Item>, name: &str, sender: Sender) -> bool {
        sent.hold(Item(name.into()), sender).is_some()
    }

    #[test]
    fn the_one_that_was_not_named_for_longest_goes_first() {
        let sent = Sent::new(2);
        assert!(hold(&sent, "1", A) && hold(&sent, "2", A));
        assert!(sent.get("1").is_some());
        assert!(hold(&sent, "3", A));
        assert!(sent.get("2").is_none());
        assert!(sent.get("1").is_some() && sent.get("3").is_some());
        // The same again takes no more room.
        assert!(hold(&sent, "3", A) && sent.get("1").is_some());
        assert!(!hold(&Sent::new(0), "1", A));
    }

    #[test]
    fn the_sender_that_holds_the_most_lets_go_first() {
        let sent = Sent::new(4);
        assert!(hold(&sent, "first", B));
        for i in 1..40 {
            assert!(hold(&sent, &i.to_string(), A));
            // Also where the other one sends the same, too.
            assert!(hold(&sent, "0", A) && hold(&sent, "0", B));
        }
        assert!(sent.get("first").is_some() && sent.get("39").is_some());
        // A newcomer takes what is above a fair part.
        assert!(hold(&sent, "second", B));
        assert!(sent.get("first").is_some() && sent.get("second").is_some());
        // With as much as others it loses its own.
        assert!(hold(&sent, "third", B) && sent.get("third").is_some());
        assert!(sent.get("first").is_none());
    }
}
