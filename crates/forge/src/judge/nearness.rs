//! Whether a curve that somebody drew was met.
//!
//! What counts is the error against what the curve asks for: a curve that hardly differs from a
//! random set's is not met by a random set. So the bounds follow from the curve's own departure
//! from 1, taken over the same rings as the error ([`TARGET_RING`] wide, to ν = 4).

use strew_core::table::Figures;

use super::{Bound, Figure, TARGET_RING, curve::mean_over_ring, figure::NU_MAX};
use crate::curve::Target;

/// The error may be this part of the curve's departure from 1, as roots of mean squares.
const PART: f64 = 0.1;
/// No error below this can be told from the speckle of the sets that are measured.
const SPECKLE: f64 = 0.02;
/// A single ring may be this many times as far off as the root of the mean square. (One ring of
/// forty alone cannot be more than 6.3 times off.)
const PEAK: f64 = 4.0;
/// Where the curve is 0 from the start, up to this ν at least,
const QUIET_END: f64 = 0.1;
/// the mean power may be this much: a band that should be silent is not met by a low murmur, which
/// the error alone would let pass.
const QUIET_POWER: f64 = 0.01;

/// The bounds on a table that should follow `target`: [`Figure::TargetRms`],
/// [`Figure::TargetWorst`], and [`Figure::QuietPower`] if it begins with a silent band.
#[must_use]
pub fn bounds_of_curve(target: &Target) -> Vec<Bound> {
    let rings = (NU_MAX / TARGET_RING).round() as u32;
    let departures = (0..rings).map(|ring| {
        let departure = mean_over_ring(target, f64::from(ring) * TARGET_RING) - 1.0;
        departure * departure
    });
    let departure = (departures.sum::<f64>() / f64::from(rings)).sqrt();
    // Two digits say as much as it means, and are the same on every machine.
    let round = |value: f64| format!("{value:.1e}").parse().unwrap_or(value);
    let limit: f64 = round(SPECKLE.max(PART * departure));
    let mut bounds = vec![
        Bound::at_most(Figure::TargetRms, limit),
        Bound::at_most(Figure::TargetWorst, round(PEAK * limit)),
    ];
    if target.quiet_end().is_some_and(|end| end >= QUIET_END) {
        bounds.push(Bound::at_most(Figure::QuietPower, QUIET_POWER));
    }
    bounds
}

/// How near a table came to a curve: the largest errors among the subjects it had not seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearness {
    /// The root of the mean squared error of the radial power.
    pub rms: f64,
    /// The largest error of a ring,
    pub worst: f64,
    /// and the frequency where that ring is.
    pub worst_nu: f64,
}

impl Nearness {
    /// From measured figures; `None` if none of them compares with a curve.
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

    /// What a random set is off.
    fn departure(text: &str) -> f64 {
        let target: Target = text.parse().expect("valid");
        let rings = (0..40).map(|ring| mean_over_ring(&target, f64::from(ring) * 0.1) - 1.0);
        (rings.map(|d| d * d).sum::<f64>() / 40.0).sqrt()
    }

    #[test]
    fn a_random_set_meets_no_curve_that_can_be_told_from_its_own() {
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
    fn the_largest_errors_of_unseen_subjects_count() {
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
