//! A slow program written from the section "Points in space" of docs/algorithm.md alone, with the shears of the plane's
//! program, compared with the library.

use crate::subject;

use proptest::prelude::*;
use strew_core::{
    Attribute, Attributes, Variants,
    space::{PointId, SpaceSet, Table},
};
use subject::{
    definition::{KNOT, control, mix, shift},
    space::{between, table},
};

/// The sizes of the shears' slopes: along axes, and along diagonals.
const SLOPES: [f64; 2] = [0.09, 0.045];

/// A name of eight bytes as an integer.
fn named(name: &[u8; 8]) -> u64 {
    u64::from_be_bytes(*name)
}

/// g of one shear.
fn g(key: u64, slope: f64, s: i64) -> i64 {
    let step = (slope * KNOT as f64).round() as i128;
    shift(|knot| control(key, step, knot), s.into()) as i64
}

/// The set of a table, a spacing, a seed and a strength of the warp.
struct Definition<'a> {
    table: &'a Table,
    spacing: f64,
    seed: u64,
    strength: f64,
}

impl Definition<'_> {
    fn origin(&self) -> [u64; 3] {
        if self.seed == 0 {
            return [0; 3];
        }
        let x = mix(self.seed);
        let y = mix(x ^ self.seed);
        [x, y, mix(y ^ self.seed)]
    }

    /// The axes that the axes of the set show, and whether they are reversed.
    fn symmetry(&self) -> ([usize; 3], [bool; 3]) {
        if self.seed == 0 {
            return ([0, 1, 2], [false; 3]);
        }
        let h = mix(self.seed ^ named(b"SYMMETRY"));
        let orders = [
            [0, 1, 2],
            [0, 2, 1],
            [1, 0, 2],
            [1, 2, 0],
            [2, 0, 1],
            [2, 1, 0],
        ];
        let order = orders[(((h % (1 << 32)) * 6) >> 32) as usize];
        (order, [61, 62, 63].map(|bit| (h >> bit) & 1 == 1))
    }

    fn indices(&self, [x, y, z]: [i64; 3]) -> [u64; 3] {
        let half = self.table.map().alpha().half();
        let others = [(x, y + z), (y, x + z), (z, x + y)];
        let origin = self.origin();
        [0, 1, 2].map(|axis| {
            let (own, others) = others[axis];
            let index = half.wrapping_mul(own as u64).wrapping_add(origin[axis]);
            index.wrapping_add((others.rem_euclid(2) as u64) << 63)
        })
    }

    /// The number of the table's block of a point.
    fn block(&self, at: [i64; 3]) -> Option<usize> {
        let map = self.table.map();
        let n = map.intervals();
        let mut intervals = [0; 3];
        for (interval, index) in intervals.iter_mut().zip(self.indices(at)) {
            *interval = (0..n).find(|&i| map.interval(i).contains(&index))?;
        }
        let (axes, reversed) = self.symmetry();
        let mut source = [0; 3];
        for axis in 0..3 {
            let i = intervals[axis];
            source[axes[axis]] = if reversed[axis] { n - 1 - i } else { i };
        }
        let [i, j, k] = source;
        Some((k * n + j) * n + i)
    }

    fn position(&self, at: [i64; 3]) -> Option<[i64; 3]> {
        let vector = self.table.vectors()[self.block(at)?];
        let (axes, reversed) = self.symmetry();
        let mut p = [0, 1, 2].map(|axis| {
            let v = i64::from(vector[axes[axis]]);
            (at[axis] << 20) + 256 * if reversed[axis] { -v } else { v }
        });
        if self.strength == 0.0 {
            return Some(p);
        }
        let common = mix(self.seed ^ named(b"SPACE  3") ^ named(b"WEAVERS!"));
        for (group, [a, b]) in [[0, 1], [1, 2], [2, 0]].into_iter().enumerate() {
            for i in 1..=4u64 {
                let key = mix(common.wrapping_add((4 * group as u64 + i) << 56));
                let slope = SLOPES[usize::from(i > 2)];
                let g = |s| g(key, slope * self.strength, s);
                match i {
                    1 => p[b] += g(p[a]),
                    2 => p[a] += g(p[b]),
                    3 => {
                        let d = g(p[a] - p[b]);
                        p[a] += d;
                        p[b] += d;
                    }
                    _ => {
                        let d = g(p[a] + p[b]);
                        p[a] += d;
                        p[b] -= d;
                    }
                }
            }
        }
        Some(p)
    }

    fn coordinates(&self, at: [i64; 3]) -> Option<[f64; 3]> {
        let side = self.table.map().alpha().set_side() as f64;
        let t = side * 0.5f64.powi(64);
        let step = self.spacing * t / f64::from(1 << 20);
        Some(self.position(at)?.map(|p| p as f64 * step))
    }

    fn rank(&self, at: [i64; 3]) -> Option<f64> {
        let map = self.table.map();
        let n = map.intervals();
        let length = |i: usize| u128::from((map.interval(i).end - map.interval(i).start) >> 24);
        let size = |b: usize| length(b % n) * length(b / n % n) * length(b / n / n);
        let positions = self.table.ranks().expect("ranks").positions();
        let below = |position: u32| -> f64 {
            let blocks = (0..positions.len()).filter(|&b| positions[b] < position);
            blocks.map(size).sum::<u128>() as f64
                / (0..positions.len()).map(size).sum::<u128>() as f64
        };
        let position = positions[self.block(at)?];
        let is_last = position as usize + 1 == positions.len();
        let (floor, next) = (
            below(position),
            if is_last { 1.0 } else { below(position + 1) },
        );
        let index = self.indices(at)[0];
        let interval = (0..n)
            .map(|i| map.interval(i))
            .find(|i| i.contains(&index))?;
        let part = (index - interval.start) as f64 / (interval.end - interval.start) as f64;
        Some((floor + (next - floor) * part).min(next.next_down()))
    }
}

/// The addresses of a cube that the definition has points at, in the library's order.
fn addresses(corner: [i64; 3], side: i64) -> Vec<[i64; 3]> {
    let [x, y, z] = corner;
    let mut all = Vec::new();
    for z in z..z + side {
        for y in y..y + side {
            all.extend((x..x + side).map(|x| [x, y, z]));
        }
    }
    all.sort_by_key(|&[x, y, z]| (x >> 10, y >> 10, z, y, x));
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn the_library_has_the_points_of_the_definition(
        seed in prop_oneof![Just(0), any::<u64>()], spacing in 0.1..9.0f64, strength in prop_oneof![Just(0.0), Just(1.0), 0.1..2.0f64],
        corner in prop::array::uniform3(prop_oneof![-3000i64..3000, -1i64 << 39..1 << 39]),
    ) {
        let table = table(32_767);
        let strength = (strength * 256.0).round() / 256.0;
        let set = SpaceSet::new(table.clone()).seed(seed).warp(strength).expect("in range");
        let set = set.spacing(spacing).expect("in range");
        let definition = Definition { table: &table, spacing, seed, strength };
        let mut inside = Vec::new();
        let unit = spacing * table.map().alpha().set_side_f64();
        let region = between(
            corner.map(|v| (v as f64 + 4.0) * unit),
            corner.map(|v| (v as f64 + 20.0) * unit),
        );
        for at in addresses(corner.map(|v| v - 72), 168) {
            let [x, y, z] = at;
            let place = definition.coordinates(at);
            let near = (0..3).all(|axis| (corner[axis]..corner[axis] + 24).contains(&at[axis]));
            if near {
                let point = set.point(PointId { x, y, z });
                prop_assert_eq!(point.map(|p| p.at()), place, "{:?}", at);
                if let Some(rank) = definition.rank(at) {
                    prop_assert_eq!(set.rank(PointId { x, y, z }), rank);
                }
            }
            if let Some(place) = place && region.contains(place) {
                inside.push((PointId { x, y, z }, place));
            }
        }
        let found = set.within(region).expect("near enough");
        prop_assert_eq!(found.count(), inside.len() as u128);
        let found: Vec<_> = found.iter().map(|point| (point.id(), point.at())).collect();
        prop_assert_eq!(found, inside);
    }
}

/// The hash of a point for an attribute with a code.
fn hash(seed: u64, code: u64, [x, y, z]: [i64; 3]) -> u64 {
    let key = mix(mix(seed ^ named(b"ATTRIBUT")).wrapping_add(code << 32));
    let round = |v: i64, factor: u64| (v as u64).wrapping_mul(factor);
    let level = mix(key ^ round(z, 0xa076_1d64_78bd_642f)).wrapping_add(key);
    let row = mix(level ^ round(y, 0xc2b2_ae3d_27d4_eb4f)).wrapping_add(level);
    mix(row ^ round(x, 0xd6e8_feb8_6659_fd93))
}

/// The uniform number of such a hash.
fn unit(seed: u64, code: u64, at: [i64; 3]) -> f64 {
    (hash(seed, code, at) >> 11) as f64 / (1u64 << 53) as f64
}

proptest! {
    #[test]
    fn the_library_has_the_attributes_of_the_definition(
        seed: u64, at in prop::array::uniform3(-1i64 << 40..1 << 40),
    ) {
        let set = SpaceSet::new(table(32_767)).seed(seed);
        let variants: Variants = "ice:1,rock:3".parse().expect("valid");
        let list = Attributes::new(vec![
            "rotation".parse().expect("known"),
            Attribute::scale(0.5, 2.0).expect("in range"),
            Attribute::Variant(variants),
            "u3".parse().expect("known"),
        ]);
        let bound = set.attributes(&list.expect("different")).expect("of space");
        let [x, y, z] = at;
        let columns = bound.columns([PointId { x, y, z }]);
        let numbers: Vec<f64> = columns.iter().filter_map(|column| Some(column.numbers()?[0])).collect();
        let [u, v, w] = [4, 5, 6].map(|code| unit(seed, code, at));
        let turn = |v: f64| libm::sincos(std::f64::consts::TAU * v);
        let ((a, b), (c, d)) = (turn(v), turn(w));
        let (low, high) = ((1.0 - u).sqrt(), u.sqrt());
        let scale = 0.5 + unit(seed, 2, at) * 1.5;
        prop_assert_eq!(numbers, vec![low * a, low * b, high * c, high * d, scale, unit(seed, 0x103, at)]);
        // A quarter of the weight is before the second name.
        let variant = u32::from(hash(seed, 3, at) >= 1 << 62);
        prop_assert_eq!(columns[5].variants(), Some(&[variant][..]));
    }
}

#[test]
fn sets_are_those_of_their_files_and_of_their_parameters() {
    let file = table(4096).to_bytes();
    let set = SpaceSet::from_table(&file).expect("valid").seed(7);
    assert_eq!(set.table(), &table(4096));
    let id = |x| PointId { x, y: 0, z: 0 };
    let unturned = set.clone().seed(0);
    assert_eq!([0, 1].map(|x| unturned.block(id(x))), [Some([0; 3]), None]);
    let plan = set.chunk(8.0, [0, 0, 0]).expect("near");
    let list = |attribute| Attributes::new(vec![attribute]).expect("one");
    let scale = list(Attribute::scale(0.5, 2.0).expect("in range"));
    let bound = plan.attributes(&scale).expect("of space");
    let mut columns = vec![];
    bound.write_points(&plan.to_vec(), &mut columns);
    assert_eq!(columns, bound.columns(plan.iter().map(|point| point.id())));
    assert!(set.attributes(&list(Attribute::Angle)).is_err());
    assert_eq!(
        (set.steps(), set.keep(0.5).expect("a share").steps()),
        (0, 2)
    );
}
