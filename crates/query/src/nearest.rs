//! The query for the points nearest to a place.

use strew_catalog::{Catalog, Dimension, field::Allowance};
use strew_encode::Place;
use strew_error::{Checked, Error, Together as _};

use super::{
    Set, Values,
    parameters::{AT, K, RADIUS},
    space::SPACE_AT,
};

/// A query for the points nearest to a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    pub at: Place,
    /// The most points; by default 1, or all within the radius.
    pub k: Option<usize>,
    /// The largest distance; unlimited by default.
    pub radius: Option<f64>,
}

fn place(values: &Values) -> Checked<Place> {
    match values.dimension() {
        Dimension::Plane => values.require(&AT).map(Place::Plane),
        Dimension::Space => values.require(&SPACE_AT).map(Place::Space),
    }
}

impl Nearest {
    pub fn of(values: &Values) -> Checked<Self> {
        let (at, k, radius) =
            (place(values), values.get::<u64>(&K), values.get(&RADIUS)).together()?;
        Ok(Self {
            at,
            k: k.map(|k| usize::try_from(k).unwrap_or(usize::MAX)),
            radius,
        })
    }

    pub fn of_set(values: &Values, catalog: &Catalog) -> Result<(Box<Set>, Self), Error> {
        Self::of_set_within(values, catalog, Allowance::UNLIMITED)
    }

    /// As [`of_set`](Self::of_set), with no more than is allowed.
    pub fn of_set_within(
        values: &Values,
        catalog: &Catalog,
        allowance: Allowance<'_>,
    ) -> Result<(Box<Set>, Self), Error> {
        match (
            Self::of(values),
            Set::single_within(values, catalog, allowance),
        ) {
            (Ok(nearest), set) => Ok((set?, nearest)),
            (Err(faults), Err(Error::Invalid(others))) => Err(faults.and(others).into()),
            (Err(faults), _) => Err(faults.into()),
        }
    }
}
