//! Judging a mix: all points and each kind, whole and thinned, on twins that it was not made with and on windows
//! as they are served, with a seed and its warp.

use strew_core::{PointSet, Region, Table, Twin, table::Figures};

use crate::{
    judge::{Bound, Complaint, Figure, round},
    measure::{Distances, Sample, Spectrum, Summary},
    thinned::ThinnedTwin,
    twins::nearest,
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
    let twins = LARGEST
        .iter()
        .filter_map(|&most| nearest(table.map(), most));
    let mut twins: Vec<Twin> = twins.collect();
    twins.dedup();
    let places: Vec<Place> = twins
        .into_iter()
        .map(Place::Twin)
        .chain(SEEDS.map(Place::Window))
        .collect();
    let shares = places.iter().map(|place| 1 + place.shares().len());
    let mut meter = Meter::new(watch, Stage::Measuring, shares.sum::<usize>() as u32);
    let (mut figures, mut complaints) = (Vec::new(), Vec::new());
    for place in places {
        let sets = place.sets(table)?;
        let before = match of {
            Some(of) => Some(summary(&place.sets(of)?.all(1.0)?, NU).anisotropy_db),
            None => None,
        };
        for &share in [1.0].iter().chain(place.shares()) {
            if meter.stop() {
                return None;
            }
            for subject in subjects(table, &sets, share)? {
                let measured = subject.measure(place, share);
                let bounds = subject.bounds(table, share, before);
                complaints.extend(bounds.iter().filter_map(|bound| bound.check(&measured)));
                figures.push(measured);
            }
            meter.advance(None);
        }
    }
    Some((figures, complaints))
}

/// The subjects on which a table is measured.
#[derive(Clone, Copy)]
enum Place {
    Twin(Twin),
    /// A window, by its seed.
    Window(u64),
}

/// The sets of a table at a place.
enum Sets {
    Twin(ThinnedTwin),
    Window(Box<PointSet>),
}

impl Place {
    /// The shares at which the place is judged, besides 1.
    const fn shares(&self) -> &'static [f64] {
        match self {
            Self::Twin(_) => &SHARES,
            Self::Window(_) => &SHARES_OF_WINDOWS,
        }
    }

    fn sets(self, table: &Table) -> Option<Sets> {
        Some(match self {
            Self::Twin(twin) => Sets::Twin(ThinnedTwin::new(table, twin)?),
            Self::Window(seed) => Sets::Window(PointSet::new(table.clone()).seed(seed).into()),
        })
    }
}

impl Sets {
    /// All points at a share.
    fn all(&self, share: f64) -> Option<Sample> {
        match self {
            Self::Twin(twin) => Some(twin.at(share)),
            Self::Window(set) => window(set, share, 1.0),
        }
    }

    /// The points of a kind at a share. The kind has a part of all points.
    fn of_kind(&self, share: f64, kind: u8, part: f64) -> Option<Sample> {
        match self {
            Self::Twin(twin) => Some(twin.of_kind(share, kind)),
            Self::Window(set) => window(&PointSet::clone(set).only(kind).ok()?, share, part),
        }
    }
}

/// A window of a set of which a part of all points is at a share, away from the origin.
fn window(set: &PointSet, share: f64, part: f64) -> Option<Sample> {
    let side = (POINTS / share).sqrt();
    let corner = [12_345.0, -6_789.0];
    let region = Region::new(corner, corner.map(|v| v + side)).ok()?;
    let points = set.clone().keep(share).ok()?.within(region).ok()?.to_vec();
    let points = points.iter().map(|p| [p.x - corner[0], p.y - corner[1]]);
    Some(Sample::window(side, share * part, points.collect()))
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
fn subjects(table: &Table, sets: &Sets, share: f64) -> Option<Vec<Subject>> {
    let all = sets.all(share)?;
    let count = all.points().len() as f64;
    let mut subjects = Vec::new();
    if let Some(mix) = table.mix() {
        for kind in 0..mix.shares().kinds() as u8 {
            let wanted = mix.shares().of(kind);
            let set = sets.of_kind(share, kind, wanted)?;
            subjects.push(Subject {
                kind: Some(kind),
                found: set.points().len() as f64 / count,
                wanted,
                set,
            });
        }
    }
    subjects.push(Subject {
        kind: None,
        set: all,
        found: 1.0,
        wanted: 1.0,
    });
    Some(subjects)
}

impl Subject {
    fn measure(&self, place: Place, share: f64) -> Figures {
        let place = match place {
            Place::Twin(twin) => format!("twin {twin}"),
            Place::Window(seed) => format!("window seed {seed}"),
        };
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
        let values = values.into_iter();
        Figures {
            subject: format!("{place}, {what}{kept}"),
            seen: false,
            points: self.set.points().len() as u64,
            values: values.map(|(f, v)| (f.name().into(), round(v))).collect(),
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
