//! Curves written as pieces, in TOML.
//!
//! A power law such as ν^(−3/4) takes many lines of two numbers, but only one piece:
//!
//! ```toml
//! [[piece]]            # no power
//! from = 0
//! to = 0.1
//! power = 0
//!
//! [[piece]]            # a linear rise; where pieces meet, the curve may jump
//! from = 0.1
//! to = 0.2
//! power = [0.5, 2]
//!
//! [[piece]]            # power · (ν / at)^exponent
//! from = 0.2
//! to = 1.5
//! law = { power = 1, at = 1, exponent = -0.75 }
//! ```

use serde::Deserialize;

use super::{MAX_NU, MAX_POINTS, MAX_POWER, Target, target::refuse};
use crate::ForgeError;

/// The ways to state the power of a piece.
const KINDS: &str = "one of `power = P`, `power = [P0, P1]` and \
                     `law = { power = P, at = NU, exponent = E }`";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default)]
    piece: Vec<Piece>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Piece {
    from: f64,
    to: f64,
    power: Option<Power>,
    law: Option<Law>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "a number, or two numbers in brackets")]
enum Power {
    Level(f64),
    Ramp([f64; 2]),
}

/// Parses a curve written as pieces.
///
/// # Errors
/// [`ForgeError::Field`] for text that is not TOML or has unknown keys, with the line; for gaps,
/// overlaps and numbers out of range, with the piece.
pub(super) fn read(text: &str) -> Result<Target, ForgeError> {
    let document: Document = toml::from_str(text).map_err(|error| {
        let before = error.span().and_then(|span| text.get(..span.start));
        let line = before.map_or(1, |before| before.matches('\n').count() + 1);
        let message = error.message().trim().replace('\n', "; ");
        refuse(
            format!("not a curve in pieces (line {line}: {message})"),
            format!("`[[piece]]` with `from`, `to` and {KINDS}; or lines of two numbers"),
        )
    })?;
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut reached = None;
    for (at, piece) in document.piece.iter().enumerate() {
        let number = at + 1;
        piece.check(number, reached)?;
        reached = Some(piece.to);
        for point in piece.points(number)? {
            // Pieces that meet without a jump share a point.
            if points.last() != Some(&point) {
                points.push(point);
            }
        }
        if points.len() > MAX_POINTS {
            return Err(refuse(
                format!("a curve of more than {MAX_POINTS} points after piece {number}"),
                "fewer pieces, or laws over shorter ranges".into(),
            ));
        }
    }
    Target::new(points)
}

impl Piece {
    /// Refuses a piece that does not begin where the last one ended, has a bad range, or does not
    /// state its power in exactly one way. `number` counts pieces from 1.
    fn check(&self, number: usize, reached: Option<f64>) -> Result<(), ForgeError> {
        let Self { from, to, .. } = *self;
        let wrong = |value: String, allowed: String| {
            Err(refuse(format!("piece {number} with {value}"), allowed))
        };
        if let Some(end) = reached.filter(|end| *end != from) {
            let what = if from > end { "a gap" } else { "an overlap" };
            let allowed = format!("from = {end}, where piece {} ends", number - 1);
            return wrong(format!("from = {from}, {what}"), allowed);
        }
        if !(0.0..MAX_NU).contains(&from) {
            return wrong(format!("from = {from}"), format!("0 to less than {MAX_NU}"));
        }
        if !(to > from && to <= MAX_NU) {
            let allowed = format!("more than from = {from}, and at most {MAX_NU}");
            return wrong(format!("to = {to}"), allowed);
        }
        match (&self.power, &self.law) {
            (None, None) => wrong("neither `power` nor `law`".into(), KINDS.into()),
            (Some(_), Some(_)) => wrong("both `power` and `law`".into(), KINDS.into()),
            _ => Ok(()),
        }
    }

    /// The points of the curve in this piece.
    fn points(&self, number: usize) -> Result<Vec<[f64; 2]>, ForgeError> {
        let points = match (&self.power, self.law) {
            (Some(Power::Level(power)), _) => vec![[self.from, *power], [self.to, *power]],
            (Some(Power::Ramp([first, last])), _) => vec![[self.from, *first], [self.to, *last]],
            (None, Some(law)) => law.points(self.from, self.to, number)?,
            (None, None) => Vec::new(),
        };
        match points.iter().find(|p| !(0.0..=MAX_POWER).contains(&p[1])) {
            None => Ok(points),
            Some([nu, power]) => Err(refuse(
                format!("piece {number} with power {power} at nu = {nu}"),
                format!("power from 0 to {MAX_POWER}"),
            )),
        }
    }
}

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

    fn piece(text: &str) -> String {
        format!("[[piece]]\n{text}\n")
    }

    #[test]
    fn levels_ramps_and_laws_join() {
        let text = piece("from = 0.0\nto = 0.5\npower = 0")
            + &piece("from = 0.5\nto = 1\npower = [0.5, 2.0]")
            + &piece("from = 1\nto = 3\nlaw = { power = 2, at = 1, exponent = -0.75 }");
        let target: Target = text.parse().expect("valid");
        for (nu, power) in [
            (0.0, 0.0),
            (0.49, 0.0),
            (0.5, 0.5),
            (0.75, 1.25),
            (2.0, 2.0 * 2.0_f64.powf(-0.75)),
            (2.71, 2.0 * 2.71_f64.powf(-0.75)),
            (3.001, 1.0),
        ] {
            let found = target.at(nu);
            assert!((found - power).abs() < 2e-3, "{nu}: {found} {power}");
        }
        let again: Target = target.to_string().parse().expect("valid");
        assert_eq!(again, target);
    }

    #[test]
    fn pieces_that_meet_without_a_jump_share_a_point() {
        let text = piece("from = 0\nto = 0.5\npower = 0") + &piece("from = 0.5\nto = 1\npower = 1");
        let target: Target = text.parse().expect("valid");
        assert_eq!(
            target.points(),
            [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [1.0, 1.0]]
        );
        let one = piece("from = 0\nto = 0.5\npower = 0") + &piece("from = 0.5\nto = 1\npower = 0");
        assert_eq!(one.parse::<Target>().expect("valid").points().len(), 3);
    }

    #[test]
    fn bad_pieces_are_refused_with_number_value_and_allowed_range() {
        // The lines of a piece, and words of the error.
        let pieces = r#"
            from = 1; to = 1; power = 1 => piece 1 | to = 1 | more than from = 1
            from = 0; to = 5; power = 1 => piece 1 | to = 5 | at most 4
            from = -1; to = 1; power = 1 => piece 1 | from = -1 | 0 to
            from = nan; to = 1; power = 1 => piece 1 | from = NaN | 0 to
            from = 0; to = 1; power = -1 => piece 1 | power -1 | 0 to 100
            from = 0; to = 1; power = [0, 1000] => piece 1 | power 1000 | 0 to 100
            from = 0; to = 1; power = [0, 1, 2] => line 4 | two numbers | [[piece]]
            from = 0; to = 1; power = "x" => line 4 | two numbers | [[piece]]
            from = 0; to = 1 => piece 1 | neither | exponent
            from = 0; to = 1; powr = 1 => line 4 | powr | [[piece]]
            from = 0; power = 1 => missing | `to` | [[piece]]
            from = 0; to = 1; law = { power = 1, at = 1 } => line 4 | exponent | [[piece]]
            from = 0; to = 1; law = { power = 1, at = 1, exponent = -1 } => exponent = -1 | 0 or more
            from = 0; to = 1; law = { power = 1, at = 1, exponent = 9 } => exponent = 9 | -8 to 8
            from = 0; to = 1; law = { power = 1, at = 0, exponent = 1 } => at = 0 | more than 0
            from = 0.001; to = 1; law = { power = 1, at = 1, exponent = -2 } => power 1000000 | 0 to 100
            from = 0; to = 1; power = 1; law = { power = 1, at = 1, exponent = 0 } => both | one of
            from = 0; to = 0.5; power = 0; [[piece]]; from = 0.6; to = 1; power = 1 => piece 2 | 0.6, a gap | from = 0.5
            from = 0; to = 0.5; power = 0; [[piece]]; from = 0.4; to = 1; power = 1 => piece 2 | 0.4, an overlap | from = 0.5"#;
        let cases = pieces.trim().lines().map(|line| {
            let (lines, words) = line.split_once(" => ").expect("a case");
            (piece(&lines.trim().replace("; ", "\n")), words)
        });
        let others = [
            ("[piece", "line 1 | not a curve in pieces | [[piece]]"),
            ("hue = 3", "line 1 | hue | [[piece]]"),
            ("[curve]\n", "line 1 | curve | [[piece]]"),
        ];
        let others = others.map(|(text, words)| (text.to_owned(), words));
        for (text, words) in cases.chain(others) {
            let error = text.parse::<Target>().expect_err(&text).to_string();
            let is_said = words.split(" | ").all(|word| error.contains(word));
            assert!(
                is_said && error.starts_with("target is "),
                "{text}: {error}"
            );
        }
    }

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
