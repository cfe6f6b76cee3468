//! Whether a custom curve was met, and how near a table came to it.
//!
//! The error counts in relation to what the curve demands, so that a random set does not meet a
//! curve that hardly differs from 1. The bounds follow from the root mean square of the curve's
//! departure from 1, over the same rings as the error ([`TARGET_RING`] wide, to ν = 4).

use strew_core::table::Figures;

use super::{Bound, Figure, TARGET_RING, curve::mean_over_ring, figure::NU_MAX};
use crate::curve::Target;

/// The largest error allowed, over the curve's departure from 1; both are root mean squares.
const ERROR_SHARE: f64 = 0.1;
/// The least bound on the error: a smaller error cannot be distinguished from the speckle of the
/// point sets that are measured.
const SPECKLE: f64 = 0.02;
/// The largest error of a single ring, over the bound on the root mean square. (An error in one
/// ring of forty alone is 6.3 times the root mean square.)
const WORST_RATIO: f64 = 4.0;
/// A band of power 0 from ν = 0 has a bound of its own if it reaches at least to this ν.
const QUIET_END: f64 = 0.1;
/// The largest mean power in such a band. The bound on the error alone would let a low power pass.
const QUIET_POWER: f64 = 0.01;

/// Returns the bounds on a table that should follow `target`: on [`Figure::TargetRms`], on
/// [`Figure::TargetWorst`], and on [`Figure::QuietPower`] if the curve begins with a band of power
/// 0.
#[must_use]
pub fn bounds_of_curve(target: &Target) -> Vec<Bound> {
    let rings = (NU_MAX / TARGET_RING).round() as u32;
    let departures = (0..rings).map(|ring| {
        let departure = mean_over_ring(target, f64::from(ring) * TARGET_RING) - 1.0;
        departure * departure
    });
    let departure = (departures.sum::<f64>() / f64::from(rings)).sqrt();
    // Two digits are as much as it means, and the same on every machine.
    let round = |value: f64| format!("{value:.1e}").parse().unwrap_or(value);
    let limit: f64 = round(SPECKLE.max(ERROR_SHARE * departure));
    let mut bounds = vec![
        Bound::at_most(Figure::TargetRms, limit),
        Bound::at_most(Figure::TargetWorst, round(WORST_RATIO * limit)),
    ];
    if target.quiet_end().is_some_and(|end| end >= QUIET_END) {
        bounds.push(Bound::at_most(Figure::QuietPower, QUIET_POWER));
    }
    bounds
}

/// The distance of a table from its curve: the largest errors on unseen point sets.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearness {
    /// Root mean square over rings of the radial power's error.
    pub rms: f64,
    /// The largest error of a ring.
    pub worst: f64,
    /// The frequency of the ring with the largest error.
    pub worst_nu: f64,
}

impl Nearness {
    /// Returns the largest unseen errors in `figures`, or `None` if none are compared with a curve.
    #[must_use]
    pub fn of(figures: &[Figures]) -> Option<Self> {
        let unseen = figures.iter().filter(|figures| !figures.seen);
        let each = unseen.filter_map(|figures| {
            let value = |figure: Figure| figures.value(figure.name());
            Some(Self {
                rms: value(Figure::TargetRms)?,
                worst: value(Figure::TargetWorst)?,
                worst_nu: value(Figure::TargetWorstNu)?,
            })
        });
        each.reduce(|a, b| {
            let rms = a.rms.max(b.rms);
            let worse = if b.worst > a.worst { b } else { a };
            Self { rms, ..worse }
        })
    }
}

impl std::fmt::Display for Nearness {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            rms,
            worst,
            worst_nu,
        } = self;
        write!(
            f,
            "the radial power is {rms} rms off the curve, at worst {worst} at nu {worst_nu:.2}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits(text: &str) -> Vec<f64> {
        let bounds = bounds_of_curve(&text.parse().expect("valid"));
        bounds.iter().map(|bound| bound.limit).collect()
    }

    /// The error of a random set.
    fn departure(text: &str) -> f64 {
        let target: Target = text.parse().expect("valid");
        let rings = (0..40).map(|ring| mean_over_ring(&target, f64::from(ring) * 0.1) - 1.0);
        (rings.map(|d| d * d).sum::<f64>() / 40.0).sqrt()
    }

    #[test]
    fn a_random_set_meets_no_curve_that_differs_from_1() {
        for curve in [
            "0 0\n0.56 0\n0.56 1",
            "0.1 1\n0.2 1.3\n0.4 1.3\n0.5 1",
            "0 1.1\n2 1.1\n2 1",
            "0.08 5\n0.7 1",
        ] {
            let limit = limits(curve);
            assert!(departure(curve) > 1.5 * limit[0], "{curve}: {limit:?}");
            assert!(limit[1] > limit[0] && limit[1] < 6.0 * limit[0]);
        }
        assert_eq!(limits("0 1"), [0.02, 0.08]);
        assert_eq!(limits("0 0\n0.56 0\n0.56 1").last(), Some(&0.01));
    }

    #[test]
    fn the_largest_errors_of_unseen_sets_count() {
        let of = |seen, rms, worst, nu| Figures {
            seen,
            values: [
                (Figure::TargetRms, rms),
                (Figure::TargetWorst, worst),
                (Figure::TargetWorstNu, nu),
            ]
            .map(|(figure, value)| (figure.name().into(), value))
            .into(),
            ..Figures::default()
        };
        let figures = [
            of(true, 9.0, 9.0, 1.0),
            of(false, 0.03, 0.1, 0.4),
            of(false, 0.01, 0.2, 0.61),
        ];
        let found = Nearness::of(&figures).expect("measured");
        assert_eq!((found.rms, found.worst, found.worst_nu), (0.03, 0.2, 0.61));
        assert_eq!(
            found.to_string(),
            "the radial power is 0.03 rms off the curve, at worst 0.2 at nu 0.61"
        );
        assert_eq!(Nearness::of(&figures[..1]), None);
        assert_eq!(Nearness::of(&[Figures::default()]), None);
    }
}
