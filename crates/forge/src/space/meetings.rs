//! Meetings: which blocks of a map lie across which offsets of the lattice, and how often.
//!
//! The index of a point is uniform over the set region, so along an axis the share of points of interval a that have
//! interval b across an offset is the length of the part of a that the shift of the offset carries into b. Frequencies of
//! pairs of blocks are products of three such lengths: exact for the unbounded set, without a twin.

use strew_core::Map;

/// Two intervals that meet across an offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    pub(super) from: u16,
    pub(super) to: u16,
    /// The part of the set region from which they meet.
    pub(super) share: f32,
}

/// The meetings of a map's intervals along an axis, by offset and parity.
#[derive(Clone, Debug)]
pub(super) struct Meetings {
    /// The greatest offset.
    far: i64,
    by_offset: Vec<[Vec<Meeting>; 2]>,
}

impl Meetings {
    /// The meetings across offsets up to `far`.
    pub(super) fn new(map: &Map, far: i64) -> Self {
        let of = |offset: i64, parity: u64| {
            let shift = map.alpha().half().wrapping_mul(offset as u64);
            meet(map, shift.wrapping_add(parity << 63))
        };
        Self {
            far,
            by_offset: (-far..=far)
                .map(|offset| [of(offset, 0), of(offset, 1)])
                .collect(),
        }
    }

    /// The meetings across an offset along an axis, given the sum of those along the others.
    pub(super) fn across(&self, offset: i64, others: i64) -> &[Meeting] {
        &self.by_offset[(offset + self.far) as usize][(others & 1) as usize]
    }

    /// The greatest offset.
    pub(super) const fn far(&self) -> i64 {
        self.far
    }
}

fn meet(map: &Map, shift: u64) -> Vec<Meeting> {
    let side = u128::from(map.alpha().set_side());
    let circle = 1u128 << 64;
    let mut found = Vec::new();
    for from in 0..map.intervals() {
        let own = map.interval(from);
        let start = u128::from(own.start.wrapping_add(shift));
        let end = start + u128::from(own.end - own.start);
        for to in 0..map.intervals() {
            let other = map.interval(to);
            let part = |turn: u128| {
                let (low, high) = (u128::from(other.start) + turn, u128::from(other.end) + turn);
                high.min(end).saturating_sub(low.max(start))
            };
            let shared = part(0) + part(circle);
            if shared > 0 {
                found.push(Meeting {
                    from: from as u16,
                    to: to as u16,
                    share: (shared as f64 / side as f64) as f32,
                });
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_meets_itself_and_shares_add_up() {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 9).expect("small");
        let meetings = Meetings::new(&map, 12);
        let own: f32 = meetings
            .across(0, 0)
            .iter()
            .map(|meeting| meeting.share)
            .sum();
        assert!((own - 1.0).abs() < 1e-5);
        assert!(meetings.across(0, 0).iter().all(|m| m.from == m.to));
        assert!(meetings.across(0, 1).is_empty());
        // A place at an offset has a point as often as one at the opposite offset.
        for offset in 1..=12 {
            for parity in 0..2 {
                let sum = |offset| -> f32 {
                    meetings
                        .across(offset, parity)
                        .iter()
                        .map(|m| m.share)
                        .sum()
                };
                assert!((sum(offset) - sum(-offset)).abs() < 1e-5);
            }
        }
    }
}
