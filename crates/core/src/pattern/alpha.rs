//! The number α that fixes an AA pattern, kept exactly as text and as a fixed-point unit.

use core::{fmt, str::FromStr};

use super::quadratic::Quadratic;
use crate::error::{Error, ErrorKind, shown};

/// The number α, in the open interval (1, 2), as exactly as the index torus can hold it.
///
/// It is read from a decimal (`1.75`), a fraction (`183/112`) or a quadratic irrational (`sqrt(3)`,
/// `(5-sqrt(3))/2`, `(1+sqrt(5))/2`). [`Display`](fmt::Display) prints the canonical text of the value,
/// whatever its spelling was: fractions are reduced and roots square-free. That text serves as a key.
///
/// The pattern uses α/2 rounded to the nearest multiple of 2⁻⁶⁴. The pattern of the rounded number is
/// itself an exact AA pattern.
///
/// ```
/// use strew_core::Alpha;
/// let alpha: Alpha = "( 10 - sqrt(12) ) / 4".parse()?;
/// assert_eq!(alpha.to_string(), "(5-sqrt(3))/2");
/// assert!((alpha.to_f64() - 1.6339745962155614).abs() < 1e-15);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Alpha {
    exact: Quadratic,
    half: u64,
}

/// The forms of a text that can be read as α.
const ALLOWED: &str = "a decimal (1.75), a fraction (183/112) or a quadratic irrational such as \
                       sqrt(3), (5-sqrt(3))/2 or (1+sqrt(5))/2, between 1 and 2";

impl Alpha {
    /// α/2 in units of 2⁻⁶⁴: the step of the index torus along an axis. Its top bit is set.
    #[must_use]
    pub const fn half(self) -> u64 {
        self.half
    }

    /// t = (α − 1)/2 in units of 2⁻⁶⁴: the side of the set region.
    #[must_use]
    pub const fn set_side(self) -> u64 {
        self.half - (1 << 63)
    }

    /// The nearest `f64` to the fixed-point α.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        self.half as f64 * (1.0 / (1u64 << 63) as f64)
    }

    /// The nearest `f64` to the fixed-point t.
    #[must_use]
    pub fn set_side_f64(self) -> f64 {
        self.set_side() as f64 * (0.5 / (1u64 << 63) as f64)
    }

    /// p and q if α is the fraction p/q, reduced; `None` if it is irrational.
    #[must_use]
    pub fn fraction(self) -> Option<(u64, u64)> {
        self.exact.fraction()
    }

    /// The fraction p/q.
    ///
    /// # Errors
    /// [`ErrorKind::Alpha`] unless 1 < p/q < 2 and both are at most 10¹⁸.
    pub fn from_fraction(p: u64, q: u64) -> Result<Self, Error> {
        alloc::format!("{p}/{q}").parse()
    }
}

impl FromStr for Alpha {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let refused = |problem: &'static str| {
            let text = alloc::format!("`{}`", shown(text));
            Error::new(ErrorKind::Alpha, "alpha", text, ALLOWED).because(problem)
        };
        let exact = Quadratic::parse(text).map_err(refused)?;
        // The range is checked on the exact value first; rounding may still reach an end.
        let half = exact
            .strictly_between_one_and_two()
            .then(|| exact.times_power_63())
            .and_then(|v| u64::try_from(v).ok())
            .filter(|&half| half > 1 << 63)
            .ok_or_else(|| refused("out of range"))?;
        Ok(Self { exact, half })
    }
}

impl fmt::Display for Alpha {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.exact.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;

    fn alpha(text: &str) -> Alpha {
        text.parse().unwrap_or_else(|e| panic!("{e}"))
    }

    #[test]
    fn one_value_has_one_text() {
        for (text, canonical) in [
            ("1.5", "3/2"),
            ("1.50", "3/2"),
            ("+1.5", "3/2"),
            ("6/4", "3/2"),
            ("183/112", "183/112"),
            ("sqrt(3)", "sqrt(3)"),
            ("√3", "sqrt(3)"),
            ("sqrt( 12 )/2", "sqrt(3)"),
            ("(5-sqrt(3))/2", "(5-sqrt(3))/2"),
            ("5/2-sqrt(3)/2", "(5-sqrt(3))/2"),
            ("(10 - 2*sqrt(3)) / 4", "(5-sqrt(3))/2"),
            ("(1+sqrt(5))/2", "(1+sqrt(5))/2"),
            ("(sqrt(5)+1)/2", "(1+sqrt(5))/2"),
            ("sqrt(9)/2", "3/2"),
            ("3-sqrt(2)", "3-sqrt(2)"),
            ("2*sqrt(2)/2", "sqrt(2)"),
            ("3*sqrt(2)/4", "3*sqrt(2)/4"),
        ] {
            let a = alpha(text);
            assert_eq!(a.to_string(), canonical, "{text}");
            assert_eq!(alpha(canonical), a, "{text}");
        }
        assert_eq!(Alpha::from_fraction(366, 224), Ok(alpha("183/112")));
    }

    #[test]
    fn fixed_point_is_the_nearest_unit() {
        assert_eq!(alpha("3/2").half(), 3 << 62);
        // Reference values: round(α·2⁶³), computed with 60-digit arithmetic.
        assert_eq!(alpha("sqrt(3)").half(), 15_975_348_984_942_515_102);
        assert_eq!(alpha("(1+sqrt(5))/2").half(), 14_923_729_446_516_375_051);
        assert_eq!(alpha("(5-sqrt(3))/2").half(), 15_070_755_599_665_681_969);
    }

    #[test]
    fn bad_texts_are_refused_with_their_reason() {
        for text in [
            "",
            " ",
            "abc",
            "1..5",
            "sqrt(3",
            "sqrt(-3)",
            "1/0",
            "3/",
            "(3/2",
            "1e1",
            "NaN",
            "inf",
            "1.5x",
            "sqrt(2)*sqrt(3)",
            "sqrt(2)+sqrt(3)",
            "99999999999999999999999999999999",
            "--3/2",
            "1,5",
        ] {
            let error = text.parse::<Alpha>().expect_err(text);
            assert_eq!(error.kind(), ErrorKind::Alpha, "{text}");
            assert_ne!(error.problem(), "out of range", "{text}");
        }
        for text in [
            "1", "2", "0", "-1.5", "2.5", "1e300", "sqrt(5)", "sqrt(4)", "sqrt(1)",
        ] {
            assert!(text.parse::<Alpha>().is_err(), "{text}");
        }
        assert!(Alpha::from_fraction(5, 2).is_err());
    }
}
