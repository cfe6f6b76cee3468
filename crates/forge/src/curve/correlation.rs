//! The pair correlation of a power curve, which shows whether any point set can have the curve.
//!
//! The pair correlation g(r) is the density of points at distance r from a point, over the mean
//! density. It is 1 plus the Fourier transform of P − 1. A density is never negative, so no point
//! set has a curve whose g is negative somewhere: an error remains that no optimizer removes.
//! (g ≥ 0 and P ≥ 0 are necessary conditions. Whether they are sufficient is an open question, so
//! the measured error decides in the end.)

use rayon::prelude::*;

use super::Target;
use crate::numeric::BesselJ0;

/// The largest distance at which g is evaluated, in mean spacings.
const MAX_R: f64 = 20.0;
/// The distance between evaluations of g. The shortest wave of a curve, at ν = 4, is 1/4 long.
const STEP: f64 = 0.01;
/// The error of the integral where a curve has a large jump.
const TOLERANCE: f64 = 0.005;

/// Steps of the integral per unit of ν.
const STEPS_PER_NU: f64 = 2000.0;

/// The least value of the pair correlation g(r) that belongs to a power curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastCorrelation {
    pub g: f64,
    /// The distance r of the least value, in mean spacings.
    pub r: f64,
}

impl LeastCorrelation {
    /// Finds the least value for the power curve `target`, up to r = 20.
    pub fn of(target: &Target) -> Self {
        let bessel = BesselJ0::up_to(2.0 * std::f64::consts::PI * (target.end() + 1.0) * MAX_R);
        let at = |step: u32| {
            let r = f64::from(step) * STEP;
            let g = 1.0 + total_correlation(target, &bessel, r);
            Self { g, r }
        };
        let steps = (0..=(MAX_R / STEP) as u32).into_par_iter();
        let all: Vec<Self> = steps.map(at).collect();
        let none = Self { g: 1.0, r: 0.0 };
        let less = |a: Self, b: Self| if b.g < a.g { b } else { a };
        all.into_iter().fold(none, less)
    }

    /// Whether no point set can have the curve, because g would be negative.
    pub fn is_impossible(&self) -> bool {
        self.g < -TOLERANCE
    }
}

/// Returns the total correlation g(r) − 1 of a set with the power curve `target`: the Fourier
/// transform of T − 1. It is at least −1 for curves that sets can have.
pub(crate) fn total_correlation(target: &Target, bessel: &BesselJ0, r: f64) -> f64 {
    let two_pi = 2.0 * std::f64::consts::PI;
    let steps = (target.end() * STEPS_PER_NU) as usize;
    let sum: f64 = (0..=steps)
        .map(|step| {
            let nu = (step as f64 + 0.5) / STEPS_PER_NU;
            (target.at(nu) - 1.0) * nu * bessel.at(two_pi * nu * r)
        })
        .sum();
    two_pi * sum / STEPS_PER_NU
}

#[cfg(test)]
mod tests {
    use super::*;

    fn least(text: &str) -> LeastCorrelation {
        LeastCorrelation::of(&text.parse().expect("valid"))
    }

    #[test]
    fn a_step_is_possible_up_to_one_over_root_pi() {
        let step = |nu: f64| least(&format!("0 0\n{nu} 0\n{nu} 1"));
        assert!(!step(0.5).is_impossible() && !step(0.5642).is_impossible());
        // The least value for a step is g(0) = 1 − π·ν₀².
        for nu in [0.6, 0.7, 0.9] {
            let found = step(nu);
            assert!(found.is_impossible());
            let expected = 1.0 - std::f64::consts::PI * nu * nu;
            assert!((found.g - expected).abs() < 4e-3, "{found:?} {expected}");
            assert_eq!(found.r, 0.0);
        }
    }

    #[test]
    fn a_random_set_and_a_mild_excess_are_possible_and_a_lone_spike_is_not() {
        assert_eq!(least("0 1").g, 1.0);
        assert!(!least("0 2\n0.5 1").is_impossible());
        // g − 1 is about 2πν·(height·width)·J₀(2πνr), and the least value of J₀ is −0.4.
        let spike = least("0.95 1\n0.95 9\n1.05 9\n1.05 1");
        assert!(spike.is_impossible(), "{spike:?}");
        assert!(
            (spike.r - 3.8317 / std::f64::consts::TAU).abs() < 0.02,
            "{spike:?}"
        );
    }

    #[test]
    fn a_step_leaves_no_room_for_a_pair_at_distance_zero() {
        let bessel = BesselJ0::up_to(60.0);
        let at_most: Target = "0 0\n0.5642 0\n0.5642 1".parse().expect("valid");
        assert!((total_correlation(&at_most, &bessel, 0.0) + 1.0).abs() < 1e-3);
        let step: Target = "0 0\n0.5 0\n0.5 1".parse().expect("valid");
        // The transform of a disk, −ν₀·J₁(2πν₀r)/r.
        let (nu, r): (f64, f64) = (0.5, 1.7);
        let turn = |node: i32| std::f64::consts::PI * (f64::from(node) + 0.5) / 400.0;
        let x = std::f64::consts::TAU * nu * r;
        let j1: f64 = (0..400)
            .map(|node| (turn(node) - x * turn(node).sin()).cos())
            .sum::<f64>()
            / 400.0;
        assert!((total_correlation(&step, &bessel, r) + nu * j1 / r).abs() < 1e-3);
    }
}
