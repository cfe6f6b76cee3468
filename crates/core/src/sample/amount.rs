//! The spacing at which an area holds a given number of points.

use alloc::collections::VecDeque;

use super::{
    lattice::{Grade, Lattice, Placement, Spacing},
    near::Mask,
    plan::Plan,
};
use crate::{
    error::{Error, ErrorKind, number},
    shape::{Area, Region},
    stop::Stop,
};

/// More steps than a bisection of any bracket takes.
const MOST_STEPS: usize = 400;

/// A plan of exactly `count` points in an area, at the spacing that takes. The spacing of `lattice` is
/// ignored. No spacing below `least` is tried: where counting takes time in proportion to the lattice
/// rows, that bounds it.
///
/// As the spacing shrinks, points enter an area mostly one at a time. Without warp those of one column
/// and block have the same x, and two may enter a box at once. Then the plan is a window that leaves out
/// the last point. The search takes up to some fifty counts and finds the same spacing everywhere.
///
/// In a field the count does not fall with each step of the spacing, but it changes by a point at a time, so a
/// bracket of too many and too few still has a spacing of the count in it. Counting visits points there, so
/// the search begins at the mean share and interpolates: some ten counts.
pub(super) fn exactly(
    lattice: &Lattice,
    mask: &Mask,
    area: &Area,
    count: u128,
    least: f64,
    stop: &Stop,
) -> Result<Plan, Error> {
    if count == 0 {
        return Err(Error::new(ErrorKind::Count, "count", 0, "at least 1"));
    }
    let bounds = mask.clone().and_within(area.clone()).area;
    let bounds = bounds
        .as_ref()
        .and_then(Area::bounds)
        .ok_or_else(|| Error::new(ErrorKind::Unbounded, "area", "unbounded", "within a box"))?;
    let [width, height] = bounds.sides();
    let share = match &lattice.grade {
        Some(grade) => match sum_of_shares(grade, &bounds) {
            0.0 if is_zero(grade, bounds) => {
                let allowed = "a region in which the field leaves points";
                let error = Error::new(ErrorKind::Count, "count", count, allowed);
                return Err(error.because("the field is 0 in all of the region"));
            }
            // At least a quarter of one place's.
            sum => sum.max(0.25) / f64::from(SIDE * SIDE) * lattice.kind_share(),
        },
        None => lattice.share(),
    };
    let wanted = count as f64;
    let mut guess = libm::sqrt(width) * libm::sqrt(height) * libm::sqrt(share / wanted);
    let mut more: Option<Plan> = None;
    // Spacings with too many points, and with too few.
    let (mut low, mut high) = (0.0, f64::INFINITY);
    // The counts there.
    let mut ends = [0.0, 0.0];
    for step in 0..MOST_STEPS {
        guess = guess.max(least);
        let Ok(spacing) = Spacing::new(guess) else {
            break;
        };
        let placement = Placement {
            spacing,
            ..lattice.placement
        };
        let trial = lattice.replaced(placement);
        let plan = match Plan::new(&trial, mask, area.clone(), stop.clone(), None) {
            Ok(plan) => plan,
            // So dense that f64 coordinates of points coincide.
            Err(error) if error.kind() == ErrorKind::TooFar && high.is_finite() => {
                low = guess;
                guess = between(low, high);
                if guess <= low || guess >= high {
                    break;
                }
                continue;
            }
            Err(error) => return Err(error),
        };
        let found = plan.total();
        if found == count {
            return Ok(plan);
        }
        if found > count {
            (low, ends[0]) = (guess, found as f64);
            if more.as_ref().is_none_or(|more| found < more.total()) {
                more = Some(plan);
            }
        } else if guess <= least && (found > 0 || lattice.grade.is_some()) {
            let spacing = number(least);
            let (problem, allowed) = match found {
                0 if lattice.grade.is_some() => (
                    alloc::format!("no point is left here, down to a spacing of {spacing}"),
                    "a region in which the field leaves points",
                ),
                _ => (
                    alloc::format!("{count} points take a spacing below {spacing} here"),
                    "a smaller number",
                ),
            };
            let error = Error::new(ErrorKind::TooDense, "count", count, allowed);
            return Err(error.because(problem).with_limit(least));
        } else {
            (high, ends[1]) = (guess, found as f64);
            if guess <= least {
                break;
            }
        }
        // Counts go as spacing⁻², which leads near; from there the bracket is halved.
        let law = guess * libm::sqrt(found.max(1) as f64 / wanted);
        let next = if high.is_infinite() {
            law.max(low * 1.000_001)
        } else if low == 0.0 {
            if found == 0 {
                high * 0.7
            } else {
                law.min(high * 0.999_999)
            }
        } else if lattice.grade.is_some() && ends[0] > 0.0 && step % 3 != 0 {
            let next = interpolated([low, high], ends, wanted);
            if low < next && next < high {
                next
            } else {
                between(low, high)
            }
        } else if high - low > 1e-3 * high && low < law && law < high {
            law
        } else {
            between(low, high)
        };
        if next <= low || next >= high {
            break;
        }
        guess = next;
    }
    let more = more.ok_or_else(|| {
        let (problem, allowed) = match ends[1] == 0.0 && lattice.grade.is_none() {
            true => (
                "the region has no area that holds a point",
                "a region with an area",
            ),
            false => ("no spacing places this number of points here", ""),
        };
        Error::new(ErrorKind::Count, "count", count, allowed).because(problem)
    })?;
    Ok(more.window(0, Some(count)))
}

/// The first look at a field takes this number of rows and columns of places.
const SIDE: u32 = 64;

/// The sum of the shares of a field at a grid of places in a box.
fn sum_of_shares(grade: &Grade, bounds: &Region) -> f64 {
    let (min, max) = (bounds.min(), bounds.max());
    let along = |axis: usize, i: u32| {
        let part = (f64::from(i) + 0.5) / f64::from(SIDE);
        min[axis] + (max[axis] - min[axis]) * part
    };
    let row = |y: u32| (0..SIDE).map(move |x| grade.share([along(0, x), along(1, y)]));
    (0..SIDE).flat_map(row).sum()
}

/// Whether the bounds of a field say that it is 0 in all of a box, in smaller and smaller pieces of it.
fn is_zero(grade: &Grade, bounds: Region) -> bool {
    /// The most pieces that are looked at: less than a millisecond.
    const MOST: usize = 4096;
    let mut open = VecDeque::from([bounds]);
    for _ in 0..MOST {
        let Some(piece) = open.pop_front() else {
            return true;
        };
        let [low, high] = grade.bounds(&piece);
        if low > 0.0 {
            return false;
        }
        if high > 0.0 {
            let Some(halves) = halves(piece) else {
                return false;
            };
            open.extend(halves);
        }
    }
    open.is_empty()
}

/// The halves of a box across its longer side.
fn halves(piece: Region) -> Option<[Region; 2]> {
    let (min, max) = (piece.min(), piece.max());
    let longer = usize::from(max[1] - min[1] > max[0] - min[0]);
    let (mut end, mut start) = (max, min);
    end[longer] = between(min[longer], max[longer]);
    start[longer] = end[longer];
    Some([Region::new(min, end).ok()?, Region::new(start, max).ok()?])
}

/// The spacing between two at which a count lies as far between theirs, as counts go as spacing⁻².
fn interpolated(spacings: [f64; 2], counts: [f64; 2], wanted: f64) -> f64 {
    let [dense, sparse] = spacings.map(|spacing| 1.0 / (spacing * spacing));
    let part = (wanted + 0.5 - counts[1]) / (counts[0] - counts[1]);
    1.0 / libm::sqrt(sparse + (dense - sparse) * part)
}

fn between(low: f64, high: f64) -> f64 {
    low + (high - low) / 2.0
}
