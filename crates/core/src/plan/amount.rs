//! The spacing at which an area or a volume holds a given number of points.

use alloc::collections::VecDeque;
use core::array::from_fn;

use crate::{
    error::{Error, ErrorKind, number},
    lattice::{Grade, Spacing},
    shape::Region,
    window::Windowed,
};

/// More steps than a bisection of any bracket takes.
const MOST_STEPS: usize = 400;

/// A number of points to be found, and where.
pub(crate) struct Sought<'a, const D: usize> {
    pub(crate) count: u128,
    /// A box around it, if it is bounded.
    pub(crate) bounds: Option<Region<D>>,
    /// No spacing below is tried.
    pub(crate) least: f64,
    pub(crate) grade: Option<&'a Grade<D>>,
    /// The share of points that there are beside a field.
    pub(crate) share: f64,
}

/// A plan of exactly `count` points, at the spacing that takes: `plan` makes that of a spacing. No spacing below `least` is
/// tried: where counting takes time in proportion to the lattice rows, that bounds it.
///
/// As the spacing shrinks, points enter an area mostly one at a time. Without warp those of one column
/// and block have the same x, and two may enter a box at once. Then the plan is a window that leaves out
/// the last point. The search takes up to some fifty counts and finds the same spacing everywhere.
///
/// In a field the count does not fall with each step of the spacing, but it changes by a point at a time, so a
/// bracket of too many and too few still has a spacing of the count in it. Counting visits points there, so
/// the search begins at the mean share and interpolates: some ten counts.
pub(crate) fn exactly<const D: usize, P: Windowed>(
    sought: &Sought<'_, D>,
    plan: impl Fn(Spacing) -> Result<P, Error>,
) -> Result<P, Error> {
    let (count, least) = (sought.count, sought.least);
    let is_in_field = sought.grade.is_some();
    if count == 0 {
        return Err(Error::new(ErrorKind::Count, "count", 0, "at least 1"));
    }
    let bounds = sought
        .bounds
        .ok_or_else(|| Error::new(ErrorKind::Unbounded, "area", "unbounded", "within a box"))?;
    let share = match sought.grade {
        Some(grade) => match sum_of_shares(grade, &bounds) {
            0.0 if is_zero(grade, bounds) => {
                let allowed = "a region in which the field leaves points";
                let error = Error::new(ErrorKind::Count, "count", count, allowed);
                return Err(error.because("the field is 0 in all of the region"));
            }
            // At least a quarter of one place's.
            sum => sum.max(0.25) / f64::from(LOOKS) * sought.share,
        },
        None => sought.share,
    };
    let wanted = count as f64;
    let (min, max) = (bounds.min(), bounds.max());
    let sides = (0..D).map(|axis| root::<D>(max[axis] - min[axis]));
    let mut guess = sides.fold(1.0, |all, side| all * side) * root::<D>(share / wanted);
    let mut more: Option<P> = None;
    // Spacings with too many points, and with too few.
    let (mut low, mut high) = (0.0, f64::INFINITY);
    // The counts there.
    let mut ends = [0.0, 0.0];
    for step in 0..MOST_STEPS {
        guess = guess.max(least);
        let Ok(spacing) = Spacing::new(guess) else {
            break;
        };
        let plan = match plan(spacing) {
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
        let found = plan.part().total;
        if found == count {
            return Ok(plan);
        }
        if found > count {
            (low, ends[0]) = (guess, found as f64);
            if more.as_ref().is_none_or(|more| found < more.part().total) {
                more = Some(plan);
            }
        } else if guess <= least && (found > 0 || is_in_field) {
            let spacing = number(least);
            let (problem, allowed) = match found {
                0 if is_in_field => (
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
        // Counts go as densities do, which leads near; from there the bracket is halved.
        let law = guess * root::<D>(found.max(1) as f64 / wanted);
        let next = if high.is_infinite() {
            law.max(low * 1.000_001)
        } else if low == 0.0 {
            if found == 0 {
                high * 0.7
            } else {
                law.min(high * 0.999_999)
            }
        } else if is_in_field && ends[0] > 0.0 && step % 3 != 0 {
            let next = interpolated::<D>([low, high], ends, wanted);
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
        let (problem, allowed) = match ends[1] == 0.0 && !is_in_field {
            true => (
                "the region has no area that holds a point",
                "a region with an area",
            ),
            false => ("no spacing places this number of points here", ""),
        };
        Error::new(ErrorKind::Count, "count", count, allowed).because(problem)
    })?;
    Ok(more.window_from(0, Some(count)))
}

/// The side of a square, or of a cube.
fn root<const D: usize>(content: f64) -> f64 {
    match D {
        2 => libm::sqrt(content),
        _ => libm::cbrt(content),
    }
}

/// The first look at a field takes this number of places, in rows and columns, in space layers, too.
const LOOKS: u32 = 4096;

/// The sum of the shares of a field at a grid of places in a box.
fn sum_of_shares<const D: usize>(grade: &Grade<D>, bounds: &Region<D>) -> f64 {
    let (min, max) = (bounds.min(), bounds.max());
    let side = root::<D>(f64::from(LOOKS)) as u32;
    let place = |number: u32| {
        from_fn(|axis| {
            let along = number / side.pow(axis as u32) % side;
            let part = (f64::from(along) + 0.5) / f64::from(side);
            min[axis] + (max[axis] - min[axis]) * part
        })
    };
    (0..LOOKS).map(|number| grade.share(place(number))).sum()
}

/// Whether the bounds of a field say that it is 0 in all of a box, in smaller and smaller pieces of it.
fn is_zero<const D: usize>(grade: &Grade<D>, bounds: Region<D>) -> bool {
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

/// The halves of a box across its longest side.
fn halves<const D: usize>(piece: Region<D>) -> Option<[Region<D>; 2]> {
    let (min, max) = (piece.min(), piece.max());
    let side = |axis: usize| max[axis] - min[axis];
    let longest = (1..D).fold(0, |a, b| if side(b) > side(a) { b } else { a });
    let (mut end, mut start) = (max, min);
    end[longest] = between(min[longest], max[longest]);
    start[longest] = end[longest];
    Some([Region::new(min, end).ok()?, Region::new(start, max).ok()?])
}

/// The spacing between two at which a count lies as far between theirs, as counts go as densities do.
fn interpolated<const D: usize>(spacings: [f64; 2], counts: [f64; 2], wanted: f64) -> f64 {
    let content = |spacing: f64| (1..D).fold(spacing, |all, _| all * spacing);
    let [dense, sparse] = spacings.map(|spacing| 1.0 / content(spacing));
    let part = (wanted + 0.5 - counts[1]) / (counts[0] - counts[1]);
    1.0 / root::<D>(sparse + (dense - sparse) * part)
}

fn between(low: f64, high: f64) -> f64 {
    low + (high - low) / 2.0
}
