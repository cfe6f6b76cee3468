//! The centroidal Voronoi relaxation that AA patterns were published with.

use super::Phase;
use crate::{
    domain::Domain,
    energy::Lloyd,
    optimize::{Descent, Sets},
};

/// Lloyd's relaxation on all twins at once. A block moves by the mean of its instances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LloydRecipe {
    /// Mean spacings moved per unit of gradient: ½ is a step to the centroid.
    pub rate: f64,
}

impl LloydRecipe {
    pub(crate) fn phases(&self, domain: &Domain, steps: u32) -> Vec<Phase> {
        vec![Phase {
            objective: Box::new(Sets::new(Lloyd, &domain.map, &domain.twins)),
            descent: Descent {
                steps,
                rate: self.rate,
            },
        }]
    }

    pub(crate) fn parameters(&self) -> Vec<(&'static str, f64)> {
        vec![("rate", self.rate)]
    }
}
