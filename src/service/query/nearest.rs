//! Which points near a place are wanted.

use super::{
    Checked, Together as _, Values,
    parameters::{AT, K, RADIUS},
};

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
}
