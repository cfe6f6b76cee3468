//! The error of a radial power spectrum against its target.
//!
//! Each ring compares the mean power of its modes with the mean of the target over its area.
//! Rings narrower than [`TARGET_RING`] would show the speckle of one point set, not its noise.

use super::{Figure, figure::round};
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
#[must_use]
pub fn curve_figures(spectrum: &Spectrum, target: &Target) -> Vec<(String, f64)> {
    let rings = spectrum.rings(TARGET_RING);
    let errors: Vec<RingError> = rings
        .iter()
        .map(|ring| RingError::of(ring, target))
        .collect();
    let first = target.points().first().map_or(0.0, |p| p[0]);
    let drawn = |error: &&RingError| {
        error.from >= first && error.from < target.end() - 1e-9 && error.wanted > 0.0
    };
    let worst = errors
        .iter()
        .max_by(|a, b| a.error().abs().total_cmp(&b.error().abs()));
    let tail = errors
        .iter()
        .filter(|error| error.from >= target.end() + TAIL_GAP - 1e-9);
    let mut figures = vec![
        (Figure::TargetRms, rms(errors.iter().map(RingError::error))),
        (
            Figure::TargetRelative,
            rms(errors.iter().filter(drawn).map(|e| e.error() / e.wanted)),
        ),
        (
            Figure::TargetWorst,
            worst.map_or(f64::NAN, |e| e.error().abs()),
        ),
        (Figure::TargetWorstNu, worst.map_or(f64::NAN, |e| e.nu)),
        (
            Figure::TailWorst,
            tail.map(|e| (e.found - 1.0).abs()).fold(0.0, f64::max),
        ),
    ];
    if let Some(power) = quiet_power(spectrum, target) {
        figures.push((Figure::QuietPower, power));
    }
    figures
        .into_iter()
        .map(|(figure, value)| (figure.name().to_owned(), round(value)))
        .collect()
}

/// The power of a ring beside that of the target.
struct RingError {
    /// The inner edge of the ring.
    from: f64,
    /// The mean frequency of its modes.
    nu: f64,
    found: f64,
    wanted: f64,
}

impl RingError {
    fn of(ring: &Ring, target: &Target) -> Self {
        let from = (ring.nu / TARGET_RING).floor() * TARGET_RING;
        Self {
            from,
            nu: ring.nu,
            found: ring.power,
            wanted: mean_over_ring(target, from),
        }
    }

    fn error(&self) -> f64 {
        self.found - self.wanted
    }
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
