//! The panel: the point sets that a table is judged on.

use strew_core::{Map, Table, Twin, table::Figures};

use super::{
    curve_figures,
    figure::{NU_MAX, RING_WIDTH, figures},
};
use crate::{
    curve::Target,
    measure::{Sample, Spectrum, twin_set, window_set},
    twins::{LARGE_TWIN, farthest, next_to_alpha},
    watch::Meter,
};

/// The least number of points of an unseen twin.
pub const JUDGED_POINTS: u64 = 50_000;
/// The approximate number of points of a window.
const WINDOW_POINTS: u64 = 80_000;
/// The seeds of the windows' places, chosen arbitrarily.
const WINDOW_SEEDS: [u64; 2] = [1, 2];
/// The largest number of modes along an axis of a twin's spectrum, which needs about 120 MB.
const MAX_MODES: f64 = 1300.0;

/// The point sets that a table is judged on: some twins and two windows.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Twins that the table was optimized on: at most one.
    seen: Option<Twin>,
    /// Twins that it was not optimized on.
    unseen: Vec<Twin>,
    /// The curve that the radial power is compared with.
    target: Option<Target>,
}

impl Panel {
    /// The panel for a table of `map` that was optimized on the twins `seen`: the smallest of these
    /// for comparison, the first unseen twins of at least 50,000, 100,000 and 200,000 points, and
    /// two windows.
    pub fn new(map: &Map, seen: &[Twin]) -> Self {
        let mut unseen: Vec<Twin> = Vec::new();
        for factor in [1, 2, 4] {
            let next = next_to_alpha(map).find(|twin| {
                twin.points() >= factor * JUDGED_POINTS
                    && !seen.contains(twin)
                    && !unseen.contains(twin)
            });
            unseen.extend(next);
        }
        Self {
            seen: seen.iter().copied().min_by_key(|twin| twin.points()),
            unseen,
            target: None,
        }
    }

    /// Returns this panel with a curve to compare the radial power with. Unseen twins too small for
    /// the comparison are dropped, and those twins of `map` farthest from its α are added, where a
    /// curve is missed first.
    pub fn with_target(mut self, target: Target, map: &Map) -> Self {
        self.target = Some(target);
        self.unseen.retain(|twin| twin.points() >= LARGE_TWIN);
        for twin in farthest(map).into_iter().flatten() {
            if !self.unseen.contains(&twin) && self.seen != Some(twin) {
                self.unseen.push(twin);
            }
        }
        self
    }

    /// The figures of a set, and those of the curve, if there is one.
    fn figures(&self, subject: String, seen: bool, set: &Sample, nu_max: f64) -> Figures {
        let spectrum = Spectrum::of(set, nu_max);
        let mut figures = figures(subject, seen, set, &spectrum, RING_WIDTH);
        if let Some(target) = &self.target {
            figures.values.extend(curve_figures(&spectrum, target));
        }
        figures
    }

    /// The number of point sets.
    pub fn subjects(&self) -> u32 {
        (self.seen.iter().count() + self.unseen.len() + WINDOW_SEEDS.len()) as u32
    }

    /// The approximate number of points in all sets.
    pub fn points(&self) -> u64 {
        let twins = self.seen.iter().chain(&self.unseen);
        let points: u64 = twins.map(|twin| twin.points()).sum();
        points + WINDOW_POINTS * WINDOW_SEEDS.len() as u64
    }

    /// Measures `table` on all point sets, or returns `None` if the watch stops it.
    pub fn measure(&self, table: &Table, meter: &mut Meter<'_>) -> Option<Vec<Figures>> {
        let twins = self.seen.iter().map(|twin| (twin, true));
        let twins = twins.chain(self.unseen.iter().map(|twin| (twin, false)));
        let twin = |(twin, seen): (&Twin, bool)| {
            let set = twin_set(table, *twin)?;
            let nu_max = NU_MAX.min(MAX_MODES / set.side());
            Some(self.figures(format!("twin {twin}"), seen, &set, nu_max))
        };
        let window = |seed: u64| {
            let set = window_set(table, WINDOW_POINTS, seed);
            Some(self.figures(format!("window seed {seed}"), false, &set, NU_MAX))
        };
        let mut all = measured(twins, meter, twin)?;
        all.extend(measured(WINDOW_SEEDS, meter, window)?);
        Some(all)
    }
}

/// Measures subjects one by one, a step of the meter each, or returns `None` if the watch stops it.
pub(crate) fn measured<T>(
    subjects: impl IntoIterator<Item = T>,
    meter: &mut Meter<'_>,
    mut measure: impl FnMut(T) -> Option<Figures>,
) -> Option<Vec<Figures>> {
    let mut all = Vec::new();
    for subject in subjects {
        if meter.stop() {
            return None;
        }
        all.extend(measure(subject));
        meter.advance(None);
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unseen_twins_are_unseen_and_large() {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 49).expect("valid");
        let first = Panel::new(&map, &[]).unseen[0];
        let seen = [map.twins().next().expect("valid"), first];
        let panel = Panel::new(&map, &seen);
        assert_eq!(panel.seen, Some(seen[0]));
        assert_eq!(panel.unseen.len(), 3);
        assert!(
            panel
                .unseen
                .iter()
                .all(|t| t.points() >= JUDGED_POINTS && !seen.contains(t))
        );
        assert_eq!(panel.subjects(), 6);
    }
}
