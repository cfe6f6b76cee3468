//! Push and pull, which makes the tables of the profile `spaced`.

use super::Phase;
use crate::{
    domain::Domain,
    energy::{Gaussian, Guard},
    optimize::{Descent, Pairs},
};

/// Push and pull in table space, after Ahmed, Guo, Yan, Franceschi, Zhang, Deussen (2017).
///
/// A [`Guard`] that hardens from stage to stage pushes pairs in conflict apart. A Gaussian assigns
/// every point its share of the plane, which also keeps holes closed. Both are pair energies, so
/// their frequencies are known exactly and no triangulation is needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpacingRecipe {
    /// The width of the Gaussian, in mean spacings.
    pub sigma: f64,
    /// The stages of the push, in order.
    pub pushes: &'static [Push],
}

/// A stage of the push. Lengths are in mean spacings; the upper limit for a smallest distance is
/// that of the hexagonal lattice, 1.0746.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Pairs closer than this are in conflict. Above 1.02 sets crystallize: the spectral peak grows
    /// from 6 to 9 and more.
    pub reach: f64,
    /// The height of the guard at distance 0. The greater it is, the closer to `reach` the smallest
    /// distance ends.
    pub strength: f64,
    /// Mean spacings moved per unit of gradient. A harder push needs a lower rate.
    pub rate: f64,
    /// The share of the steps that the stage takes; the last stage takes all that are left.
    pub share: f64,
}

impl SpacingRecipe {
    /// One phase for each stage of the push.
    pub(crate) fn phases(&self, domain: &Domain, steps: u32) -> Vec<Phase> {
        let mut left = steps;
        let mut phases = Vec::new();
        for (at, push) in self.pushes.iter().enumerate() {
            let last = at + 1 == self.pushes.len();
            let share = (f64::from(steps) * push.share) as u32;
            let steps = if last { left } else { share.min(left) };
            left -= steps;
            let energy = (
                Gaussian::new(self.sigma),
                Guard::new(push.reach, push.strength),
            );
            phases.push(Phase {
                objective: Box::new(Pairs::new(energy, &domain.twin_maps(), domain.scale())),
                descent: Descent {
                    steps,
                    rate: push.rate,
                },
            });
        }
        phases
    }

    pub(crate) fn parameters(&self) -> Vec<(&'static str, String)> {
        let list = |pick: fn(&Push) -> f64| {
            let each: Vec<String> = self.pushes.iter().map(|p| pick(p).to_string()).collect();
            each.join(" ")
        };
        vec![
            ("sigma", self.sigma.to_string()),
            ("reach", list(|p| p.reach)),
            ("strength", list(|p| p.strength)),
            ("rate", list(|p| p.rate)),
            ("share", list(|p| p.share)),
        ]
    }
}
