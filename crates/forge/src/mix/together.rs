//! The energy of all points together and of each kind, as a function of a table's vectors.

use strew_core::Map;

use super::part::Part;
use crate::{
    energy::{Gaussian, Guard},
    ladder::Ground,
    optimize::{Objective, Pairs},
};

type Law = (Gaussian, Guard);

/// How the energies are weighed.
#[derive(Clone, Copy, Debug)]
pub struct Balance {
    /// The weight of the energy of all points over that of a kind.
    pub all: f64,
    /// σ of all points, in mean spacings.
    pub sigma_all: f64,
    /// σ of a kind, in its own.
    pub sigma: f64,
    /// Guards.
    pub guard_all: f64,
    pub guard: f64,
    pub strength: f64,
    pub strength_all: f64,
}

/// The sum of the energies.
pub(super) struct Together {
    ground: Ground,
    all: Pairs<Law>,
    parts: Vec<Part<Law>>,
    weight: f64,
}

impl Together {
    /// The energies of kinds, each of which has a part of each block.
    pub(super) fn new(map: &Map, kinds: Vec<Vec<f64>>, balance: &Balance, rarest: f64) -> Self {
        let scale = map.alpha().set_side_f64();
        let law = |sigma, reach, strength| (Gaussian::new(sigma), Guard::new(reach, strength));
        let all = law(balance.sigma_all, balance.guard_all, balance.strength_all);
        let kind = law(balance.sigma, balance.guard, balance.strength);
        let reach = (5.5 * balance.sigma + 0.3) / rarest.sqrt() + 12.0;
        let ground = Ground::new(map, reach);
        let parts = kinds
            .into_iter()
            .map(|weights| Part::new(kind, &ground, weights))
            .collect();
        Self {
            all: Pairs::new(all, std::slice::from_ref(map), scale),
            parts,
            ground,
            weight: balance.all,
        }
    }
}

impl Objective for Together {
    fn masses(&self) -> &[f64] {
        self.all.masses()
    }

    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        let mut energy = self.weight * self.all.evaluate(moves, gradient);
        for slope in gradient.iter_mut().flatten() {
            *slope *= self.weight;
        }
        for part in &mut self.parts {
            energy += part.add(&self.ground, moves, 1.0, gradient);
        }
        // Per unit of weight, so that one rate serves all.
        gradient.iter_mut().flatten().for_each(|slope| *slope /= self.weight + 1.0);
        energy / (self.weight + 1.0)
    }

    fn prepared_for(&self) -> &[[f64; 2]] {
        self.all.prepared_for()
    }

    fn prepare_for(&mut self, moves: &[[f64; 2]]) {
        self.all.prepare_for(moves);
    }
}
