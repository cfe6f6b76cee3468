//! Labels: which kind each block of a table is of, so that each kind is evenly spread.
//!
//! The energy is a Gaussian of the distance of two points of a kind, σ = 0.55 of the kind's own spacing,
//! summed over all pairs by their exact frequencies. Pairs of all kinds weigh the same: dense kinds, which are
//! the hard ones, have more of them.

use std::f64::consts::PI;

use strew_core::{
    Table,
    table::{Mix, Shares},
};

use super::{
    anneal::{Annealer, Kind, UNIT},
    each,
    press::{Kernel, Presses},
};
use crate::{
    ForgeError,
    optimize::{Ground, longest, moves_of},
    watch::Meter,
};

/// σ in a kind's own spacings. At 0.6 and above dense kinds have more power below ν = 0.5.
const SIGMA: f64 = 0.55;
/// The cut-off of the Gaussian, in σ.
const CUTOFF: f64 = 3.6;
/// Kinds of a smaller share feel a Gaussian as wide as this share does. Their points lie farther apart than
/// blocks determine who is near.
const RAREST: f64 = 1.0 / 24.0;
/// Kinds whose shares differ by no more than this factor feel the same Gaussian.
const ALIKE: f64 = 1.12;

/// The mix of a table for some shares, or `None` if the meter's watch stopped the work. It takes
/// [`anneal::STEPS`](super::anneal::STEPS) steps.
pub(super) fn annealed(
    table: &Table,
    shares: &Shares,
    meter: &mut Meter<'_>,
) -> Result<Option<Mix>, ForgeError> {
    let start = Mix::scattered(table.map(), shares.clone())?;
    let of = each(shares);
    let mut felt: Vec<f64> = Vec::new();
    let lists: Vec<usize> = of
        .iter()
        .map(|&share| {
            let share = share.max(RAREST);
            if felt.last().is_none_or(|&last| share > ALIKE * last) {
                felt.push(share);
            }
            felt.len() - 1
        })
        .collect();
    let range = CUTOFF * SIGMA / felt[0].sqrt();
    let ground = Ground::new(table.map(), range + 2.0 * longest(&moves_of(table)));
    let blocks = ground.shares.len();
    // The densest kind has weight 1 per point.
    let weight = 1.0 / of[of.len() - 1];
    let kernel = |share: f64| Kernel {
        sigma: SIGMA / share.sqrt(),
        range: CUTOFF * SIGMA / share.sqrt(),
    };
    let unit = weight * blocks as f64 * UNIT;
    let presses: Vec<Presses> = felt
        .iter()
        .map(|&share| Presses::new(table, &ground, kernel(share), unit))
        .collect();
    let kinds: Vec<Kind> = of
        .iter()
        .zip(lists)
        .map(|(&share, list)| {
            let sigma = kernel(felt[list]).sigma;
            Kind {
                share,
                presses: list,
                // Half the integral of the Gaussian.
                even: weight * PI * sigma * sigma * blocks as f64,
            }
        })
        .collect();
    let annealer = Annealer::new(&kinds, &presses, &ground.shares, start.labels());
    let Some(labels) = annealer.run(meter) else {
        return Ok(None);
    };
    Ok(Some(Mix::new(table.map(), shares.clone(), labels)?))
}
