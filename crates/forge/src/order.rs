//! Void and cluster (Ulichney 1993) over blocks instead of points: again and again the block of the highest potential
//! leaves.

/// The potentials of blocks, and how they change as blocks leave.
pub(crate) trait Surroundings {
    /// The share of all points that a block has.
    fn share(&self, block: usize) -> f64;

    /// The potential of each block that is left. It serves until of the share `left` of all points only `target` is left.
    fn potentials(&mut self, is_left: &[bool], left: f64, target: f64) -> Vec<f64>;

    /// Calls `lose` for the blocks whose potentials fall when a block leaves, with how far.
    fn leave(&self, block: usize, lose: impl FnMut(usize, f64));
}

/// The order in which a number of blocks leave, as the position of each: 0 for the one that leaves last. Potentials are
/// computed anew each time the share that is left has fallen by the factor `kept`; the last `fewest` blocks follow by number.
pub(crate) fn positions(
    around: &mut impl Surroundings,
    blocks: usize,
    kept: f64,
    fewest: usize,
) -> Vec<u32> {
    let mut is_left = vec![true; blocks];
    let mut positions = vec![0; blocks];
    let (mut left, mut number) = (1.0, blocks);
    while number > fewest {
        let target = left * kept;
        let mut potential = around.potentials(&is_left, left, target);
        loop {
            let fullest = (0..blocks)
                .filter(|&b| is_left[b])
                .max_by(|&a, &b| potential[a].total_cmp(&potential[b]).then(b.cmp(&a)));
            let Some(block) = fullest else { break };
            is_left[block] = false;
            left -= around.share(block);
            number -= 1;
            positions[block] = number as u32;
            around.leave(block, |to, by| potential[to] -= by);
            if left <= target || number <= fewest {
                break;
            }
        }
    }
    let rest = (0..blocks).rev().filter(|&b| is_left[b]);
    for (position, block) in (0..).zip(rest) {
        positions[block] = position;
    }
    positions
}
