//! BLAKE3 in little code, where the crate `blake3` is too large: one round is a loop, and chunks are hashed one by one.

const START: u32 = 1;
const END: u32 = 2;
const PARENT: u32 = 4;
const ROOT: u32 = 8;
const CHUNK: usize = 1024;
const INITIAL: [u32; 8] = [
    0x6a09_e667,
    0xbb67_ae85,
    0x3c6e_f372,
    0xa54f_f53a,
    0x510e_527f,
    0x9b05_688c,
    0x1f83_d9ab,
    0x5be0_cd19,
];
const ORDER: [usize; 16] = [2, 6, 3, 10, 7, 0, 4, 13, 1, 11, 12, 5, 9, 14, 15, 8];
/// The words that each step of a round mixes.
const MIXED: [[usize; 4]; 8] = [
    [0, 4, 8, 12],
    [1, 5, 9, 13],
    [2, 6, 10, 14],
    [3, 7, 11, 15],
    [0, 5, 10, 15],
    [1, 6, 11, 12],
    [2, 7, 8, 13],
    [3, 4, 9, 14],
];

/// The digest of some bytes.
pub(super) fn hash(bytes: &[u8]) -> [u8; 32] {
    let root = node(bytes, 0);
    let words = Node {
        flags: root.flags | ROOT,
        ..root
    }
    .value();
    let mut digest = [0; 32];
    for (bytes, word) in digest.chunks_exact_mut(4).zip(words) {
        bytes.copy_from_slice(&word.to_le_bytes());
    }
    digest
}

/// The last block of a part of the input, and all that its value depends on.
struct Node {
    chain: [u32; 8],
    block: [u32; 16],
    counter: u64,
    length: u32,
    flags: u32,
}

/// The node of the chunks of `bytes`, of which the first has number `counter`.
fn node(bytes: &[u8], counter: u64) -> Node {
    if bytes.len() > CHUNK {
        let chunks = 1 << ((bytes.len() - 1) / CHUNK).ilog2();
        let (left, right) = bytes.split_at(CHUNK * chunks);
        let mut block = [0; 16];
        block[..8].copy_from_slice(&node(left, counter).value());
        block[8..].copy_from_slice(&node(right, counter + chunks as u64).value());
        return Node {
            chain: INITIAL,
            block,
            counter: 0,
            length: 64,
            flags: PARENT,
        };
    }
    let mut chain = INITIAL;
    let mut flags = START;
    let mut rest = bytes;
    loop {
        let (now, later) = rest.split_at(rest.len().min(64));
        let mut block = [0; 16];
        for (i, &byte) in now.iter().enumerate() {
            block[i / 4] |= u32::from(byte) << (i % 4 * 8);
        }
        let mut node = Node {
            chain,
            block,
            counter,
            length: now.len() as u32,
            flags,
        };
        if later.is_empty() {
            node.flags |= END;
            return node;
        }
        (chain, flags, rest) = (node.value(), 0, later);
    }
}

impl Node {
    fn value(&self) -> [u32; 8] {
        let mut block = self.block;
        let mut v = [0; 16];
        v[..8].copy_from_slice(&self.chain);
        v[8..12].copy_from_slice(&INITIAL[..4]);
        let counter = [self.counter as u32, (self.counter >> 32) as u32];
        v[12..].copy_from_slice(&[counter[0], counter[1], self.length, self.flags]);
        for _ in 0..7 {
            for (step, [a, b, c, d]) in MIXED.into_iter().enumerate() {
                for (word, turns) in [(2 * step, [16, 12]), (2 * step + 1, [8, 7])] {
                    v[a] = v[a].wrapping_add(v[b]).wrapping_add(block[word]);
                    v[d] = (v[d] ^ v[a]).rotate_right(turns[0]);
                    v[c] = v[c].wrapping_add(v[d]);
                    v[b] = (v[b] ^ v[c]).rotate_right(turns[1]);
                }
            }
            block = ORDER.map(|i| block[i]);
        }
        core::array::from_fn(|i| v[i] ^ v[i + 8])
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;

    #[test]
    fn digests_are_those_of_the_crate() {
        let bytes: Vec<u8> = (0..9000u32).map(|i| ((i * i) >> 3) as u8).collect();
        let near = [0, 64, 1024, 2048, 3072, 4096, 8192].map(|n: usize| n.saturating_sub(1)..n + 3);
        for length in near.into_iter().flatten().chain((0..9000).step_by(311)) {
            let bytes = &bytes[..length];
            assert_eq!(
                hash(bytes),
                *blake3::hash(bytes).as_bytes(),
                "{length} bytes"
            );
        }
    }
}
