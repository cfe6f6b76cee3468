//! Acceptance: a table is judged on point sets it was not optimized on.
//!
//! A table can look perfect on the twins it was made on and hide pairs of blocks that meet only
//! elsewhere. So it is measured on larger twins, on both sides of α, and on windows cut from the
//! unbounded pattern of α itself.

use strew_core::{Map, Table, Twin, table::Figures};

use super::{
    curve_figures,
    figure::{NU_MAX, figures_of_torus, figures_of_window},
};
use crate::{
    curve::Target,
    measure::{Spectrum, twin_set, window_set},
    twins::{LARGE_TWIN, farthest, next_to_alpha},
    watch::Meter,
};

/// The least number of points of a twin that a table is judged on.
pub const JUDGED_POINTS: u64 = 50_000;
/// How many points a window has, about.
const WINDOW_POINTS: u64 = 80_000;
/// Where the windows are: any places will do.
const WINDOW_SEEDS: [u64; 2] = [1, 2];
/// unless this many modes along an axis end before: they need about 120 MB.
const MODES_MAX: f64 = 1300.0;

/// The point sets a table is judged on.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    seen: Vec<Twin>,
    unseen: Vec<Twin>,
    target: Option<Target>,
}

impl Panel {
    /// For a table of `map` that was optimized on the twins `seen`: the smallest of those, to
    /// compare with, the first unseen twins of at least 50,000, 100,000 and 200,000 points, and
    /// two windows.
    #[must_use]
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
            seen: seen
                .iter()
                .copied()
                .min_by_key(|t| t.points())
                .into_iter()
                .collect(),
            unseen,
            target: None,
        }
    }

    /// Compares the radial power with a curve besides, on twins of enough points for it, and on
    /// those of `map` farthest from its α, where a curve is missed first.
    #[must_use]
    pub fn with_target(mut self, target: Target, map: &Map) -> Self {
        self.target = Some(target);
        self.unseen.retain(|twin| twin.points() >= LARGE_TWIN);
        for twin in farthest(map).into_iter().flatten() {
            if !self.unseen.contains(&twin) && !self.seen.contains(&twin) {
                self.unseen.push(twin);
            }
        }
        self
    }

    fn compared(&self, mut figures: Figures, spectrum: impl FnOnce() -> Spectrum) -> Figures {
        if let Some(target) = &self.target {
            figures.values.extend(curve_figures(&spectrum(), target));
        }
        figures
    }

    /// How many point sets will be measured.
    #[must_use]
    pub fn subjects(&self) -> u32 {
        (self.seen.len() + self.unseen.len() + WINDOW_SEEDS.len()) as u32
    }

    /// How many points they have in all, about.
    #[must_use]
    pub fn points(&self) -> u64 {
        let twins = self
            .seen
            .iter()
            .chain(&self.unseen)
            .map(|twin| twin.points());
        twins.sum::<u64>() + WINDOW_POINTS * WINDOW_SEEDS.len() as u64
    }

    /// Measures all of them, or `None` if the watch stops it.
    pub fn measure(&self, table: &Table, meter: &mut Meter<'_>) -> Option<Vec<Figures>> {
        let mut all = Vec::new();
        let twins = self.seen.iter().map(|twin| (twin, true));
        for (twin, seen) in twins.chain(self.unseen.iter().map(|twin| (twin, false))) {
            if meter.stop() {
                return None;
            }
            if let Some(set) = twin_set(table, *twin) {
                let nu_max = NU_MAX.min(MODES_MAX / set.side());
                let figures = figures_of_torus(format!("twin {twin}"), seen, &set, nu_max);
                all.push(self.compared(figures, || Spectrum::of_torus(&set, nu_max)));
            }
            meter.advance(None);
        }
        for seed in WINDOW_SEEDS {
            if meter.stop() {
                return None;
            }
            let set = window_set(table, WINDOW_POINTS, seed);
            let figures = figures_of_window(format!("window seed {seed}"), false, &set, NU_MAX);
            all.push(self.compared(figures, || Spectrum::of_window(&set, NU_MAX)));
            meter.advance(None);
        }
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_is_unseen_and_large() {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 49).expect("valid");
        let first = Panel::new(&map, &[]).unseen[0];
        let seen = [map.twins().next().expect("valid"), first];
        let panel = Panel::new(&map, &seen);
        assert_eq!(panel.seen, [seen[0]]);
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
