//! The profile `lloyd`: the centroidal Voronoi relaxation that AA patterns were published with.

use super::{Phase, Profile, Recipe, named};
use crate::{
    energy::Lloyd,
    ground::Ground,
    judge::{Bound, Figure},
    optimize::{Descent, Sets},
};

/// Relaxation on the points of all twins at once; a block moves by the mean of its instances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LloydRecipe {
    /// Spacings moved per unit of gradient: ½ is a step to the centroid.
    pub rate: f64,
}

/// Points at the centroids of their cells.
///
/// Target: the least mean squared distance from a place to its nearest point. It begins at the
/// pattern itself, so no seed acts, and momentum takes it to convergence.
pub(super) const LLOYD: Profile = Profile {
    name: "lloyd",
    summary: "centroidal Voronoi relaxation of the pattern, at convergence",
    recipe: Recipe::Lloyd(LloydRecipe { rate: 0.5 }),
    jitter: 0.0,
    steps: 400,
    bounds: &[
        Bound::at_least(Figure::DeltaMin, 0.7),
        Bound::at_most(Figure::AreaDeviation, 0.3),
        Bound::at_most(Figure::LargestHole, 0.8),
    ],
};

impl LloydRecipe {
    pub(super) fn phases(&self, ground: &Ground, steps: u32) -> Vec<Phase> {
        vec![Phase {
            objective: Box::new(Sets::new(Lloyd, &ground.map, &ground.twins)),
            descent: Descent {
                steps,
                rate: self.rate,
            },
        }]
    }

    pub(super) fn describe(&self) -> Vec<(String, String)> {
        named(&[("rate", self.rate)])
    }
}
