//! Curves as text: lines of two numbers, which a table's history has as parameters, too, and pieces in TOML.
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

use std::{fmt, str::FromStr};

use serde::Deserialize;

use super::{MAX_NU, MAX_POINTS, MAX_POWER, Target, refuse};
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
pub(super) fn read_pieces(text: &str) -> Result<Target, ForgeError> {
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

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for [nu, power] in self.points() {
            writeln!(f, "{nu} {power}")?;
        }
        Ok(())
    }
}

impl FromStr for Target {
    type Err = ForgeError;

    fn from_str(text: &str) -> Result<Self, ForgeError> {
        let mut contents = text
            .lines()
            .map(|line| line.split('#').next().unwrap_or_default());
        let first = contents.find_map(|content| content.trim().chars().next());
        if first.is_some_and(|c| c == '[' || c == '"' || c.is_ascii_alphabetic()) {
            return read_pieces(text);
        }
        let mut points = Vec::new();
        for (number, line) in text.lines().enumerate() {
            let content = line.split('#').next().unwrap_or_default().trim();
            if content.is_empty() {
                continue;
            }
            let columns: Vec<&str> = content
                .split(|c: char| c == ',' || c.is_whitespace())
                .filter(|column| !column.is_empty())
                .collect();
            let numbers: Option<Vec<f64>> = columns.iter().map(|c| c.parse().ok()).collect();
            match numbers.as_deref() {
                Some(&[nu, power]) => points.push([nu, power]),
                _ => {
                    let shown: String = content.chars().take(60).collect();
                    let value = format!("{shown:?} on line {}", number + 1);
                    let allowed = "two numbers in each line: nu and power";
                    return Err(refuse(value, allowed.into()));
                }
            }
            if points.len() > MAX_POINTS {
                break;
            }
        }
        Self::new(points)
    }
}

/// The name of the parameter that holds a curve. Further parts are `target_2`, `target_3`, ….
const PARAMETER: &str = "target";
/// The length from which on a curve is split into parts.
const PARAMETER_BYTES: usize = 800;

/// Writes a curve as parameters of a history, (name, value): `nu power` separated by semicolons, in
/// parts of moderate length.
pub(crate) fn to_parameters(target: &Target) -> Vec<(String, String)> {
    let mut parts = vec![String::new()];
    for [nu, power] in target.points() {
        let point = format!("{nu} {power}");
        match parts.last_mut() {
            Some(part) if part.is_empty() => part.push_str(&point),
            Some(part) if part.len() + point.len() < PARAMETER_BYTES => {
                part.push_str("; ");
                part.push_str(&point);
            }
            _ => parts.push(point),
        }
    }
    let name = |part: usize| match part {
        0 => PARAMETER.to_owned(),
        more => format!("{PARAMETER}_{}", more + 1),
    };
    let named = parts.into_iter().enumerate();
    named.map(|(part, text)| (name(part), text)).collect()
}

/// Reads the curve of a history. Returns `None` if there is none, or none that can be read.
pub(crate) fn from_parameters(parameters: &[(String, String)]) -> Option<Target> {
    let is_part = |name: &str| {
        let rest = name.strip_prefix(PARAMETER);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
    };
    let parts = parameters.iter().filter(|(name, _)| is_part(name));
    let lines: Vec<String> = parts.map(|(_, text)| text.replace(';', "\n")).collect();
    if lines.is_empty() {
        return None;
    }
    lines.join("\n").parse().ok()
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

    #[test]
    fn bad_curves_are_refused_with_line_or_point() {
        for (text, words) in [
            ("", "0 points"),
            ("0 1\n0.5 x", "line 2"),
            ("0 1 2", "two numbers"),
            ("0.5 1\n0.4 1", "point 2"),
            ("0 -1", "power from 0"),
            ("0 nan", "power from 0"),
            ("5 1", "to 4"),
        ] {
            let error = text.parse::<Target>().expect_err("refused").to_string();
            assert!(error.contains(words), "{text:?}: {error}");
        }
    }
}
