//! Joint tables: the vectors of a table moved so that all its points and those of each kind of a mix are
//! blue.

use strew_core::{
    Table,
    table::{Displacement, Mix},
};

use super::{
    clear::{Floor, clear},
    together::Together,
};
use crate::{
    optimize::{Descent, DescentState},
    thinned::moves_of,
    watch::Meter,
};

/// Mean spacings moved per unit of gradient.
const RATE: f64 = 0.2;
/// The least δ of all points and of a kind: more than what is promised, because the warps of seeds bring some
/// pairs nearer, by 4 percent in windows of 60,000 points.
const FLOOR: Floor = Floor {
    all: 0.58,
    kind: 0.62,
};
/// The most rounds of pushing near pairs apart.
const ROUNDS: usize = 200;

/// The moved vectors of a table, or `None` if the meter's watch stopped the work. It takes `steps` steps.
pub(super) fn moved(
    table: &Table,
    mix: &Mix,
    steps: u32,
    meter: &mut Meter<'_>,
) -> Option<Vec<Displacement>> {
    let shares: Vec<f64> = (0..mix.shares().kinds() as u8)
        .map(|kind| mix.shares().of(kind))
        .collect();
    let kinds = parts(table, mix);
    let mut energy = Together::new(table, &shares, &kinds);
    let descent = Descent { steps, rate: RATE };
    let start = DescentState::start(moves_of(table));
    let done = descent.run(&mut energy, start, meter, &mut |_| {});
    if done.steps < steps {
        return None;
    }
    let mut moves = done.moves;
    clear(energy.ground(), &kinds, &shares, &mut moves, FLOOR, ROUNDS);
    let unit = table.alpha().set_side_f64() / f64::from(1u32 << 20);
    let fixed = |move_: &[f64; 2]| move_.map(|v| (v / unit).round() as i32);
    Some(moves.iter().map(fixed).collect())
}

/// The part of each block that is of each kind, kind by kind.
pub(super) fn parts(table: &Table, mix: &Mix) -> Vec<Vec<f64>> {
    let map = table.map();
    let mut parts = vec![vec![0.0; mix.labels().len()]; mix.shares().kinds()];
    for (block, &kind) in mix.labels().iter().enumerate() {
        parts[usize::from(kind)][block] = 1.0;
    }
    for split in mix.splits() {
        let block = split.block as usize;
        let interval = map.interval(block % map.intervals());
        let part = split.offset as f64 / (interval.end - interval.start) as f64;
        parts[usize::from(mix.labels()[block])][block] = part;
        parts[usize::from(split.kind)][block] = 1.0 - part;
    }
    parts
}
