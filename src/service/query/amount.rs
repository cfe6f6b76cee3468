//! How densely points lie, in one of four ways.

use serde::Serialize;
use strew_core::Spacing;

use super::{AMOUNT, number};
use crate::service::Fault;

/// The amount as it was asked for, not checked; exactly one must be there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AmountDraft {
    /// Points per unit of area.
    pub density: Option<f64>,
    /// The mean spacing.
    pub spacing: Option<f64>,
    /// The least distance of any two points.
    pub min_distance: Option<f64>,
    /// The number of points in the region.
    pub count: Option<u64>,
}

/// A checked amount. The last two become a spacing with the table at hand.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Amount {
    /// A density, and the spacing it is.
    Density(f64),
    /// A spacing.
    Spacing(f64),
    /// The least distance of any two points.
    MinDistance(f64),
    /// The number of points in the region.
    Count(u64),
}

impl AmountDraft {
    /// Checks it; `path` is put before the names of fields.
    pub(super) fn check(self, path: &str) -> Result<Amount, Fault> {
        let field = |name: &str| format!("{path}{name}");
        let given = [
            self.density
                .map(|v| ("density", number(v), Amount::Density(v))),
            self.spacing
                .map(|v| ("spacing", number(v), Amount::Spacing(v))),
            self.min_distance
                .map(|v| ("min_distance", number(v), Amount::MinDistance(v))),
            self.count
                .map(|v| ("count", v.to_string(), Amount::Count(v))),
        ];
        let mut given = given.into_iter().flatten();
        let Some((name, value, amount)) = given.next() else {
            return Err(Fault::missing(&field("density"), AMOUNT));
        };
        if let Some((other, second, _)) = given.next() {
            let detail = format!("{name} is given, too, as {value}");
            return Err(Fault::new(&field(other), second, detail, AMOUNT));
        }
        let out_of_range =
            |allowed: String| Fault::new(&field(name), &value, "it is out of range", allowed);
        let spacing = match amount {
            Amount::Density(density) => Spacing::from_density(density),
            Amount::Spacing(spacing) => Spacing::new(spacing),
            Amount::MinDistance(distance) => {
                // Spacings are wider than the distances they keep, but not by much.
                Spacing::new(distance)
            }
            Amount::Count(0) => return Err(out_of_range(COUNT.into())),
            Amount::Count(_) => return Ok(amount),
        };
        spacing
            .map(|_| amount)
            .map_err(|error| out_of_range(error.allowed().to_owned()))
    }
}

/// What a count may be.
pub(super) const COUNT: &str = "an integer from 1 to 18446744073709551615";
