//! Following a radial power curve.

use std::slice;

use super::Phase;
use crate::{
    curve::Target,
    domain::Domain,
    energy::Gaussian,
    optimize::{Descent, Objective, Pairs, Radial, RadialWeights},
};

/// The descent on the error of a radial power curve, on unbounded patterns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialRecipe {
    /// The points (ν, power) of the curve; see [`Target`].
    pub curve: &'static [[f64; 2]],
    /// The weights in the cost of its error.
    pub weights: RadialWeights,
    /// The share of the steps that Gaussian repulsion (σ = 1) takes first. It quickly removes the
    /// power at low frequencies, which suits curves that are 0 nearly as far as it reaches.
    pub warm_share: f64,
    /// Mean spacings moved per unit of gradient, at first.
    pub rate: f64,
}

impl RadialRecipe {
    /// All parameters but the curve.
    pub(crate) fn parameters(&self) -> Vec<(&'static str, f64)> {
        let weights = &self.weights;
        let mut parameters = vec![
            ("reach", weights.reach),
            ("nu_max", weights.nu_max),
            ("fit", weights.fit),
            ("quiet", weights.quiet),
            ("edge", weights.edge),
            ("leash", weights.leash),
            ("rate", self.rate),
        ];
        if self.warm_share > 0.0 {
            parameters.push(("warm_share", self.warm_share));
        }
        parameters
    }

    /// The repulsion, if it has any steps, then the descent on the curve's error. The repulsion
    /// uses the pattern of α alone. The error is averaged over several α of the same map, so that
    /// the table follows its curve on every twin.
    pub(crate) fn phases(&self, domain: &Domain, target: &Target, steps: u32) -> Vec<Phase> {
        let warm = (self.warm_share * f64::from(steps)) as u32;
        let map = slice::from_ref(&domain.map);
        let repulsion: Box<dyn Objective> =
            Box::new(Pairs::new(Gaussian::new(1.0), map, domain.scale()));
        let curve: Box<dyn Objective> =
            Box::new(Radial::new(&domain.spread(), target, &self.weights));
        let phase = |objective, steps, rate| Phase {
            objective,
            descent: Descent { steps, rate },
        };
        let phases = [
            phase(repulsion, warm, WARM_RATE),
            phase(curve, steps - warm, self.rate),
        ];
        let some = phases.into_iter().filter(|phase| phase.descent.steps > 0);
        some.collect()
    }
}

/// Mean spacings moved per unit of gradient of the repulsion.
const WARM_RATE: f64 = 0.2;
