//! Plain patterns of any α, which need no table: one of zero vectors is derived when a query names it.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

use strew_core::{Alpha, Table, map::Size};

use super::Entry;

/// The profile that exists for every α.
pub const PATTERN: &str = "pattern";
/// The largest half-width R that a pattern is derived with. The map changes no point of a pattern, only which of them
/// leave first and which kinds they have.
pub const MAX_PATTERN_RADIUS: u32 = 256;
/// The most patterns that are known at once, about 500 bytes each.
const MOST: usize = 1024;

/// The patterns that were derived last.
#[derive(Debug, Default)]
pub(super) struct Patterns(Mutex<Known>);

#[derive(Debug, Default)]
struct Known {
    entries: HashMap<(Alpha, Size), (Arc<Entry>, u64)>,
    now: u64,
}

impl Patterns {
    /// The pattern of an α on a map of this size, or `None` for a larger map than patterns have.
    pub(super) fn get(&self, alpha: Alpha, size: Size) -> Option<Arc<Entry>> {
        if let Some(known) = self.known(alpha, size) {
            return Some(known);
        }
        if size.radius() > MAX_PATTERN_RADIUS {
            return None;
        }
        let table = Table::undisplaced(alpha, size.radius(), PATTERN).ok()?;
        let entry = Arc::new(Entry::pattern(&table));
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if known.entries.len() >= MOST {
            let oldest = known.entries.iter().min_by_key(|(_, (_, used))| *used);
            if let Some(oldest) = oldest.map(|(key, _)| *key) {
                known.entries.remove(&oldest);
            }
        }
        let now = known.now;
        known.entries.insert((alpha, size), (entry.clone(), now));
        Some(entry)
    }

    fn known(&self, alpha: Alpha, size: Size) -> Option<Arc<Entry>> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.now += 1;
        let now = known.now;
        let (entry, used) = known.entries.get_mut(&(alpha, size))?;
        *used = now;
        Some(entry.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_are_derived_once_and_the_least_used_leave() {
        let patterns = Patterns::default();
        let alpha = |i: usize| Alpha::from_fraction(3 * 2000 + i as u64, 4000).expect("valid");
        let first = patterns.get(alpha(0), Size::of_radius(3)).expect("small");
        for i in 0..3 * MOST {
            let entry = patterns.get(alpha(i % 1900), Size::of_radius(1 + (i / 1900) as u32));
            assert!(entry.is_some());
            let again = patterns.get(alpha(0), Size::of_radius(3)).expect("small");
            assert!(Arc::ptr_eq(&again, &first));
        }
        let known = patterns.0.lock().expect("no panic").entries.len();
        assert_eq!(known, MOST);
        assert!(
            patterns
                .get(alpha(0), Size::of_radius(MAX_PATTERN_RADIUS + 1))
                .is_none()
        );
        let table = first.table().expect("derived again");
        assert_eq!(table.digest().to_string(), first.digest);
    }
}
