//! Where a seed puts a point, written from "A seed" in docs/algorithm.md and not from the library's code:
//! wide integers, one step after another, nothing kept.

use strew_core::{Field, Keep, PointId, PointSet, Seed, Table};

/// The length of a cell of the warp.
pub const KNOT: i128 = 1 << 25;

pub fn mix(state: u64) -> u64 {
    let mut z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A symmetry of the square: reflections along x and y, after an exchange of the axes.
#[derive(Clone, Copy)]
struct Symmetry {
    reverses: [bool; 2],
    swaps: bool,
}

impl Symmetry {
    fn of(seed: Seed) -> Self {
        let bits = match seed.0 {
            0 => 0,
            seed => mix(seed ^ u64::from_be_bytes(*b"SYMMETRY")) >> 61,
        };
        let [reverses_x, reverses_y, swaps] = [1, 2, 4].map(|bit| bits & bit != 0);
        Self {
            reverses: [reverses_x, reverses_y],
            swaps,
        }
    }

    /// The number of the block of an n × n table that points in block (i, j) take.
    fn source(self, n: usize, [mut i, mut j]: [usize; 2]) -> usize {
        if self.reverses[0] {
            i = n - 1 - i;
        }
        if self.reverses[1] {
            j = n - 1 - j;
        }
        if self.swaps {
            (i, j) = (j, i);
        }
        j * n + i
    }

    fn turn(self, [mut dx, mut dy]: [i128; 2]) -> [i128; 2] {
        if self.swaps {
            (dx, dy) = (dy, dx);
        }
        [
            if self.reverses[0] { -dx } else { dx },
            if self.reverses[1] { -dy } else { dy },
        ]
    }
}

/// The control value of a knot.
pub fn control(key: u64, step: i128, knot: i128) -> i128 {
    let knot = knot + i128::from(key >> 61);
    let (group, place) = (knot.div_euclid(8), knot.rem_euclid(8) as usize);
    let hash = mix(key ^ (group as u64).wrapping_mul(0xd6e8_feb8_6659_fd93));
    let byte = |i: usize| (hash >> (8 * i) & 255) as usize;
    let mut order = [0, 1, 2, 3, 4, 5, 6, 7usize];
    for (i, last) in (1..8).rev().enumerate() {
        order.swap(last, byte(i) * (last + 1) / 256);
    }
    let phase = byte(7) % 16;
    let slope = |j: usize| {
        let angle = (16 * j + phase) as f64 * std::f64::consts::TAU / 128.0;
        let sine = (angle.sin() * f64::from(1 << 30)).round() as i128;
        sine * step / (1 << 30)
    };
    order[..=place].iter().map(|&j| slope(j)).sum()
}

/// The part of a control value that long waves add.
fn long_control(key: u64, step: i128, knot: i128) -> i128 {
    let [a, b, c] = [-1, 0, 1].map(|i| control(key, step, knot.div_euclid(4) + i));
    let sum = match knot.rem_euclid(4) {
        0 => 6 * a + 10 * b,
        1 => 3 * a + 12 * b + c,
        2 => a + 12 * b + 3 * c,
        _ => 10 * b + 6 * c,
    };
    sum.div_euclid(16)
}

/// g of a direction at a coordinate across it, from its control values.
pub fn shift(control: impl Fn(i128) -> i128, s: i128) -> i128 {
    let cell = s.div_euclid(KNOT);
    let [a, b, c] = [-1, 0, 1].map(|i| control(cell + i));
    let (half, unit) = (0.5f32, (KNOT as f32).recip());
    let constant = (a + b) as f32 * half;
    let linear = (b - a) as f32 * unit;
    let square = (a - 2 * b + c) as f32 * (half * unit * unit);
    let at = s.rem_euclid(KNOT) as f32;
    ((square * at + linear) * at + constant) as i128
}

/// The place to which the warp of a profile moves a position in units of 2⁻²⁰ lattice units.
fn warped(profile: &str, seed: Seed, strength: f64, [mut x, mut y]: [i128; 2]) -> [i128; 2] {
    let first = mix(seed.0 ^ u64::from_be_bytes(*b"WEAVERS!"));
    let key = |i: u64| mix(first.wrapping_add(i << 56));
    let step = |slope: f64| (slope * strength * KNOT as f64).round() as i128;
    let shift = |i: u64, part: f64, s: i128| {
        let value = |knot: i128| {
            let short = control(key(i), step(0.09 * part), knot);
            match profile {
                "pink" => short + long_control(key(i + 4), step(0.24 * part), knot),
                _ => short,
            }
        };
        shift(value, s)
    };
    y += shift(1, 1.0, x);
    x += shift(2, 1.0, y);
    let rising = shift(3, 0.5, x - y);
    (x, y) = (x + rising, y + rising);
    let falling = shift(4, 0.5, x + y);
    [x + falling, y - falling]
}

/// The indices of an address along both axes, and its block, if the pattern has a point there.
fn block(table: &Table, seed: Seed, id: PointId) -> Option<([u64; 2], [usize; 2])> {
    let map = table.map();
    let index = |own: i64, other: i64, origin: u64| {
        let turned = table.alpha().half().wrapping_mul(own as u64);
        let crossed = u64::from(other % 2 != 0) << 63;
        turned.wrapping_add(crossed).wrapping_add(origin)
    };
    let origin = seed.origin();
    let indices = [index(id.x, id.y, origin.x), index(id.y, id.x, origin.y)];
    let [i, j] = indices.map(|u| (0..map.intervals()).find(|&i| map.interval(i).contains(&u)));
    Some((indices, [i?, j?]))
}

/// The rank of a point of the pattern, whether it is kept or not.
pub fn rank(set: &PointSet, id: PointId) -> Option<f64> {
    let (table, seed) = (set.table(), set.placement().seed);
    let ([index, _], [i, j]) = block(table, seed, id)?;
    let map = table.map();
    let ranks = table.block_ranks(Symmetry::of(seed).source(map.intervals(), [i, j]));
    let interval = map.interval(i);
    let part = (index - interval.start) as f64 / (interval.end - interval.start) as f64;
    let rank = ranks.start + (ranks.end - ranks.start) * part;
    Some(rank.min(ranks.end.next_down()))
}

/// The kind of a point of the pattern, if the table has kinds: written from "Kinds" in docs/algorithm.md.
pub fn kind(set: &PointSet, id: PointId) -> Option<u8> {
    let (table, seed) = (set.table(), set.placement().seed);
    let ([index, _], [i, j]) = block(table, seed, id)?;
    let (map, mix) = (table.map(), table.mix()?);
    let n = map.intervals();
    let source = Symmetry::of(seed).source(n, [i, j]);
    let length = |i: usize| u128::from(map.interval(i).end - map.interval(i).start);
    let beyond = |from: u64| {
        let from = u128::from(from) * length(i) / length(source % n);
        u128::from(index - map.interval(i).start) >= from
    };
    let split = mix.splits().iter();
    let mut split = split.filter(|split| split.block as usize == source && beyond(split.offset));
    let label = mix.labels()[source];
    Some(split.next().map_or(label, |split| split.kind))
}

/// The kind of a point of the pattern where shares vary: written from "Kinds" in docs/algorithm.md. `order` is the
/// table of the second order, `weights` has the part and the field of each kind.
pub fn varying_kind(
    set: &PointSet,
    order: &Table,
    weights: &[(f64, Option<&dyn Field>)],
    id: PointId,
) -> Option<u8> {
    let second = rank(&PointSet::new(order.clone()).placed(set.placement()), id)?;
    let at = place(
        &set.clone().placed(set.placement().with_keep(Keep::ALL)),
        id,
    )?;
    let weight = |&(part, field): &(f64, Option<&dyn Field>)| {
        let share = field.map_or(1.0, |field| field.share(at));
        if share > 0.0 {
            part * share.min(1.0)
        } else {
            0.0
        }
    };
    let mut all: Vec<f64> = weights.iter().map(weight).collect();
    if all.iter().all(|weight| *weight == 0.0) {
        all = weights.iter().map(|(part, _)| *part).collect();
    }
    // The rarest first, the next last, and so on.
    let (mut first, mut last) = (Vec::new(), Vec::new());
    for kind in 0..all.len() {
        if kind % 2 == 0 { &mut first } else { &mut last }.push(kind);
    }
    first.extend(last.iter().rev());
    let total = first.iter().fold(0.0, |sum, &kind| sum + all[kind]);
    let mark = (second * total).min(total.next_down());
    let mut end = 0.0;
    for kind in first {
        end += all[kind];
        if mark < end {
            return Some(kind as u8);
        }
    }
    None
}

/// The place of a point of the lattice, if the set has one there.
pub fn place(set: &PointSet, id: PointId) -> Option<[f64; 2]> {
    let (table, placement) = (set.table(), set.placement());
    let (seed, share) = (placement.seed, placement.keep.get());
    let (_, [i, j]) = block(table, seed, id)?;
    if rank(set, id)? >= share {
        return None;
    }
    let source = Symmetry::of(seed).source(table.map().intervals(), [i, j]);
    Some(displaced(set, id, table.displacements()[source]))
}

/// The place of a lattice address with a vector of the table.
fn displaced(set: &PointSet, id: PointId, vector: [i32; 2]) -> [f64; 2] {
    let (table, placement) = (set.table(), set.placement());
    let [dx, dy] = Symmetry::of(placement.seed).turn(vector.map(i128::from));
    let displaced = [(i128::from(id.x) << 20) + dx, (i128::from(id.y) << 20) + dy];
    let place = match placement.warp.strength() {
        0.0 => displaced,
        strength => warped(table.profile(), placement.seed, strength, displaced),
    };
    let step = placement.spacing.get() * table.alpha().set_side_f64() / f64::from(1 << 20);
    place.map(|v| v as f64 * step)
}

/// The place of a point of the lattice in a field, if the set, which is in no field, has one there: written
/// from "A point in a field" in docs/algorithm.md.
pub fn place_in(set: &PointSet, field: &dyn Field, id: PointId) -> Option<[f64; 2]> {
    let (table, placement) = (set.table(), set.placement());
    let (_, [i, j]) = block(table, placement.seed, id)?;
    let source = Symmetry::of(placement.seed).source(table.map().intervals(), [i, j]);
    let full = table.displacements()[source];
    let share = |at| {
        let share = field.share(at);
        if share > 0.0 {
            share.min(1.0) * placement.keep.get()
        } else {
            0.0
        }
    };
    let place = displaced(set, id, full);
    (rank(set, id)? < share(place)).then_some(place)
}
