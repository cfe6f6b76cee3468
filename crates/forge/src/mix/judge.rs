//! Judging a mix: all points and each kind, whole and thinned, on twins that it was not made with and on windows
//! as they are served, with a seed and its warp.

use strew_core::{PointSet, Table, Twin, table::Figures};

use super::press::each;
use crate::{
    judge::{Bound, Complaint, Figure, named},
    measure::ThinnedTwin,
    measure::{Distances, Sample, Spectrum, Summary, square_set},
    twins::{LARGE_TWIN, nearest, next_to_alpha},
    watch::{Meter, Stage, Watch},
};

/// The most points of the twins judged on. Labels are made by the frequencies of α itself, so that no twin was
/// seen.
const LARGEST: [u64; 2] = [100_000, 300_000];
/// The seeds of windows, and about how many points they have.
const SEEDS: [u64; 2] = [1, 2];
const POINTS: f64 = 60_000.0;
/// The width of the rings that spectra are taken over.
const RING: f64 = 0.04;
/// The greatest frequency looked at, of whole and of thinned sets.
const NU: f64 = 2.5;
const NU_THINNED: f64 = 0.6;
/// The shares at which twins and windows are judged, besides 1.
const SHARES: [f64; 7] = [0.9, 0.7, 0.5, 0.35, 0.25, 0.15, 0.1];
const SHARES_OF_WINDOWS: [f64; 2] = [0.6, 0.2];
/// The blocks of a kind from which bounds on thinned sets hold, and the number with which they double. With few,
/// low power grows as 1/blocks.
const BLOCKS: f64 = 100.0;
const DOUBLING: f64 = 25.0;
/// The greatest share of a kind whose low power must be below the bounds of all kinds.
const DENSE: f64 = 0.8;

/// The greatest mean power below ν = 0.5 of a kind by labels alone, in sets of some shares.
const LOW_BY_LABELS: [(&str, f64); 3] = [("1:1", 0.055), ("1:3", 0.09), ("1:1:2", 0.07)];
/// The greatest such power in sets of other shares.
const LOW_OTHERWISE: f64 = 0.1;
/// The greatest such power in joint tables, of a kind and of all points.
const LOW: f64 = 0.015;
const LOW_OF_ALL: f64 = 5e-4;
/// The least δ in joint tables, of a kind and of all points.
const DELTA: f64 = 0.57;
const DELTA_OF_ALL: f64 = 0.54;
/// The greatest radial power of a kind in joint tables: more is a crystal.
const PEAK: f64 = 4.5;
/// The excess of a joint table's anisotropy over that of the table it was made of, at most, in dB.
const ANISOTROPY: f64 = 0.5;
/// The greatest mean power below ν = 0.5 of a thinned kind and of all points of a thinned set.
const LOW_THINNED: f64 = 0.14;
const LOW_OF_ALL_THINNED: f64 = 0.16;
/// The greatest error of a kind's share in a thinned set.
const SHARE_ERROR: f64 = 0.005;

/// The figures and the bounds that they miss, or `None` if the watch stopped the work. `of` is the table whose
/// vectors were moved, if they were.
pub(super) fn judge(
    table: &Table,
    of: Option<&Table>,
    watch: &dyn Watch,
) -> Option<(Vec<Figures>, Vec<Complaint>)> {
    let all = places(table)?;
    let before: Vec<Option<f64>> = match of {
        Some(of) => {
            let anisotropy = |place: Place| {
                let set = (place.set)(1.0, None)?;
                Some(summary(&set, NU).anisotropy_db)
            };
            places(of)?.into_iter().map(anisotropy).collect()
        }
        None => vec![None; all.len()],
    };
    let shares = all.iter().map(|place| 1 + place.shares.len());
    let mut meter = Meter::new(watch, Stage::Measuring, shares.sum::<usize>() as u32);
    let (mut figures, mut complaints) = (Vec::new(), Vec::new());
    for (place, before) in all.iter().zip(before) {
        for &share in [1.0].iter().chain(place.shares) {
            if meter.stop() {
                return None;
            }
            for subject in subjects(table, place, share)? {
                let measured = subject.measure(&place.name, share);
                let bounds = subject.bounds(table, share, before);
                complaints.extend(bounds.iter().filter_map(|bound| bound.check(&measured)));
                figures.push(measured);
            }
            meter.advance(None);
        }
    }
    Some((figures, complaints))
}

/// A kind, and its part of all points.
type Kind = (u8, f64);

/// Where a table is measured.
struct Place {
    name: String,
    /// The shares at which it is judged, besides 1.
    shares: &'static [f64],
    /// The points of a kind, or all, at a share.
    set: Box<dyn Fn(f64, Option<Kind>) -> Option<Sample>>,
}

/// The twins and windows of a table.
fn places(table: &Table) -> Option<Vec<Place>> {
    let large = |most: u64| {
        let twins = next_to_alpha(table.map()).take_while(move |twin| twin.points() <= most);
        let large = twins.filter(|twin| twin.points() >= LARGE_TWIN);
        nearest(table.map(), large)
    };
    let mut twins: Vec<Twin> = LARGEST.into_iter().filter_map(large).collect();
    twins.dedup();
    let twin = |twin: Twin| {
        let points = ThinnedTwin::new(table, twin)?;
        Some(Place {
            name: format!("twin {twin}"),
            shares: &SHARES,
            set: Box::new(move |share, kind| Some(points.at(share, kind.map(|kind| kind.0)))),
        })
    };
    let window = |seed: u64| {
        let all = PointSet::new(table.clone()).seed(seed);
        Some(Place {
            name: format!("window seed {seed}"),
            shares: &SHARES_OF_WINDOWS,
            set: Box::new(move |share, kind| match kind {
                Some((kind, part)) => window(&all.clone().only(kind).ok()?, share, part),
                None => window(&all, share, 1.0),
            }),
        })
    };
    let twins = twins.into_iter().map(twin);
    twins.chain(SEEDS.into_iter().map(window)).collect()
}

/// A window of a set of which a part of all points is at a share, away from the origin.
fn window(set: &PointSet, share: f64, part: f64) -> Option<Sample> {
    let (set, side) = (set.clone().keep(share).ok()?, (POINTS / share).sqrt());
    square_set(&set, [12_345.0, -6_789.0], side, share * part).ok()
}

fn summary(set: &Sample, nu: f64) -> Summary {
    Spectrum::of(set, nu).summary(RING)
}

/// A set to judge: a kind, or all points.
struct Subject {
    kind: Option<u8>,
    set: Sample,
    /// The share of the kind that was found, and what it should be.
    found: f64,
    wanted: f64,
}

/// The kinds at a share, and all points.
fn subjects(table: &Table, place: &Place, share: f64) -> Option<Vec<Subject>> {
    let all = (place.set)(share, None)?.points().len() as f64;
    let parts = table.mix().map_or_else(Vec::new, |mix| each(mix.shares()));
    let kinds = (0..).zip(parts).map(Some);
    let subject = |kind: Option<Kind>| {
        let set = (place.set)(share, kind)?;
        Some(Subject {
            kind: kind.map(|(kind, _)| kind),
            found: set.points().len() as f64 / all,
            wanted: kind.map_or(1.0, |(_, part)| part),
            set,
        })
    };
    kinds.chain([None]).map(subject).collect()
}

impl Subject {
    fn measure(&self, place: &str, share: f64) -> Figures {
        let what = match self.kind {
            Some(kind) => format!("kind {kind}"),
            None => "all points".into(),
        };
        let is_whole = share == 1.0;
        let kept = if is_whole {
            String::new()
        } else {
            format!(", keep {share}")
        };
        let summary = summary(&self.set, if is_whole { NU } else { NU_THINNED });
        let mut values = vec![
            (Figure::LowPower, summary.low_power),
            (Figure::DeltaMin, Distances::of(&self.set).delta_min),
        ];
        if is_whole {
            values.push((Figure::PeakPower, summary.peak_power));
            values.push((Figure::Anisotropy, summary.anisotropy_db));
        }
        if self.kind.is_some() {
            values.push((Figure::ShareError, (self.found - self.wanted).abs()));
        }
        Figures {
            subject: format!("{place}, {what}{kept}"),
            seen: false,
            points: self.set.points().len() as u64,
            values: named(values),
        }
    }

    /// The bounds at a share, given the anisotropy of a joint table's original.
    fn bounds(&self, table: &Table, share: f64, before: Option<f64>) -> Vec<Bound> {
        let low = |limit| Bound::at_most(Figure::LowPower, limit);
        let mut bounds = Vec::new();
        if share < 1.0 {
            let blocks = table.displacements().len() as f64 * share * self.wanted;
            if blocks >= BLOCKS {
                let limit = if self.kind.is_some() {
                    LOW_THINNED
                } else {
                    LOW_OF_ALL_THINNED
                };
                bounds.push(low(limit * (1.0 + DOUBLING / blocks)));
            }
            if self.kind.is_some() {
                bounds.push(Bound::at_most(Figure::ShareError, SHARE_ERROR));
            }
            return bounds;
        }
        let shares = table.mix().map(|mix| mix.shares().to_string());
        match (before, self.kind) {
            (None, None) => {}
            (None, Some(_)) => {
                let known = LOW_BY_LABELS.iter();
                let known = known.filter(|(text, _)| shares.as_deref() == Some(text));
                let limit = known.map(|&(_, limit)| limit).next();
                bounds.push(low(limit.unwrap_or(LOW_OTHERWISE).max(self.least_low())));
            }
            (Some(before), kind) => {
                let (power, delta) = match kind {
                    Some(_) => (LOW.max(self.least_low()), DELTA),
                    None => (LOW_OF_ALL, DELTA_OF_ALL),
                };
                bounds.push(low(power));
                bounds.push(Bound::at_least(Figure::DeltaMin, delta));
                bounds.push(Bound::at_most(Figure::Anisotropy, before + ANISOTROPY));
                bounds.push(Bound::at_most(Figure::PeakPower, PEAK));
            }
        }
        bounds
    }

    /// About the least low power that a dense kind can have, and 0 for others. Where all points have no power,
    /// the power of the kind is that of the others times (1 − f)/f; and its own low band reaches
    /// beyond theirs, where they have power 1.
    fn least_low(&self) -> f64 {
        if self.kind.is_none() || self.wanted < DENSE {
            return 0.0;
        }
        let ratio = (1.0 - self.wanted) / self.wanted;
        1.2 * ratio * (1.0 - 4.0 * ratio / std::f64::consts::PI)
    }
}
