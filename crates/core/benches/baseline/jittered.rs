//! A hashed jittered grid: one point per cell, moved by a hash of the cell. Most programs that need
//! random access do this; its noise is poor.

/// Fills a square of `side` × `side` cells of unit area. Returns the number of points.
pub fn fill(side: u32, seed: u32, block: &mut [[f32; 2]]) -> u64 {
    let (mut written, mut total) = (0, 0);
    for y in 0..side {
        for x in 0..side {
            let hash = hash(x, y, seed);
            let [u, v] = [hash as u32, (hash >> 32) as u32].map(|h| (h >> 8) as f32 / 16_777_216.0);
            block[written] = [x as f32 + u, y as f32 + v];
            written += 1;
            if written == block.len() {
                std::hint::black_box(&mut *block);
                total += written as u64;
                written = 0;
            }
        }
    }
    total + written as u64
}

/// Two rounds of multiply and shift, the least that looks random.
fn hash(x: u32, y: u32, seed: u32) -> u64 {
    let mut h = (u64::from(y) << 32 | u64::from(x)) ^ (u64::from(seed) << 16);
    h = (h ^ (h >> 31)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    h = (h ^ (h >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h ^ (h >> 32)
}
