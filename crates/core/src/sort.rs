//! A sort of little code, for lists that are made once for each table.

/// Sorts by keys, in place. Equal keys come in any order.
///
/// A heap sort: a tenth of the code of the standard library's for each type of items.
pub(crate) fn by_key<T, K: Ord>(items: &mut [T], key: impl Fn(&T) -> K) {
    let n = items.len();
    // The first half of the rounds makes the heap, the others take the greatest item of it.
    for round in (0..n + n / 2).rev() {
        let (mut at, heap) = match round.checked_sub(n) {
            Some(root) => (root, n),
            None => {
                items.swap(0, round);
                (0, round)
            }
        };
        loop {
            let mut child = 2 * at + 1;
            if child >= heap {
                break;
            }
            if child + 1 < heap && key(&items[child]) < key(&items[child + 1]) {
                child += 1;
            }
            if key(&items[at]) >= key(&items[child]) {
                break;
            }
            items.swap(at, child);
            at = child;
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn items_are_in_the_order_of_the_standard_library(
            items in prop::collection::vec((0u8..20, any::<u16>()), 0..80),
        ) {
            let (mut ours, mut theirs) = (items.clone(), items);
            by_key(&mut ours, |&item| item);
            theirs.sort_unstable();
            prop_assert_eq!(&ours, &theirs);
            by_key(&mut ours, |&(first, _)| core::cmp::Reverse(first));
            theirs.sort_by_key(|&(first, _)| core::cmp::Reverse(first));
            let firsts = |all: &[(u8, u16)]| all.iter().map(|item| item.0).collect::<Vec<_>>();
            prop_assert_eq!(firsts(&ours), firsts(&theirs));
        }
    }
}
