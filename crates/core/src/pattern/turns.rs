//! Sums of whole turns of the index over a range of coordinates.
//!
//! The number of indices between two thresholds is a difference of such sums. The thresholds of a map
//! are neighbor shifts −(αk + b)/2, and shifting a threshold by k is shifting the range by k. So four
//! sums in closed form, corrected at both ends of the range for each k, count all intervals at once.

use alloc::vec::Vec;
use core::ops::Range;

use super::{Alpha, floor_sum::floor_sum};

/// The sums Σ ⌊(α·v + b)/2 + origin⌋ modulo 2⁶⁴ over a range moved by k, for each k of a range of
/// shifts, by b and the parity of v.
#[derive(Clone, Debug)]
pub(crate) struct Turns {
    least: i64,
    sums: Vec<[[u64; 2]; 2]>,
}

impl Turns {
    /// Sums over `range`, moved by each of `shifts`, for the origin `zero` in units of 2⁻⁶⁴.
    pub(crate) fn new(alpha: Alpha, zero: u64, range: &Range<i64>, shifts: Range<i64>) -> Self {
        let half = alpha.half();
        // ⌊(α·v + b)/2 + origin⌋ as a whole number.
        let at = |v: i64, b: u8| {
            let value = i128::from(half) * i128::from(v) + i128::from(zero);
            value + (i128::from(b) << 63)
        };
        let turns = |v: i64, b: u8| (at(v, b) >> 64) as u64;
        let (mut start, mut end) = (range.start + shifts.start, range.end + shifts.start);
        let mut now = [[0u64; 2]; 2];
        for (b, now) in (0u8..).zip(&mut now) {
            for (parity, now) in now.iter_mut().enumerate() {
                let first = start + ((start ^ parity as i64) & 1);
                let n = (end - first).max(0) as u64;
                let n = n.div_ceil(2);
                let from = at(first, b);
                // A step of two coordinates is α: one turn and this.
                let step = half.wrapping_mul(2);
                let pairs = if n.is_multiple_of(2) {
                    (n / 2).wrapping_mul(n.wrapping_sub(1))
                } else {
                    n.wrapping_mul((n - 1) / 2)
                };
                let whole = n.wrapping_mul((from >> 64) as u64).wrapping_add(pairs);
                let rest = floor_sum(n, step, u128::from(from as u64)) as u64;
                *now = whole.wrapping_add(rest);
            }
        }
        let mut sums = Vec::with_capacity((shifts.end - shifts.start).max(0) as usize);
        for _ in shifts.clone() {
            sums.push(now);
            for (b, now) in (0u8..).zip(&mut now) {
                let (out, into) = ((start & 1) as usize, (end & 1) as usize);
                now[out] = now[out].wrapping_sub(turns(start, b));
                now[into] = now[into].wrapping_add(turns(end, b));
            }
            start += 1;
            end += 1;
        }
        Self {
            least: shifts.start,
            sums,
        }
    }

    /// The sum for one shift, over the coordinates whose parity was `parity` before it.
    pub(crate) fn sum(&self, shift: i64, b: u8, parity: u8) -> u64 {
        let sums = &self.sums[(shift - self.least) as usize];
        sums[usize::from(b & 1)][((i64::from(parity) + shift) & 1) as usize]
    }
}
