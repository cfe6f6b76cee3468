//! Recurrence: how much of a small patch of a set is found again elsewhere.
//!
//! A table has a limited number of neighborhoods, so a set shows each of them again and again. For a patch of
//! 12 × 12 mean spacings the best other place within a window is searched, over all translations: the share
//! of the patch's points that have a point there within 0.15 spacings. Some share is found by chance, also in
//! a set that is independent of the patch.

use rayon::prelude::*;

use super::Sample;
use crate::{cell_list::CellList, numeric::SplitMix};

/// The side of a patch, in mean spacings.
pub const PATCH: f64 = 12.0;
/// Points this near count as the same, in mean spacings.
pub const NEAR: f64 = 0.15;

/// Points of a patch that are laid upon points of the window to find translations.
const ANCHORS: usize = 6;
/// Cells of the raster per mean spacing.
const FINE: f64 = 16.0;
/// The radius of the disks in the raster, in mean spacings: two points that lie within [`NEAR`] of theirs
/// move each other by up to twice that, mostly less.
const LOOSE: f64 = 0.24;
/// The number of points around the middle of a patch that are compared first.
const FIRST: usize = 24;
/// The number of near ones among the first points from which the rest is compared. By chance 4 of 24 are near, and at
/// a place that matters 10 or more.
const FIRST_NEAR: usize = 8;
/// The number of translations that are refined.
const REFINED: usize = 24;
/// Places nearer to the patch than this, in mean spacings, are the patch itself.
const SELF: f64 = 2.0;

/// The mean share of a patch that is found again, over `patches` patches of `set` at places chosen by `seed`,
/// each at its best place in `other`. For a set against itself the place of the patch does not count.
///
/// Returns 0 for windows smaller than two patches.
pub fn recurrence(set: &Sample, other: Option<&Sample>, patches: usize, seed: u64) -> f64 {
    let room = set.side() - PATCH;
    if room < PATCH || patches == 0 {
        return 0.0;
    }
    let field = Field::new(other.unwrap_or(set));
    let corners = SplitMix::new(seed).places(patches, room);
    let shares = corners.into_par_iter().map(|corner: [f64; 2]| {
        let inside = |p: &&[f64; 2]| (0..2).all(|i| (0.0..PATCH).contains(&(p[i] - corner[i])));
        let mut patch: Vec<[f64; 2]> = set.points().iter().filter(inside).copied().collect();
        let center = corner.map(|v| v + PATCH / 2.0);
        // Near ones first: if these miss, the rest need not be looked at.
        patch.sort_by(|a, b| squared(*a, center).total_cmp(&squared(*b, center)));
        field.best(&patch, other.is_none())
    });
    shares.sum::<f64>() / patches as f64
}

fn squared(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}

/// A window, for looking up whether a point lies near a place.
struct Field<'a> {
    side: f64,
    points: &'a [[f64; 2]],
    /// Whether a cell lies within [`LOOSE`] of a point, by rows.
    raster: Vec<bool>,
    /// Cells along a side of the raster.
    cells: usize,
    list: CellList,
}

impl<'a> Field<'a> {
    fn new(window: &'a Sample) -> Self {
        let side = window.side();
        let cells = (side * FINE) as usize + 1;
        let mut raster = vec![false; cells * cells];
        let radius = (LOOSE * FINE).ceil() as i64;
        for &p in window.points() {
            let [x, y] = p.map(|v| (v * FINE) as i64);
            for j in y - radius..=y + radius {
                for i in x - radius..=x + radius {
                    let cell = [i, j].map(|v| (v as f64 + 0.5) / FINE);
                    let is_in = [i, j].iter().all(|v| (0..cells as i64).contains(v));
                    if is_in && squared(cell, p) <= LOOSE * LOOSE {
                        raster[j as usize * cells + i as usize] = true;
                    }
                }
            }
        }
        Self {
            side,
            points: window.points(),
            raster,
            cells,
            list: CellList::of(window, 1.0),
        }
    }

    /// The greatest share of a patch that some translation lays near points.
    fn best(&self, patch: &[[f64; 2]], is_own: bool) -> f64 {
        let Some(&middle) = patch.first() else {
            return 0.0;
        };
        let mut found: Vec<(usize, [f64; 2])> = Vec::new();
        let mut least = 0;
        // Anchors around the middle of the patch, spread over a fourth of it.
        let stride = (patch.len() / 4 / ANCHORS).max(1);
        for &anchor in patch.iter().step_by(stride).take(ANCHORS) {
            for &p in self.points {
                let shift = [p[0] - anchor[0], p[1] - anchor[1]];
                if is_own && squared(shift, [0.0; 2]) < SELF * SELF {
                    continue;
                }
                let lowest = middle.map(|v| v - PATCH);
                let is_far = (0..2).any(|i| {
                    let at = lowest[i] + shift[i];
                    at < -PATCH / 2.0 || at > self.side - PATCH / 2.0
                });
                if is_far {
                    continue;
                }
                let share = self.loose(patch, shift, least);
                if share > least {
                    found.push((share, shift));
                    if found.len() >= 8 * REFINED {
                        found.sort_by_key(|&(share, _)| core::cmp::Reverse(share));
                        found.truncate(REFINED);
                        least = found[REFINED - 1].0;
                    }
                }
            }
        }
        found.sort_by_key(|&(share, _)| core::cmp::Reverse(share));
        found.truncate(REFINED);
        let refined = found.iter().map(|&(_, shift)| self.refined(patch, shift));
        refined.max().unwrap_or(0) as f64 / patch.len() as f64
    }

    /// The number of points in the raster's disks, or 0 if it is at most `least`.
    fn loose(&self, patch: &[[f64; 2]], shift: [f64; 2], least: usize) -> usize {
        let most_missed = patch.len() - least;
        let mut missed = 0;
        for (i, p) in patch.iter().enumerate() {
            if i == FIRST && i - missed < FIRST_NEAR {
                return 0;
            }
            let [x, y] = [0, 1].map(|i| ((p[i] + shift[i]) * FINE) as i64);
            let is_in = [x, y].iter().all(|v| (0..self.cells as i64).contains(v));
            if !(is_in && self.raster[y as usize * self.cells + x as usize]) {
                missed += 1;
                if missed >= most_missed {
                    return 0;
                }
            }
        }
        patch.len() - missed
    }

    /// The greatest number of points within [`NEAR`], over translations around one.
    fn refined(&self, patch: &[[f64; 2]], mut shift: [f64; 2]) -> usize {
        let mut best = 0;
        for _ in 0..6 {
            let (mut sum, mut count, mut near) = ([0.0; 2], 0.0, 0);
            for p in patch {
                let at = [p[0] + shift[0], p[1] + shift[1]];
                let Some(q) = self.nearest(at) else { continue };
                let distance = squared(at, q);
                near += usize::from(distance <= NEAR * NEAR);
                if distance <= 4.0 * NEAR * NEAR {
                    // Near ones weigh more.
                    let weight = 1.0 / (1.0 + distance / (NEAR * NEAR));
                    for i in 0..2 {
                        sum[i] += weight * (q[i] - at[i]);
                    }
                    count += weight;
                }
            }
            best = best.max(near);
            if count == 0.0 {
                break;
            }
            shift = [0, 1].map(|i| shift[i] + sum[i] / count);
        }
        best
    }

    /// The nearest point within half a spacing.
    fn nearest(&self, at: [f64; 2]) -> Option<[f64; 2]> {
        let mut best = (0.25, None);
        for ring in 0..=1 {
            self.list.ring(at, ring, |_, by| {
                let distance = squared(by, [0.0; 2]);
                if distance < best.0 {
                    best = (distance, Some([at[0] - by[0], at[1] - by[1]]));
                }
            });
        }
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(side: f64, seed: u64) -> Vec<[f64; 2]> {
        SplitMix::new(seed).places((side * side) as usize, side)
    }

    #[test]
    fn a_tile_laid_twice_recurs_and_an_independent_set_does_not() {
        let tile = noise(40.0, 1);
        let shifted = |[x, y]: [f64; 2]| tile.iter().map(move |p| [p[0] + x, p[1] + y]);
        let both = [[0.0, 0.0], [40.0, 0.0], [0.0, 40.0], [40.0, 40.0]];
        let repeated = Sample::window(80.0, 1.0, both.into_iter().flat_map(shifted).collect());
        assert!(recurrence(&repeated, None, 8, 3) > 0.9);
        let other = Sample::window(80.0, 1.0, noise(80.0, 2));
        let [own, chance] =
            [None, Some(&repeated)].map(|found_in| recurrence(&other, found_in, 8, 3));
        // Random points clump, so chance is high; both are the same chance.
        assert!(own < 0.5 && (own - chance).abs() < 0.06, "{own} {chance}");
    }

    #[test]
    fn copies_that_moved_by_less_than_the_limit_recur() {
        let tile = noise(40.0, 1);
        let mut random = SplitMix::new(9);
        let mut moved = |[x, y]: [f64; 2]| {
            let [dx, dy] = [0, 1].map(|_| (random.next_f64() - 0.5) * 0.14);
            [x + dx + 40.0, y + dy]
        };
        let mut points = tile.clone();
        points.extend(tile.iter().map(|&p| moved(p)));
        let window = Sample::window(80.0, 1.0, points);
        // Half of the patches lie above, where nothing is, and are empty.
        let share = recurrence(&window, None, 24, 5);
        assert!(share > 0.15, "{share}");
    }
}
