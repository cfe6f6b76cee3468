//! The profile `spaced`: no two points close, no hole wide.

use super::{Phase, Profile, Recipe};
use crate::{
    energy::{Gaussian, Guard},
    ground::Ground,
    judge::{Bound, Figure},
    optimize::{Descent, Pairs},
};

/// Push and pull in table space (after Ahmed, Guo, Yan, Franceschi, Zhang, Deussen 2017): pairs in
/// conflict are pushed apart by a [`Guard`] that hardens from stage to stage; a Gaussian gives every
/// point its share of the plane, which is also what keeps holes closed. So both are pair energies,
/// whose frequencies are known exactly, and no triangulation is needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpacingRecipe {
    /// Width of the Gaussian, in mean spacings.
    pub sigma: f64,
    /// The stages of the push, in order.
    pub pushes: &'static [Push],
}

/// A stage of the push; lengths in mean spacings. The hexagonal lattice, the most one can ask for,
/// has its neighbors at 1.0746.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Pairs closer than this are in conflict. Above 1.02 sets crystallize: the spectral peak grows
    /// from 6 to 9 and more.
    pub reach: f64,
    /// How hard they are pushed: the harder, the closer to the reach the smallest distance ends.
    pub strength: f64,
    /// Spacings moved per unit of gradient; to be lowered as the push hardens.
    pub rate: f64,
    /// The stage's share of the steps; the last stage has what is left.
    pub share: f64,
}

/// A large minimum distance, like farthest-point optimization (FPO), with low power and small holes.
///
/// Target: δ_min ≥ 0.93 of the hexagonal distance. The first stage makes ordinary blue noise; pushed
/// from the start, conflicts would freeze before holes close.
pub(super) const SPACED: Profile = Profile {
    name: "spaced",
    summary: "large minimum distance, small holes",
    recipe: Recipe::Spacing(SpacingRecipe {
        sigma: 1.0,
        pushes: &[
            Push {
                reach: 0.9,
                strength: 0.3,
                rate: 0.2,
                share: 0.07,
            },
            Push {
                reach: 1.02,
                strength: 20.0,
                rate: 0.01,
                share: 0.465,
            },
            Push {
                reach: 1.015,
                strength: 200.0,
                rate: 0.001,
                share: 0.465,
            },
        ],
    }),
    jitter: 0.7,
    steps: 860,
    bounds: &[
        Bound::at_least(Figure::DeltaMin, 0.93),
        Bound::at_most(Figure::LowPower, 1.5e-2),
        Bound::at_most(Figure::LargestHole, 0.85),
    ],
};

impl SpacingRecipe {
    pub(super) fn phases(&self, ground: &Ground, steps: u32) -> Vec<Phase> {
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
                objective: Box::new(Pairs::new(energy, &ground.maps(), ground.scale())),
                descent: Descent {
                    steps,
                    rate: push.rate,
                },
            });
        }
        phases
    }

    pub(super) fn describe(&self) -> Vec<(String, String)> {
        let list = |pick: fn(&Push) -> f64| {
            let each: Vec<String> = self.pushes.iter().map(|p| pick(p).to_string()).collect();
            each.join(" ")
        };
        vec![
            ("sigma".into(), self.sigma.to_string()),
            ("reach".into(), list(|p| p.reach)),
            ("strength".into(), list(|p| p.strength)),
            ("rate".into(), list(|p| p.rate)),
            ("share".into(), list(|p| p.share)),
        ]
    }
}
