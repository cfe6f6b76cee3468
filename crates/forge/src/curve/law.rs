//! Power laws, drawn as straight segments.

use serde::Deserialize;

use super::{MAX_NU, target::refuse};
use crate::ForgeError;

/// The largest absolute value of an exponent.
const MAX_EXPONENT: f64 = 8.0;
/// The relative error that decides the number of straight segments of a law.
const SEGMENT_ERROR: f64 = 1e-3;
/// The largest number of segments of a law.
const MAX_SEGMENTS: f64 = 200.0;
/// The end of the first segment of a law that begins at ν = 0, over the end of the piece.
const FIRST_SEGMENT: f64 = 1e-3;

/// `power` · (ν / `at`)^`exponent`.
#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Law {
    power: f64,
    at: f64,
    exponent: f64,
}

impl Law {
    /// The ends of straight segments that approximate the law from `from` to `to`; their ν are in
    /// geometric progression. `number` is that of the piece, for errors.
    pub(super) fn points(
        self,
        from: f64,
        to: f64,
        number: usize,
    ) -> Result<Vec<[f64; 2]>, ForgeError> {
        let wrong = |name: &str, value: f64, allowed: &str| {
            let value = format!("piece {number} with law.{name} = {value}");
            Err(refuse(value, allowed.into()))
        };
        let exponent = self.exponent;
        if !(-MAX_EXPONENT..=MAX_EXPONENT).contains(&exponent) {
            let allowed = format!("-{MAX_EXPONENT} to {MAX_EXPONENT}");
            return wrong("exponent", exponent, &allowed);
        }
        if !(self.at > 0.0 && self.at <= MAX_NU) {
            let allowed = format!("more than 0, at most {MAX_NU}");
            return wrong("at", self.at, &allowed);
        }
        if from == 0.0 && exponent < 0.0 {
            let allowed = "0 or more in a piece from nu = 0, where the law would be infinite";
            return wrong("exponent", exponent, allowed);
        }
        // A curve decides a table, so it needs the same bits on every machine: those of `libm`.
        let at = |nu: f64| {
            [
                round(nu),
                round(self.power * libm::pow(nu / self.at, exponent)),
            ]
        };
        let first = if from == 0.0 {
            to * FIRST_SEGMENT
        } else {
            from
        };
        // A chord across a step h of ln ν has a relative error of about |E·(E − 1)|·h²/8.
        let bend = (exponent * (exponent - 1.0)).abs() / (8.0 * SEGMENT_ERROR);
        let span = libm::log(to / first);
        let segments = (span * bend.sqrt()).ceil().clamp(1.0, MAX_SEGMENTS);
        let mut points = Vec::new();
        if from == 0.0 {
            points.push([0.0, if exponent > 0.0 { 0.0 } else { self.power }]);
        }
        points.push([first, at(first)[1]]);
        let inner = (1..segments as u32).map(|k| first * libm::exp(span * f64::from(k) / segments));
        points.extend(inner.map(at));
        points.push([to, at(to)[1]]);
        Ok(points)
    }
}

/// Rounds to six significant decimal digits, which keeps a table's history readable.
fn round(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use crate::Target;

    #[test]
    fn laws_are_approximated_closely_even_from_zero() {
        for exponent in [0.0, 0.3, 1.0, 2.0, 4.0] {
            let law = format!("law = {{ power = 1.0, at = 2.0, exponent = {exponent} }}");
            let target: Target = format!("[[piece]]\nfrom = 0.0\nto = 2.0\n{law}\n")
                .parse()
                .expect("valid");
            for nu in [0.01, 0.1, 0.5, 1.0, 1.7, 1.99] {
                let (found, wanted) = (target.at(nu), (nu / 2.0_f64).powf(exponent));
                assert!((found - wanted).abs() < 3e-3 * wanted, "{exponent} {nu}");
            }
        }
    }
}
