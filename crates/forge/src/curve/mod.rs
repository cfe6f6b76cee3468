//! Radial power curves: what a spectrum should be.
//!
//! A [`Target`] is read by `text`: from lines of two numbers, or pieces in TOML. The history of a table records its
//! curve in numbers, too. [`LeastCorrelation`] shows whether a point set can have the curve at all.

use crate::ForgeError;

mod correlation;
mod text;

pub use correlation::LeastCorrelation;
pub(crate) use correlation::total_correlation;
pub(crate) use text::{from_parameters, to_parameters};

/// A curve that a radial power spectrum should follow.
///
/// It consists of straight lines between points (ν, power). Before the first point it has the power
/// of that point, after the last it is 1, as for every set without long-range order. Two points of
/// equal ν make a jump.
///
/// As text it has one of two forms. Text that begins with a number is the first, text that begins
/// with a name or a bracket the second.
/// - Each line holds a point: ν and power, separated by spaces, tabs or a comma. `#` begins a
///   comment.
/// - TOML with consecutive pieces: `[[piece]]` with `from` and `to`, and one of `power = P`
///   (constant), `power = [P0, P1]` (linear) and `law = { power = P, at = N, exponent = E }`, which
///   is P·(ν/N)^E, approximated by straight lines to within 0.3 %.
///
/// ```
/// use strew_forge::Target;
///
/// let step: Target = "# nu power\n0 0\n0.55 0\n0.55 1".parse()?;
/// assert_eq!((step.at(0.3), step.at(0.6), step.at(9.0)), (0.0, 1.0, 1.0));
/// assert_eq!(step.to_string().parse::<Target>()?, step);
/// let pieces: Target = "[[piece]]\nfrom = 0\nto = 0.55\npower = 0".parse()?;
/// assert_eq!((pieces.at(0.3), pieces.at(0.6)), (0.0, 1.0));
/// # Ok::<(), strew_forge::ForgeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    points: Vec<[f64; 2]>,
}

/// `Eq` holds because no power is NaN.
impl Eq for Target {}

/// The largest ν of a point of a curve.
pub const MAX_NU: f64 = 4.0;
/// The largest power of a point of a curve.
pub const MAX_POWER: f64 = 100.0;
/// The largest number of points of a curve.
pub const MAX_POINTS: usize = 1_000;

/// The error for a curve that is not allowed.
pub(super) fn refuse(value: String, allowed: String) -> ForgeError {
    ForgeError::field("target", value, allowed)
}

impl Target {
    /// The curve through these points.
    ///
    /// # Errors
    /// [`ForgeError::Field`] unless there are 1 to [`MAX_POINTS`] points, ν ascends from point to
    /// point within 0 to [`MAX_NU`], and every power is within 0 to [`MAX_POWER`].
    pub fn new(points: Vec<[f64; 2]>) -> Result<Self, ForgeError> {
        if points.is_empty() || points.len() > MAX_POINTS {
            let value = format!("a curve of {} points", points.len());
            return Err(refuse(value, format!("1 to {MAX_POINTS} points")));
        }
        let mut last = 0.0;
        for (at, &[nu, power]) in points.iter().enumerate() {
            let point = || format!("point {} ({nu}, {power})", at + 1);
            if !(last..=MAX_NU).contains(&nu) {
                let allowed = format!("nu from {last}, that of the point before, to {MAX_NU}");
                return Err(refuse(point(), allowed));
            }
            if !(0.0..=MAX_POWER).contains(&power) {
                return Err(refuse(point(), format!("power from 0 to {MAX_POWER}")));
            }
            last = nu;
        }
        Ok(Self { points })
    }

    /// The points (ν, power).
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Returns the power at ν; at a jump, the power after it.
    pub fn at(&self, nu: f64) -> f64 {
        let after = self.points.partition_point(|p| p[0] <= nu);
        match (
            after.checked_sub(1).map(|i| self.points[i]),
            self.points.get(after),
        ) {
            (None, Some(first)) => first[1],
            (Some([nu0, power0]), Some([nu1, power1])) => {
                power0 + (power1 - power0) * ((nu - nu0) / (nu1 - nu0))
            }
            // The last point itself belongs to the curve.
            (Some([last, power]), None) if nu == last => power,
            _ => 1.0,
        }
    }

    /// The end of the quiet band, which begins at ν = 0 and has power 0, if there is one.
    pub fn quiet_end(&self) -> Option<f64> {
        let quiet = self.points.iter().take_while(|p| p[1] == 0.0);
        quiet.last().map(|p| p[0])
    }

    /// The ν of the last point, beyond which the power is 1.
    pub fn end(&self) -> f64 {
        self.points.last().map_or(0.0, |p| p[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_has_lines_jumps_and_an_end() {
        let target: Target = "0.1 4\n0.3, 2 # falls\n\n0.5\t2\n0.5 0.5\n"
            .parse()
            .expect("valid");
        for (nu, power) in [
            (0.0, 4.0),
            (0.1, 4.0),
            (0.2, 3.0),
            (0.4, 2.0),
            (0.5, 0.5),
            (0.51, 1.0),
        ] {
            assert!(
                (target.at(nu) - power).abs() < 1e-12,
                "{nu}: {}",
                target.at(nu)
            );
        }
        assert_eq!(target.end(), 0.5);
    }
}
