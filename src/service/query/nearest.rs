//! Which points near a place are wanted.

use super::{
    Checked, Set, Together as _, Values,
    parameters::{AT, K, RADIUS},
};
use crate::service::{Catalog, Error, field::Allowance};

/// Which points near a place are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The place.
    pub at: [f64; 2],
    /// How many at most; by default 1, or all within the radius.
    pub k: Option<usize>,
    /// How far away at most; unlimited by default.
    pub radius: Option<f64>,
}

impl Nearest {
    /// Checks the values that say it.
    ///
    /// # Errors
    /// Every fault.
    pub fn of(values: &Values) -> Checked<Self> {
        let (at, k, radius) = (
            values.require(&AT),
            values.get::<u64>(&K),
            values.get(&RADIUS),
        )
            .together()?;
        Ok(Self {
            at,
            k: k.map(|k| usize::try_from(k).unwrap_or(usize::MAX)),
            radius,
        })
    }

    /// Checks the values that say it and the set.
    ///
    /// # Errors
    /// As [`Set::single`], with every fault of both.
    pub fn of_set(values: &Values, catalog: &Catalog) -> Result<(Set, Self), Error> {
        Self::of_set_within(values, catalog, Allowance::UNLIMITED)
    }

    /// As [`of_set`](Self::of_set), with no more than is allowed.
    ///
    /// # Errors
    /// As [`Set::single_within`].
    pub fn of_set_within(
        values: &Values,
        catalog: &Catalog,
        allowance: Allowance<'_>,
    ) -> Result<(Set, Self), Error> {
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
