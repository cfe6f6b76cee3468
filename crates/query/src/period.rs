//! Periods: the points of one exact period instead of those of a region.

use schemars::JsonSchema;
use serde::Serialize;
use strew_catalog::{Catalog, Entry};
use strew_core::{Map, PeriodicSet, Region, Spacing, map::Twin};
use strew_error::{Checked, Error, Fault, Together as _};

use crate::{
    amount::Amount,
    parameters::{MOST, PERIODIC},
    region_check::QueryRegion,
    rules, table,
    values::Values,
};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period {
    pub least: u64,
    pub twin: Twin,
    pub side: f64,
}

impl Period {
    pub(super) fn check(values: &Values, amount: Amount, entry: &Entry) -> Checked<Option<Self>> {
        let Some(least) = values.get::<u64>(&PERIODIC)? else {
            return Ok(None);
        };
        rules::check(values, &PERIODIC)?;
        let parameter = amount.parameter();
        let fault = |detail: String, allowed: &str| {
            let field = format!("{}{}", values.path(), parameter.name);
            Fault::new(&field, values.text(parameter), detail, allowed)
        };
        let spacing = match amount {
            Amount::Spacing(spacing) => Spacing::new(spacing),
            Amount::Density(density) => Spacing::from_density(density),
            Amount::MinDistance(_) | Amount::Count(_) => return Ok(None),
        };
        let spacing = spacing.map_err(|error| fault(error.to_string(), &parameter.allowed()))?;
        let twin = twin(entry, least).map_err(|detail| values.fault(&PERIODIC, detail))?;
        let side = spacing.get() * twin.t() as f64;
        if !(1e-100..=1e100).contains(&side) {
            let detail = format!("the side of the period would be {side:e}");
            return Err(fault(detail, "an amount with a side from 1e-100 to 1e100").into());
        }
        Ok(Some(Self { least, twin, side }))
    }

    pub(super) fn region(&self) -> Checked<QueryRegion> {
        let bounds = Region::new([0.0; 2], [self.side; 2])
            .map_err(|error| Fault::new(PERIODIC.name, self.least, error.to_string(), ""))?;
        Ok(QueryRegion {
            path: PERIODIC.name.into(),
            area: bounds.into(),
            bounds,
            volume: None,
            echo: None,
            corner: None,
        })
    }
}

/// The periods of the map of a table, smallest first.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Periods {
    /// The number α.
    pub alpha: String,
    /// The size of the map.
    pub map: String,
    /// The half-width R of the map, in grid units.
    pub radius: u32,
    /// The greatest number of points of a period.
    pub most_points: u64,
    /// The periods; their sides are in mean spacings.
    pub periods: Vec<PeriodEcho>,
}

impl Periods {
    /// The periods that some values request: those with at least a number of points, and at most a number of them.
    pub fn of(values: &Values, catalog: &Catalog) -> Result<Self, Error> {
        /// The length of a list that none is given for.
        const MANY: u64 = 100;
        let ((), least, most, (entry, pin)) = (
            values.read(),
            values.get::<u64>(&PERIODIC),
            values.get::<u64>(&MOST),
            table::check(values, None, catalog),
        )
            .together()?;
        table::hold(&entry, pin.as_deref())?;
        let map = Map::new(entry.key.alpha, entry.radius)
            .map_err(|_| Error::Internal("a loaded table has no map"))?;
        let periods = PeriodicSet::periods_from(&map, least.unwrap_or(1));
        let most = usize::try_from(most.unwrap_or(MANY)).unwrap_or(usize::MAX);
        Ok(Self {
            alpha: entry.key.alpha.to_string(),
            map: entry.key.size.to_string(),
            radius: entry.radius,
            most_points: PeriodicSet::MAX_POINTS,
            periods: periods
                .take(most)
                .map(|twin| PeriodEcho::new(twin, twin.t() as f64))
                .collect(),
        })
    }
}

/// The smallest period of a table's map with at least some points.
fn twin(entry: &Entry, least: u64) -> Result<Twin, String> {
    let key = &entry.key;
    let map = Map::new(key.alpha, entry.radius).map_err(|error| error.to_string())?;
    let twin = PeriodicSet::periods_from(&map, least).next();
    twin.ok_or_else(|| {
        let limit = PeriodicSet::MAX_POINTS;
        match PeriodicSet::periods(&map).next() {
            None => format!("the map of alpha {} has no periods", key.alpha),
            Some(_) => format!(
                "no period of alpha {} and map {} has this number of points or more, up to {limit}",
                key.alpha, key.size
            ),
        }
    })
}

/// A period as answers echo it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Period")]
pub struct PeriodEcho {
    /// The fraction p/q, near α, whose pattern has the period.
    pub p: u64,
    /// Its denominator.
    pub q: u64,
    /// The number of points of the period, before any are left out.
    pub points: u64,
    /// The side L, in world units.
    pub side: f64,
}

impl Period {
    pub const fn echo(self) -> PeriodEcho {
        PeriodEcho::new(self.twin, self.side)
    }
}

impl PeriodEcho {
    const fn new(twin: Twin, side: f64) -> Self {
        Self {
            p: twin.p(),
            q: twin.q(),
            points: twin.points(),
            side,
        }
    }
}
