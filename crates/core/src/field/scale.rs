//! Numbers mapped to shares.

use crate::error::{Error, ErrorKind, number};

/// The largest absolute value of coordinates and other numbers of a field: their squares are finite.
pub(super) const MOST: f64 = 1e100;

/// A piece of a line: from a range of numbers to shares, constant beyond its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slide {
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
}

impl Slide {
    /// Maps `from[0]` to `to[0]` and `from[1]`, which is greater, to `to[1]`.
    pub(super) fn new(name: &'static str, from: [f64; 2], to: [f64; 2]) -> Result<Self, Error> {
        check_numbers(name, &from)?;
        if from[0] >= from[1] {
            let value = alloc::format!("{} to {}", number(from[0]), number(from[1]));
            let allowed = "two numbers in ascending order";
            return Err(Error::new(ErrorKind::Field, name, value, allowed));
        }
        for share in to {
            check_share("shares", share)?;
        }
        Ok(Self { from, to })
    }

    #[inline]
    pub(super) fn share(&self, v: f64) -> f64 {
        let ([a, b], [low, high]) = (self.from, self.to);
        if v >= b {
            high
        } else if v > a {
            low + (high - low) * ((v - a) / (b - a)).min(1.0)
        } else {
            low
        }
    }

    /// A bound of how much the share changes for each unit, within a range of numbers.
    pub(super) fn slope(&self, ends: [f64; 2]) -> f64 {
        let [low, high] = self.bounds(ends);
        if low == high {
            return 0.0;
        }
        let ([a, b], [from, to]) = (self.from, self.to);
        // With room for what rounds.
        (to - from).abs() / (b - a) * (1.0 + 1e-9)
    }

    /// Bounds of the shares of a range of numbers.
    pub(super) fn bounds(&self, ends: [f64; 2]) -> [f64; 2] {
        let [a, b] = ends.map(|v| self.share(v));
        widened([a.min(b), a.max(b)])
    }
}

/// A number within [0, 1]. NaN becomes 0.
#[inline(always)]
pub(super) fn unit(v: f64) -> f64 {
    // Not clamp(), which keeps NaN.
    if v > 0.0 { v.min(1.0) } else { 0.0 }
}

/// Bounds with room for what rounds, where they differ. Equal bounds stay: then all is constant.
pub(super) fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    if low == high {
        return [low, high];
    }
    let room = 1e-12 * low.abs().max(high.abs());
    [low - room, high + room]
}

pub(super) fn check_share(name: &'static str, share: f64) -> Result<(), Error> {
    if (0.0..=1.0).contains(&share) {
        return Ok(());
    }
    let allowed = "a number from 0 to 1";
    Err(Error::new(ErrorKind::Field, name, number(share), allowed))
}

/// Refuses coordinates and other numbers that are not finite, or huge.
pub(super) fn check_numbers(name: &'static str, numbers: &[f64]) -> Result<(), Error> {
    match numbers.iter().find(|v| v.is_nan() || v.abs() > MOST) {
        Some(v) => {
            let allowed = "a finite number within ±1e100";
            Err(Error::new(ErrorKind::Field, name, number(*v), allowed))
        }
        None => Ok(()),
    }
}
