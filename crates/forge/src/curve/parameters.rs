//! Curves as parameters of a table's history.

use super::Target;

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
