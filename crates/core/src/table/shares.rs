//! Shares of kinds: how many of a set's points are of each kind, as a ratio of small integers.

use alloc::{borrow::ToOwned, string::String, vec::Vec};
use core::{fmt, str::FromStr};

use crate::error::{Error, ErrorKind, number, shown};

/// The shares that kinds have of a set's points: integers in lowest terms, ascending. Kinds are numbered in
/// this order, the rarest first.
///
/// The text form is the integers joined by colons: `1:3:10`. Any order is read, the ascending one is written.
///
/// ```
/// use strew_core::table::Shares;
///
/// let trees = Shares::new([30.0, 10.0, 100.0])?;
/// assert_eq!(trees.parts(), [1, 3, 10]);
/// assert_eq!(trees.to_string(), "1:3:10");
/// assert_eq!("10:3:1".parse::<Shares>()?, trees);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Shares {
    parts: Vec<u16>,
}

/// A ratio is that of integers if it is that near to it: decimals such as 0.1 are not exact in `f64`.
const NEAR: f64 = 1e-9;

impl Shares {
    /// The largest number of kinds.
    pub const MAX_KINDS: usize = 32;
    /// The largest sum of the parts.
    pub const MAX_TOTAL: u32 = 1024;

    /// Shares in the ratio of some weights, in any order.
    ///
    /// Weights in a ratio of integers with a sum of at most [`MAX_TOTAL`](Self::MAX_TOTAL) are exact; others
    /// are rounded to 1024ths of their sum.
    ///
    /// # Errors
    /// [`ErrorKind::Shares`] unless there are 2 to [`MAX_KINDS`](Self::MAX_KINDS) positive finite weights, each
    /// of at least 1/1024 of the sum once they are rounded.
    pub fn new(weights: impl IntoIterator<Item = f64>) -> Result<Self, Error> {
        let mut more = weights.into_iter();
        let mut weights: Vec<f64> = more.by_ref().take(Self::MAX_KINDS).collect();
        let count = weights.len() + more.count();
        if !(2..=Self::MAX_KINDS).contains(&count) {
            let field = "the number of weights of the shares";
            let allowed = alloc::format!("from 2 to {}", Self::MAX_KINDS);
            return Err(Error::new(ErrorKind::Shares, field, count, allowed));
        }
        let is_bad = |weight: &&f64| !(weight.is_finite() && **weight > 0.0);
        if let Some(&bad) = weights.iter().find(is_bad) {
            return Err(refused(bad, "a finite number greater than 0".into()));
        }
        // The sum rounds alike for every order of the weights.
        weights.sort_unstable_by(f64::total_cmp);
        let greatest = weights[weights.len() - 1];
        let scaled: Vec<f64> = weights.iter().map(|weight| weight / greatest).collect();
        let sum: f64 = scaled.iter().sum();
        let ideal = |total: u32| {
            let times = f64::from(total) / sum;
            scaled.iter().map(move |weight| weight * times)
        };
        let is_exact =
            |total: &u32| ideal(*total).all(|v| v > 0.5 && (v - libm::rint(v)).abs() < NEAR);
        let parts = match (count as u32..=Self::MAX_TOTAL).find(is_exact) {
            Some(total) => ideal(total).map(|v| libm::rint(v) as u16).collect(),
            None => rounded(ideal(Self::MAX_TOTAL).collect()),
        };
        if parts[0] == 0 {
            let allowed = alloc::format!("at least 1/{} of the sum", Self::MAX_TOTAL);
            return Err(refused(weights[0], allowed));
        }
        let divisor = parts.iter().copied().fold(0, greatest_divisor);
        Ok(Self {
            parts: parts.iter().map(|part| part / divisor).collect(),
        })
    }

    /// The parts, ascending, in lowest terms: one for each kind.
    #[must_use]
    pub fn parts(&self) -> &[u16] {
        &self.parts
    }

    /// The number of kinds.
    #[must_use]
    pub fn kinds(&self) -> usize {
        self.parts.len()
    }

    /// The sum of the parts, at most [`MAX_TOTAL`](Self::MAX_TOTAL).
    #[must_use]
    pub fn total(&self) -> u32 {
        self.parts.iter().map(|&part| u32::from(part)).sum()
    }

    /// The share of a kind, from 0 to 1; 0 past the last.
    #[must_use]
    pub fn of(&self, kind: u8) -> f64 {
        let part = self.parts.get(usize::from(kind));
        part.map_or(0.0, |&part| f64::from(part) / f64::from(self.total()))
    }
}

/// The error of a weight that is not allowed.
fn refused(weight: f64, allowed: String) -> Error {
    Error::new(
        ErrorKind::Shares,
        "a weight of the shares",
        number(weight),
        allowed,
    )
}

/// Integers with the same sum, which is whole: what is left after rounding down goes to the largest remainders.
/// Among equal ones the later is first, where it matters least.
fn rounded(ideal: Vec<f64>) -> Vec<u16> {
    let mut parts: Vec<u16> = ideal.iter().map(|&v| v as u16).collect();
    let sum: u32 = parts.iter().map(|&part| u32::from(part)).sum();
    let mut order: Vec<usize> = (0..ideal.len()).rev().collect();
    let remainder = |i: usize| ideal[i] - f64::from(ideal[i] as u16);
    order.sort_by(|&a, &b| remainder(b).total_cmp(&remainder(a)));
    let left = Shares::MAX_TOTAL.saturating_sub(sum) as usize;
    for &i in order.iter().take(left) {
        parts[i] += 1;
    }
    parts.sort_unstable();
    parts
}

const fn greatest_divisor(mut a: u16, mut b: u16) -> u16 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl fmt::Display for Shares {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, part) in self.parts.iter().enumerate() {
            let colon = if i == 0 { "" } else { ":" };
            write!(f, "{colon}{part}")?;
        }
        Ok(())
    }
}

impl FromStr for Shares {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let weight = |part: &str| {
            part.trim().parse::<f64>().map_err(|_| {
                let allowed = "numbers joined by colons, such as 1:3:10";
                Error::new(ErrorKind::Shares, "shares", shown(text).to_owned(), allowed)
            })
        };
        // A longer list is refused too, by this number.
        let parts = text.split(':').take(8 * Self::MAX_KINDS);
        Self::new(parts.map(weight).collect::<Result<Vec<_>, _>>()?)
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;

    #[test]
    fn ratios_of_integers_are_exact_in_any_order() {
        for (weights, parts) in [
            (&[3.0, 1.0][..], &[1, 3][..]),
            (&[0.1, 0.3], &[1, 3]),
            (&[1e300, 3e300, 1e301], &[1, 3, 10]),
            (&[7e-9, 1e-9], &[1, 7]),
            (&[0.1, 0.1, 0.1], &[1, 1, 1]),
            (&[5.0, 1.0, 3.0, 2.0, 4.0], &[1, 2, 3, 4, 5]),
            (&[1023.0, 1.0], &[1, 1023]),
            (&[6.0, 4.0], &[2, 3]),
            (&[2.0, 2.0], &[1, 1]),
        ] {
            let shares = Shares::new(weights.iter().copied()).expect("valid");
            assert_eq!(shares.parts(), parts);
            let reversed = Shares::new(weights.iter().rev().copied());
            assert_eq!(reversed, Ok(shares.clone()));
            assert_eq!(shares.to_string().parse(), Ok(shares));
        }
        let shares = Shares::new([3.0, 1.0]).expect("valid");
        assert_eq!([0, 1, 2].map(|kind| shares.of(kind)), [0.25, 0.75, 0.0]);
    }

    #[test]
    fn other_ratios_are_rounded() {
        for weights in [[1.0, core::f64::consts::PI, 9.0], [700.0, 701.0, 703.0]] {
            let shares = Shares::new(weights).expect("valid");
            let sum: f64 = weights.iter().sum();
            for (part, weight) in shares.parts().iter().zip(weights) {
                let share = f64::from(*part) / f64::from(shares.total());
                assert!((share - weight / sum).abs() <= 1.0 / 1024.0, "{shares}");
            }
        }
        // A small change of a weight is another ratio, or none.
        let [a, b] = [3.0, 3.01].map(|w| Shares::new([1.0, w]).expect("valid").to_string());
        assert_eq!([a.as_str(), b.as_str()], ["1:3", "100:301"]);
    }

    #[test]
    fn bad_weights_are_refused_by_name() {
        for (text, says) in [
            (
                "1",
                "the number of weights of the shares is 1; it must be from 2 to 32",
            ),
            ("", "numbers joined by colons"),
            ("1:x", "numbers joined by colons"),
            ("1:0", "is 0; it must be a finite number greater than 0"),
            ("1:-2", "is -2"),
            ("1:NaN", "is NaN"),
            ("1:inf", "is inf"),
            (
                "1:1000000",
                "a weight of the shares is 1; it must be at least 1/1024 of the sum",
            ),
            ("5e-324:1e308", "is 5e-324"),
        ] {
            let error = text.parse::<Shares>().expect_err(text).to_string();
            assert!(error.contains(says), "{text}: {error}");
        }
        let many = |count| Shares::new((0..count).map(|_| 1.0));
        assert_eq!(many(32).map(|shares| shares.kinds()), Ok(32));
        assert!(many(33).is_err());
    }
}
