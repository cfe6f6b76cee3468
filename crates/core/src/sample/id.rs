//! Point ids: lattice addresses.

use core::{fmt, str::FromStr};

/// The stable id of a point: its lattice address under the query's parameters. As text `x:y`, two
/// decimal integers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(C)]
pub struct PointId {
    /// The lattice column.
    pub x: i64,
    /// The lattice row.
    pub y: i64,
}

/// A text that is not a point id.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a point id is two integers joined by a colon, such as -31:52")]
pub struct PointIdError;

impl fmt::Display for PointId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.x, self.y)
    }
}

impl FromStr for PointId {
    type Err = PointIdError;

    fn from_str(text: &str) -> Result<Self, PointIdError> {
        let (x, y) = text.split_once(':').ok_or(PointIdError)?;
        // One id has one text: no plus sign, no leading zeros, no minus zero.
        let id = Self {
            x: x.parse().map_err(|_| PointIdError)?,
            y: y.parse().map_err(|_| PointIdError)?,
        };
        let canonical = alloc::format!("{id}") == text;
        canonical.then_some(id).ok_or(PointIdError)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_round_trips_and_is_unique() {
        for (x, y) in [(0, 0), (-31, 52), (i64::MIN, i64::MAX)] {
            let id = PointId { x, y };
            assert_eq!(alloc::format!("{id}").parse(), Ok(id));
        }
        for bad in [
            "",
            ":",
            "1",
            "1:",
            "1:2:3",
            "+1:2",
            "01:2",
            "-0:2",
            " 1:2",
            "1:99999999999999999999",
        ] {
            assert_eq!(bad.parse::<PointId>(), Err(PointIdError), "{bad}");
        }
    }
}
