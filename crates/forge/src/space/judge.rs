//! Judging a table: its figures on a twin and on served windows, none of which it was made on, and their bounds.

use strew_core::{
    Error, Map, Twin,
    space::{SpaceSet, Table},
    table::Figures,
};

use super::measure::{LocalPower, SpacePower, is_uniform_in_space, twin_set, window_set};
use crate::{
    Figure, Meter,
    judge::{measured, named},
    measure::{Distances, Ring, Sample},
    twins::{nearest, next_to_alpha},
};

/// The side of a window, in mean spacings: some 314,000 points.
pub const SIDE: f64 = 68.0;
/// The number of places in which local power is measured.
pub const PLACES: u32 = 60;
/// The least corner of the windows, in mean spacings, chosen arbitrarily.
const AT: [f64; 3] = [100.0, -50.0, 20.0];
/// The seeds of the windows: the plain set and two others, chosen arbitrarily.
const SEEDS: [u64; 3] = [0, 1, 2];
/// The seed of the places of local power.
const PLACES_SEED: u64 = 12;

/// The figures and the spectrum of a set.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceReport {
    /// The named figures, rounded to four significant digits.
    pub figures: Figures,
    /// The power over shells of frequencies.
    pub shells: Vec<Ring>,
}

impl SpaceReport {
    /// Measures points, and local power if there is any.
    pub fn of(subject: String, points: &Sample<3>, local: Option<LocalPower>) -> Self {
        let SpacePower { summary, rings } = SpacePower::of(points);
        let distances = Distances::of(points);
        let local = local.map(|local| {
            [
                (Figure::LocalDeviation, local.deviation),
                (Figure::LocalLargest, local.largest),
            ]
        });
        let values = [
            (Figure::LowPower, summary.low_power),
            (Figure::PeakPower, summary.peak_power),
            (Figure::PeakFrequency, summary.peak_nu),
            (Figure::ShellAnisotropy, summary.anisotropy_db),
            (Figure::DeltaMin, distances.delta_min),
            (Figure::MeanDistance, distances.delta_avg),
        ];
        Self {
            figures: Figures {
                subject,
                seen: false,
                points: points.points().len() as u64,
                values: named(values.into_iter().chain(local.into_iter().flatten())),
            },
            shells: rings,
        }
    }

    /// Measures a cube of a set and local power, from a corner on, in mean spacings.
    pub fn of_window(
        set: &SpaceSet,
        at: [f64; 3],
        side: f64,
        places: u32,
        places_seed: u64,
    ) -> Result<Self, Error> {
        let points = window_set(set, at, side)?;
        let local = LocalPower::of(set, at, places, places_seed)?;
        let subject = format!("window seed {}", set.placement().seed.0);
        Ok(Self::of(subject, &points, Some(local)))
    }
}

/// The twins of a map that have enough points to be measured, nearest to α and smallest first, endless. A table is made on
/// none.
pub fn unseen_twins(map: &Map, least: u64) -> impl Iterator<Item = Twin> {
    next_to_alpha(map).filter(move |twin| twin.t().pow(3) >= least && is_uniform_in_space(*twin))
}

/// The points that a table is judged on, which grow with its map.
pub(super) struct Judge {
    twin: Option<Twin>,
    side: f64,
    places: u32,
}

/// The side of windows for a map: that of the default map is [`SIDE`].
fn side(map: &Map) -> f64 {
    (map.intervals() as f64 * (SIDE / 21.0)).min(SIDE)
}

impl Judge {
    pub(super) fn of(map: &Map) -> Self {
        let side = side(map);
        let volume = side * side * side;
        let [least, most] = [0.25, 1.2].map(|part| (part * volume) as u64);
        let all = unseen_twins(map, least).take_while(|twin| twin.t().pow(3) <= most);
        Self {
            // The pattern of a twin differs from that of α the more, the farther they are apart.
            twin: nearest(map, all),
            side,
            places: (map.intervals() as u32 * 3).min(PLACES),
        }
    }

    /// The number of point sets.
    pub(super) fn subjects(&self) -> u32 {
        SEEDS.len() as u32 + u32::from(self.twin.is_some())
    }

    /// About the number of their points.
    pub(super) fn points(&self) -> u64 {
        (self.side.powi(3) * (SEEDS.len() as f64 + 1.0)) as u64
    }

    /// The figures of all point sets, or `None` if the watch stops the work.
    pub(super) fn figures(&self, table: &Table, meter: &mut Meter<'_>) -> Option<Vec<Figures>> {
        let twin = |twin| {
            let points = twin_set(table, twin)?;
            Some(SpaceReport::of(format!("twin {twin}"), &points, None).figures)
        };
        let window = |seed| {
            let set = SpaceSet::new(table.clone()).seed(seed);
            let report = SpaceReport::of_window(&set, AT, self.side, self.places, PLACES_SEED);
            // Windows of this size are within range; one that were not would miss all bounds.
            Some(report.map(|report| report.figures).unwrap_or_default())
        };
        let mut all = measured(self.twin, meter, twin)?;
        all.extend(measured(SEEDS, meter, window)?);
        Some(all)
    }
}
