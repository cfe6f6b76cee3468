//! Fields and lists of points that clients have sent, to be named later by their digest.
//!
//! An item is held while there is room, of which each client has a fair share: when room runs out, the client that
//! holds the most loses its item that was not named for longest. A client thus displaces its own items, and those of
//! another only while that one holds more. Any client may name any of them.

use std::{
    collections::HashMap,
    net::IpAddr,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

/// The sender of an item: the address of a client. All clients without an address, such as trusted proxies, count as
/// one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sender(pub Option<IpAddr>);

/// Something that can be sent once and named later.
pub trait Sendable {
    fn name(&self) -> &str;

    /// The memory that it takes, at most, in bytes.
    fn size(&self) -> usize;
}

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
    pub fn new(room: usize) -> Self {
        Self {
            room,
            ..Self::default()
        }
    }

    /// Holds an item, and drops others to make room. Returns it if it fits.
    ///
    /// An item that is there already stays with its first sender: other clients cannot displace it by sending it again.
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

    /// The item with a digest, if it is still there.
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
    /// Makes room: while there is too much, the sender that holds the most loses the item not named for longest.
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
        // An item that is sent again takes no more room.
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
        // A newcomer displaces items beyond a fair share.
        assert!(hold(&sent, "second", B));
        assert!(sent.get("first").is_some() && sent.get("second").is_some());
        // A client that already holds its fair part loses an item of its own.
        assert!(hold(&sent, "third", B) && sent.get("third").is_some());
        assert!(sent.get("first").is_none());
    }
}
