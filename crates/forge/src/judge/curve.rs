//! The error of a radial power spectrum against its target, and whether a custom curve was met.
//!
//! Each ring compares the mean power of its modes with the mean of the target over its area.
//! Rings narrower than [`TARGET_RING`] would show the speckle of one point set, not its noise.
//!
//! For a custom curve the error counts in relation to what the curve demands, so that a random set does
//! not meet a curve that hardly differs from 1. The bounds follow from the root mean square of the curve's
//! departure from 1, over the same rings as the error ([`TARGET_RING`] wide, to ν = 4).

use strew_core::table::Figures;

use super::{
    Bound, Figure,
    figure::{NU_MAX, named},
};
use crate::{
    curve::Target,
    measure::{Ring, Spectrum},
};

/// The width of the rings, in ν.
pub const TARGET_RING: f64 = 0.1;
/// The gap in ν between the end of a curve and the rings that are compared with 1.
const TAIL_GAP: f64 = 0.1;
/// The part of a quiet band that [`Figure::QuietPower`] covers, without its blurred edge.
const QUIET_PART: f64 = 0.9;
/// The width in ν of the rings that the power of a quiet band is averaged over.
const FINE_RING: f64 = 0.005;

/// Returns the figures (name, value) of a spectrum that should follow `target`:
/// [`Figure::TargetRms`], [`Figure::TargetRelative`], [`Figure::TargetWorst`],
/// [`Figure::TargetWorstNu`], [`Figure::TailWorst`], and [`Figure::QuietPower`] if the target
/// begins with a band of power 0.
pub fn curve_figures(spectrum: &Spectrum, target: &Target) -> Vec<(String, f64)> {
    // The inner edge of each ring, its mean frequency, the power of the target there, and the error.
    let compared = |ring: &Ring| {
        let from = (ring.nu / TARGET_RING).floor() * TARGET_RING;
        let wanted = mean_over_ring(target, from);
        [from, ring.nu, wanted, ring.power - wanted]
    };
    let rings = spectrum.rings(TARGET_RING);
    let errors: Vec<[f64; 4]> = rings.iter().map(compared).collect();
    let first = target.points().first().map_or(0.0, |p| p[0]);
    let drawn = errors.iter().filter(|[from, _, wanted, _]| {
        *from >= first && *from < target.end() - 1e-9 && *wanted > 0.0
    });
    let by_size = |a: &&[f64; 4], b: &&[f64; 4]| a[3].abs().total_cmp(&b[3].abs());
    let worst = errors.iter().max_by(by_size);
    let [worst, worst_nu] = worst.map_or([f64::NAN; 2], |e| [e[3].abs(), e[1]]);
    let tail = errors.iter();
    let tail = tail.filter(|[from, ..]| *from >= target.end() + TAIL_GAP - 1e-9);
    let tail = tail.map(|[_, _, wanted, error]| (wanted + error - 1.0).abs());
    let relative = drawn.map(|[_, _, wanted, error]| error / wanted);
    let mut figures = vec![
        (Figure::TargetRms, rms(errors.iter().map(|error| error[3]))),
        (Figure::TargetRelative, rms(relative)),
        (Figure::TargetWorst, worst),
        (Figure::TargetWorstNu, worst_nu),
        (Figure::TailWorst, tail.fold(0.0, f64::max)),
    ];
    if let Some(power) = quiet_power(spectrum, target) {
        figures.push((Figure::QuietPower, power));
    }
    named(figures)
}

/// The mean of a curve over the area of the ring that begins at `from`.
pub(super) fn mean_over_ring(target: &Target, from: f64) -> f64 {
    let steps = 200;
    let (mut sum, mut area) = (0.0, 0.0);
    for step in 0..steps {
        let nu = from + TARGET_RING * (f64::from(step) + 0.5) / f64::from(steps);
        sum += nu * target.at(nu);
        area += nu;
    }
    sum / area
}

fn rms(errors: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0u32);
    for error in errors {
        sum += error * error;
        count += 1;
    }
    (sum / f64::from(count.max(1))).sqrt()
}

/// Mean power over the area of the target's quiet band, if it has one.
fn quiet_power(spectrum: &Spectrum, target: &Target) -> Option<f64> {
    let end = QUIET_PART * target.quiet_end()?;
    let (mut sum, mut area) = (0.0, 0.0);
    for ring in spectrum.rings(FINE_RING).iter().filter(|r| r.nu < end) {
        sum += ring.nu * ring.power;
        area += ring.nu;
    }
    (area > 0.0).then(|| sum / area)
}

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
    pub worst: f64,
    /// The frequency of the ring with the largest error.
    pub worst_nu: f64,
}

impl Nearness {
    /// Returns the largest unseen errors in `figures`, or `None` if none are compared with a curve.
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
