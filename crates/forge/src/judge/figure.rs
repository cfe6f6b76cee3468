//! Named figures of point sets, bounds on them, and the complaints about figures that miss them.

use std::fmt;

use strew_core::table::Figures;

use crate::measure::{Crispness, Distances, Sample, Spectrum, Voronoi};

/// The width in ν of the rings that radial figures are taken over. It is as fine as the smallest
/// twin of the default map resolves, and the same for sets of all sizes, so that their peaks
/// compare.
pub const RING_WIDTH: f64 = 1.0 / 64.0;

/// The largest frequency measured.
pub(super) const NU_MAX: f64 = 4.0;

/// Figures with their names and what they are.
macro_rules! figures {
    ($($name:literal $figure:ident $what:literal)*) => {
        /// A figure measured on a point set. Frequencies ν are in units of √N; white noise has power 1.
        /// Distances are over the nearest-neighbor distance of the hexagonal lattice, areas over the mean.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Figure {
            $(#[doc = $what] $figure,)*
        }

        impl Figure {
            /// The name in table files and messages.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$figure => $name,)*
                }
            }
        }
    };
}

figures! {
    "quiet_power" QuietPower "Mean power over the band from ν = 0 where the target is 0, up to 0.9 of its width."
    "target_rms" TargetRms "Root mean square over rings of the radial power's error against the target."
    "target_relative_rms" TargetRelative "Root mean square of the relative error, over rings between the ends of the curve."
    "target_worst" TargetWorst "The largest error of a ring."
    "target_worst_nu" TargetWorstNu "The frequency of the ring with the largest error."
    "tail_worst" TailWorst "The largest difference from 1 of a ring beyond the end of the curve."
    "low_power" LowPower "Mean power over 0 < ν < 0.5."
    "peak_power" PeakPower "The largest radial power."
    "peak_nu" PeakNu "The frequency of the largest radial power."
    "anisotropy_db" Anisotropy "Median anisotropy over 0.8 < ν < 4, in dB."
    "tallest_peak" Tallest "The largest power of a single mode."
    "delta_min" DeltaMin "The smallest nearest-neighbor distance (see [`Distances`])."
    "delta_avg" DeltaAvg "The mean nearest-neighbor distance (see [`Distances`])."
    "nu_eff" NuEff "The effective Nyquist frequency ν_eff after Heck et al. (see [`Crispness`])."
    "omega" Omega "The oscillation Ω after Heck et al. (see [`Crispness`])."
    "area_deviation" AreaDeviation "The largest deviation of a Voronoi cell's area (see [`Voronoi`])."
    "largest_hole" LargestHole "The radius of the largest empty circle (see [`Voronoi`])."
    "q6" Q6 "Bond-orientational order (see [`Voronoi`])."
    "share_error" ShareError "The error of the share of a kind, up or down."
    "peak_frequency" PeakFrequency "In space: the frequency of the largest mean power of a shell."
    "anisotropy" ShellAnisotropy "In space: the median anisotropy of shells beyond 0.8, in dB."
    "mean_distance" MeanDistance "In space: the mean nearest-neighbor distance over that of the densest packing."
    "local_deviation" LocalDeviation "In space: the deviation of power over directions in small windows, divided by its mean."
    "local_largest" LocalLargest "In space: the largest power of a frequency in small windows."
}

/// Rounds to four significant decimal digits.
pub(super) fn round(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(0.0)
}

/// Figures under their names, rounded.
pub(crate) fn named(values: impl IntoIterator<Item = (Figure, f64)>) -> Vec<(String, f64)> {
    let values = values.into_iter();
    values
        .map(|(figure, value)| (figure.name().to_owned(), round(value)))
        .collect()
}

/// All figures of a set and its spectrum, radial ones over rings of width `ring_width`; `seen` says whether the table
/// was optimized on it.
///
/// They are rounded to four significant digits: far more than they mean, and few enough to hide
/// another order of a sum inside an FFT.
pub fn figures(
    subject: String,
    seen: bool,
    set: &Sample,
    spectrum: &Spectrum,
    ring_width: f64,
) -> Figures {
    let ring_width = ring_width.max(spectrum.finest_ring());
    let summary = spectrum.summary(ring_width);
    let crispness = Crispness::of_rings(&spectrum.rings(ring_width), ring_width);
    let (distances, cells) = (Distances::of(set), Voronoi::of(set));
    let values = [
        (Figure::LowPower, summary.low_power),
        (Figure::PeakPower, summary.peak_power),
        (Figure::PeakNu, summary.peak_nu),
        (Figure::Anisotropy, summary.anisotropy_db),
        (Figure::Tallest, summary.tallest),
        (Figure::DeltaMin, distances.delta_min),
        (Figure::DeltaAvg, distances.delta_avg),
        (Figure::NuEff, crispness.nu_eff),
        (Figure::Omega, crispness.omega),
        (Figure::AreaDeviation, cells.area_deviation),
        (Figure::LargestHole, cells.largest_hole),
        (Figure::Q6, cells.q6),
    ];
    Figures {
        subject,
        seen,
        points: set.points().len() as u64,
        values: named(values),
    }
}

/// A limit on a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    pub figure: Figure,
    /// The side of the limit on which the figure must stay.
    pub side: Side,
    /// The limit, which is itself allowed.
    pub limit: f64,
}

/// A side of a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    AtMost,
    AtLeast,
}

impl Bound {
    /// The bound `figure` ≤ `limit`.
    pub const fn at_most(figure: Figure, limit: f64) -> Self {
        Self {
            figure,
            side: Side::AtMost,
            limit,
        }
    }

    /// The bound `figure` ≥ `limit`.
    pub const fn at_least(figure: Figure, limit: f64) -> Self {
        Self {
            figure,
            side: Side::AtLeast,
            limit,
        }
    }

    /// Returns a complaint if these figures miss the bound or lack the figure.
    pub fn check(&self, figures: &Figures) -> Option<Complaint> {
        let value = figures.value(self.figure.name()).unwrap_or(f64::NAN);
        let holds = match self.side {
            Side::AtMost => value <= self.limit,
            Side::AtLeast => value >= self.limit,
        };
        (!holds).then(|| Complaint {
            subject: figures.subject.clone(),
            bound: *self,
            value,
        })
    }
}

/// A figure that missed its bound.
#[derive(Clone, Debug, PartialEq)]
pub struct Complaint {
    pub subject: String,
    pub bound: Bound,
    /// The measured value; NaN if the figure is missing.
    pub value: f64,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AtMost => "at most",
            Self::AtLeast => "at least",
        })
    }
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Bound {
            figure,
            side,
            limit,
        } = self.bound;
        let (name, subject, value) = (figure.name(), &self.subject, self.value);
        write!(
            f,
            "{name} on {subject} is {value}; it must be {side} {limit}"
        )
    }
}

/// Returns the complaints about a table, given its figures. Only figures of unseen point sets
/// count; without any, every bound is missed.
pub fn complaints(bounds: &[Bound], figures: &[Figures]) -> Vec<Complaint> {
    let nothing = Figures {
        subject: "no unseen subject".into(),
        ..Figures::default()
    };
    let mut judged: Vec<&Figures> = figures.iter().filter(|f| !f.seen).collect();
    if judged.is_empty() {
        judged.push(&nothing);
    }
    let all = |figures| bounds.iter().filter_map(move |bound| bound.check(figures));
    judged.into_iter().flat_map(all).collect()
}

/// The gravest complaint about each figure, in words.
pub fn gravest(complaints: &[Complaint]) -> Vec<String> {
    let excess = |c: &Complaint| (c.value - c.bound.limit).abs();
    let mut said: Vec<(&Complaint, usize)> = Vec::new();
    for complaint in complaints {
        let same = |(known, _): &&mut (&Complaint, usize)| known.bound == complaint.bound;
        match said.iter_mut().find(same) {
            None => said.push((complaint, 1)),
            Some((known, count)) => {
                *count += 1;
                if excess(complaint) > excess(known) || complaint.value.is_nan() {
                    *known = complaint;
                }
            }
        }
    }
    let words = |(complaint, count): (&Complaint, usize)| match count {
        1 => complaint.to_string(),
        _ => format!("{complaint} (missed on {count} point sets)"),
    };
    said.into_iter().map(words).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_four_digits() {
        assert_eq!(round(0.123_456), 0.1235);
        assert_eq!(round(5.555_55e-6), 5.556e-6);
        assert_eq!(round(0.0), 0.0);
        assert_eq!(round(-12.345_6), -12.35);
    }

    #[test]
    fn a_complaint_names_figure_subject_value_and_limit() {
        let figures = Figures {
            subject: "twin 683/418".into(),
            seen: false,
            points: 70_225,
            values: vec![("low_power".into(), 3e-5), ("delta_min".into(), 0.62)],
        };
        let said = |bound: Bound| bound.check(&figures).map(|complaint| complaint.to_string());
        assert_eq!(said(Bound::at_least(Figure::DeltaMin, 0.62)), None);
        assert_eq!(said(Bound::at_most(Figure::LowPower, 3e-5)), None);
        let low = said(Bound::at_most(Figure::LowPower, 2e-5));
        let expected = "low_power on twin 683/418 is 0.00003; it must be at most 0.00002";
        assert_eq!(low.as_deref(), Some(expected));
        // A missing figure misses its bound.
        assert!(said(Bound::at_most(Figure::PeakPower, 9.0)).is_some());
    }

    #[test]
    fn without_unseen_figures_every_bound_is_missed() {
        let bounds = [Bound::at_most(Figure::LowPower, 1.0)];
        assert_eq!(complaints(&bounds, &[]).len(), 1);
        let seen = Figures {
            seen: true,
            values: vec![("low_power".into(), 0.0)],
            ..Figures::default()
        };
        assert_eq!(complaints(&bounds, std::slice::from_ref(&seen)).len(), 1);
        let unseen = Figures {
            seen: false,
            ..seen
        };
        assert!(complaints(&bounds, &[unseen]).is_empty());
    }
}
