//! The fullest blocks of some kinds, kept up to date while potentials change.
//!
//! A tree of pairs stands over the list of each kind: a node has the place of the greater one below it, of equal
//! ones the first. So it finds the same block as a look at the whole list would, in the time of a few
//! comparisons for each potential that has changed.

/// The place of no block.
const NONE: u32 = u32::MAX;

/// The potentials of blocks, by kind and by place in the list of their kind.
#[derive(Debug)]
pub(super) struct Fullest {
    kinds: Vec<Tree>,
    /// The place of each block in the list of its kind.
    places: Vec<u32>,
}

impl Fullest {
    /// The fullest of the members of kinds, by the potential of each block.
    pub(super) fn new(members: &[Vec<u32>], potential: &[f64]) -> Self {
        let mut places = vec![NONE; potential.len()];
        for list in members {
            for (place, &block) in (0..).zip(list) {
                places[block as usize] = place;
            }
        }
        let tree = |list: &Vec<u32>| Tree::new(list.iter().map(|&block| potential[block as usize]));
        Self {
            kinds: members.iter().map(tree).collect(),
            places,
        }
    }

    /// The highest potential of a kind and its place in the list, or `None` if the kind has no blocks.
    pub(super) fn of_kind(&self, kind: usize) -> Option<(f64, usize)> {
        self.kinds[kind].highest()
    }

    /// Changes the potential of a block of a kind.
    pub(super) fn set(&mut self, kind: usize, block: usize, potential: f64) {
        self.kinds[kind].set(self.places[block] as usize, potential);
    }

    /// Takes a block out of its list, whose last block moves to its place. Returns the block.
    pub(super) fn take(&mut self, members: &mut [Vec<u32>], kind: usize, place: usize) -> usize {
        let list = &mut members[kind];
        let last = list.len() - 1;
        let block = list.swap_remove(place) as usize;
        let tree = &mut self.kinds[kind];
        if let Some(&moved) = list.get(place) {
            self.places[moved as usize] = place as u32;
            tree.set(place, tree.values[last]);
        }
        tree.set(last, f64::NEG_INFINITY);
        block
    }
}

/// The places of the highest of some values, pair by pair.
#[derive(Debug)]
struct Tree {
    values: Vec<f64>,
    /// Node 1 is the root; the children of node i are 2i and 2i + 1, the leaves the places.
    nodes: Vec<u32>,
    /// The number of leaves, a power of two.
    leaves: usize,
}

impl Tree {
    fn new(values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.collect();
        let leaves = values.len().max(1).next_power_of_two();
        let mut tree = Self {
            nodes: vec![NONE; 2 * leaves],
            leaves,
            values,
        };
        for place in 0..tree.values.len() {
            tree.nodes[leaves + place] = place as u32;
        }
        for node in (1..leaves).rev() {
            tree.nodes[node] = tree.higher(node);
        }
        tree
    }

    /// The higher of the places below a node.
    fn higher(&self, node: usize) -> u32 {
        match [self.nodes[2 * node], self.nodes[2 * node + 1]] {
            [left, NONE] => left,
            [left, right] if self.values[right as usize] > self.values[left as usize] => right,
            [left, _] => left,
        }
    }

    fn highest(&self) -> Option<(f64, usize)> {
        let place = self.nodes[1] as usize;
        let value = *self.values.get(place)?;
        (value > f64::NEG_INFINITY).then_some((value, place))
    }

    fn set(&mut self, place: usize, value: f64) {
        self.values[place] = value;
        let mut node = (self.leaves + place) / 2;
        while node > 0 {
            self.nodes[node] = self.higher(node);
            node /= 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_finds_what_a_look_at_all_finds() {
        let mut members = [(0..37).collect::<Vec<u32>>(), (37..50).collect(), vec![]];
        // Many are equal.
        let mut potential: Vec<f64> = (0..50u32).map(|i| f64::from(i * 7919 % 5)).collect();
        let mut fullest = Fullest::new(&members, &potential);
        for step in 0..50usize {
            for (kind, list) in members.iter().enumerate() {
                let all = list.iter().enumerate();
                let all = all.map(|(at, &block)| (potential[block as usize], at));
                let first = all.reduce(|best, next| if next.0 > best.0 { next } else { best });
                assert_eq!(fullest.of_kind(kind), first);
            }
            let kind =
                usize::from(members[0].is_empty() || step % 4 == 3 && !members[1].is_empty());
            let Some((_, at)) = fullest.of_kind(kind) else {
                continue;
            };
            let taken = fullest.take(&mut members, kind, at);
            assert!(members.iter().all(|list| !list.contains(&(taken as u32))));
            for (kind, list) in members.iter().enumerate() {
                for &block in list.iter().filter(|block| **block as usize % 3 == step % 3) {
                    potential[block as usize] -= f64::from(block % 2);
                    fullest.set(kind, block as usize, potential[block as usize]);
                }
            }
        }
        assert!(members.iter().all(Vec::is_empty));
    }
}
