//! Curves as text: reading both forms, writing lines of two numbers, and as parameters of a table's history.

use std::{fmt, str::FromStr};

use super::{MAX_POINTS, Target, pieces, target::refuse};
use crate::ForgeError;

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
            return pieces::read(text);
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
    use super::*;

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
