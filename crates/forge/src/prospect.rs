//! The prospect of a table before it is made: its number of blocks, and whether it can be any good.

use std::fmt;

use strew_core::{Map, Twin};

use crate::{Job, plan::MIN_SIDE};

/// A job whose map has fewer intervals per axis carries a warning: of the 11 α with fewer in the scan of
/// `docs/alpha.md` no table is accepted, of the 23 others all but 3.
pub const FEW_INTERVALS: usize = 43;

/// The facts about a job's table that are known before it is made. They take about the time of making its map.
///
/// ```
/// use strew_forge::Job;
///
/// let job = |alpha: &str| Ok::<_, strew_core::Error>(Job::new(alpha.parse()?));
/// let good = job("(5-sqrt(3))/2")?.prospect();
/// assert_eq!((good.intervals, good.period), (63, None));
/// assert!(good.hopeless().is_none());
/// // The pattern of 3/2 repeats every 4 grid units and has one point there.
/// let bad = job("3/2")?.prospect();
/// assert_eq!((bad.intervals, bad.period), (1, Some(4)));
/// assert!(bad.hopeless().is_some());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Prospect {
    /// The intervals of the map per axis.
    pub intervals: usize,
    /// The period of the pattern along each axis in grid units, if α is a fraction.
    pub period: Option<u64>,
    /// Why no table can be good, if α is too small, or a fraction on which thresholds of the map coincide.
    why: Option<&'static str>,
    displaces: bool,
}

const NEAR_ONE: &str =
    "alpha is below 1.1, where points are so far apart in the grid that a map sees few";
const TIES: &str = "alpha is a fraction of small integers, so neighborhoods repeat and thresholds of the map coincide";

impl Prospect {
    /// The number of vectors of the table.
    #[must_use]
    pub const fn blocks(&self) -> usize {
        self.intervals * self.intervals
    }

    /// The reason why no such table can be good, if there is one. The forge then refuses the job.
    #[must_use]
    pub fn hopeless(&self) -> Option<String> {
        let why = self.why.filter(|_| self.displaces);
        why.map(|why| format!("{why} ({self})"))
    }

    /// The reason why the judge will probably reject the table, if there is one: the map has too few blocks.
    #[must_use]
    pub fn doubt(&self) -> Option<String> {
        let is_doubtful = self.displaces && self.intervals < FEW_INTERVALS;
        is_doubtful.then(|| {
            format!("no table with this few blocks has met the bounds of `blue` so far ({self})")
        })
    }
}

impl fmt::Display for Prospect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let blocks = match self.intervals {
            1 => "1 block".into(),
            n => format!("{n} × {n} blocks"),
        };
        f.write_str(&blocks)?;
        match self.period {
            Some(period) => write!(f, ", and the pattern repeats every {period} grid units"),
            None => Ok(()),
        }
    }
}

impl Job {
    /// The facts about the table that are known before the work.
    #[must_use]
    pub fn prospect(&self) -> Prospect {
        let map = Map::new(self.alpha, self.radius).ok();
        let why = match &map {
            _ if self.alpha.set_side_f64() < MIN_SIDE => Some(NEAR_ONE),
            Some(map) if has_ties(map) && is_small(map) => Some(TIES),
            _ => None,
        };
        Prospect {
            intervals: map.map_or(0, |map| intervals(&map)),
            period: self.alpha.fraction().map(|(_, q)| q.saturating_mul(2)),
            why,
            displaces: self.target.is_some() || self.profile != "pattern",
        }
    }
}

/// The units of the set region of a fraction p/q: the pattern has that number squared of points in a period.
fn units(map: &Map) -> Option<u64> {
    map.alpha().fraction().map(|(p, q)| p - q)
}

/// The intervals that points lie in: at a fraction no more than its units, whatever rounding adds.
fn intervals(map: &Map) -> usize {
    let units = units(map).and_then(|units| usize::try_from(units).ok());
    units.map_or(map.intervals(), |units| map.intervals().min(units))
}

/// Whether a period has so few points that its spectrum is a few tall peaks, wherever they are moved. With 49 to 121
/// points the judge refused every table, with 2601 it accepted one (`docs/alpha.md`).
fn is_small(map: &Map) -> bool {
    const FEW: u64 = 16;
    units(map).is_some_and(|units| units < FEW)
}

/// Whether thresholds of a map coincide: then the order of the thresholds holds at no other α, and not in a twin.
fn has_ties(map: &Map) -> bool {
    let fraction = map.alpha().fraction();
    let itself = fraction.and_then(|(p, q)| Twin::new(p, q));
    itself.is_some_and(|twin| !map.has_twin(twin))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forge;

    #[test]
    fn what_is_hopeless_is_refused_by_the_forge() {
        for (alpha, is_hopeless) in [
            ("3/2", true),
            ("4/3", true),
            ("1.05", true),
            ("7/4", true),
            ("sqrt(2)", false),
            ("183/112", false),
        ] {
            let job = Job {
                radius: 20,
                steps: Some(1),
                ..Job::new(alpha.parse().expect("valid"))
            };
            let prospect = job.prospect();
            assert_eq!(prospect.hopeless().is_some(), is_hopeless, "{alpha}");
            assert_eq!(forge(&job, &()).is_err(), is_hopeless, "{alpha}");
            let plain = Job {
                profile: "pattern".into(),
                ..job
            };
            assert!(plain.prospect().hopeless().is_none());
        }
    }
}
