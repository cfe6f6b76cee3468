//! Judging a ladder: at shares that no step looked at, on twins that it was not made with.
//!
//! Shares that a ladder was polished at look perfect, and the shares between them need not be. So the
//! shares here are incommensurate with the levels: 101 an octave, with a phase.

use rayon::prelude::*;
use strew_core::{Table, Twin, table::Figures};

use super::thinned::ThinnedTwin;
use crate::{
    judge::{Bound, Complaint, Figure},
    measure::{Distances, Spectrum},
    twins::nearest,
    watch::{Meter, Stage, Watch},
};

/// The most points of the twins judged on. Neighbors in a thinned set lie beyond the map's half-width, where
/// frequencies follow α; so of the twins of these sizes the nearest to α are taken.
const LARGEST: [u64; 2] = [100_000, 1_000_000];
/// Shares an octave on each twin.
const SHARES: [u32; 2] = [101, 23];
/// The first share, in steps.
const PHASE: f64 = 0.37;
/// The width of the rings that the spectrum is taken over.
const RING: f64 = 0.04;
/// The greatest frequency looked at.
const NU: f64 = 0.6;
/// The greatest mean power below ν = 0.5 at any share.
const LOW: f64 = 5e-3;
/// The number of blocks left from which that bound holds. With fewer, low power is in proportion to
/// 1/blocks.
const BLOCKS: f64 = 250.0;
/// The least δ at any share.
const DELTA: f64 = 0.5;

/// The figures by twin and octave, or `None` if the watch stopped the work.
pub(super) fn judge(table: &Table, watch: &dyn Watch) -> Option<Vec<Figures>> {
    let octaves = octaves(table);
    let twins: Vec<Twin> = LARGEST
        .iter()
        .filter_map(|&most| nearest(table.map(), most))
        .collect();
    let mut meter = Meter::new(watch, Stage::Measuring, octaves * twins.len() as u32);
    let mut all = Vec::new();
    for (twin, per) in twins.into_iter().zip(SHARES) {
        let thinned = ThinnedTwin::new(table, twin)?;
        for octave in 0..octaves {
            if meter.stop() {
                return None;
            }
            let measured: Vec<(f64, f64)> = (0..per)
                .into_par_iter()
                .map(|i| {
                    let down = f64::from(octave) + (f64::from(i) + PHASE) / f64::from(per);
                    let set = thinned.at(libm::exp2(-down), true);
                    let low = Spectrum::of_torus(&set, NU).summary(RING).low_power;
                    (low, Distances::of_torus(&set).delta_min)
                })
                .collect();
            let low = measured.iter().map(|&(low, _)| low);
            let delta = measured.iter().map(|&(_, delta)| delta);
            all.push(Figures {
                subject: format!("twin {twin}, {}", between(octave)),
                seen: false,
                points: (twin.points() as f64 * libm::exp2(-f64::from(octave))) as u64,
                values: vec![
                    (
                        Figure::LowPower.name().into(),
                        low.clone().fold(0.0, f64::max),
                    ),
                    ("low_power_mean".into(), low.sum::<f64>() / f64::from(per)),
                    (
                        Figure::DeltaMin.name().into(),
                        delta.fold(f64::INFINITY, f64::min),
                    ),
                ],
            });
            meter.advance(None);
        }
    }
    Some(all)
}

/// The number of times the share halves along the ladder.
fn octaves(table: &Table) -> u32 {
    let least = table.ladder().map_or(1.0, |ladder| ladder.least_share());
    (1..=32)
        .find(|&k| libm::exp2(-f64::from(k)) <= least * 1.001)
        .unwrap_or(1)
}

/// The shares of an octave in words.
fn between(octave: u32) -> String {
    format!("shares 1/{} to 1/{}", 1u64 << octave, 2u64 << octave)
}

/// The bounds that these figures miss: δ_min everywhere, and low power in the octaves at whose end enough
/// blocks are left.
pub(super) fn bounds_missed(table: &Table, figures: &[Figures]) -> Vec<Complaint> {
    let blocks = table.displacements().len() as f64;
    let octaves = octaves(table);
    let mut missed = Vec::new();
    for figures in figures {
        missed.extend(Bound::at_least(Figure::DeltaMin, DELTA).check(figures));
        let is_dense = |octave: &u32| blocks * libm::exp2(-f64::from(octave + 1)) >= BLOCKS;
        let mut dense = (0..octaves).filter(is_dense);
        if dense.any(|octave| figures.subject.ends_with(&between(octave))) {
            missed.extend(Bound::at_most(Figure::LowPower, LOW).check(figures));
        }
    }
    missed
}
