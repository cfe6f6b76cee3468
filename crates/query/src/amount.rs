//! How densely points lie, in one of four ways.

use serde::Serialize;
use strew_error::{Checked, Fault};

use super::{
    Parameter, Values,
    parameter::Group,
    parameters::{COUNT, DENSITY, MIN_DISTANCE, SPACING},
};

/// A checked amount. The last two become a spacing with the table at hand.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Amount {
    /// Points per unit of area.
    Density(f64),
    Spacing(f64),
    MinDistance(f64),
    Count(u64),
}

impl Amount {
    pub(super) fn of(values: &Values) -> Checked<Self> {
        match values.two_of(&AMOUNTS) {
            [None, _] => {
                Err(Fault::missing(&format!("{}spacing", values.path()), one_of(values)).into())
            }
            [Some(only), None] if *only == DENSITY => values.require(only).map(Self::Density),
            [Some(only), None] if *only == SPACING => values.require(only).map(Self::Spacing),
            [Some(only), None] if *only == MIN_DISTANCE => {
                values.require(only).map(Self::MinDistance)
            }
            [Some(only), None] => values.require(only).map(Self::Count),
            [Some(first), Some(second)] => {
                let field = format!("{}{}", values.path(), second.name);
                let detail = format!("{} is given, too", first.name);
                Err(Fault::new(&field, values.text(second), detail, one_of(values)).into())
            }
        }
    }

    pub fn parameter(self) -> &'static Parameter {
        match self {
            Self::Density(_) => &DENSITY,
            Self::Spacing(_) => &SPACING,
            Self::MinDistance(_) => &MIN_DISTANCE,
            Self::Count(_) => &COUNT,
        }
    }
}

const AMOUNTS: [Group; 2] = [Group::Amount, Group::Count];

fn one_of(values: &Values) -> String {
    let taken = values.takes();
    let taken = taken.filter(|parameter| AMOUNTS.contains(&parameter.group));
    let names: Vec<&str> = taken.map(|parameter| parameter.name).collect();
    format!("one of {}", names.join(", "))
}
