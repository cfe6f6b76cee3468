//! The checked parts of a table.

use alloc::{format, string::String, vec::Vec};

use super::{Displacement, FRACTION_BITS, MAX_DISPLACEMENT, Mix, Provenance, Ranks, to_grid_units};
use crate::{
    error::{Error, ErrorKind, number, quoted},
    map::Map,
};

/// The content of a table: everything but its digest.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parts {
    pub(super) map: Map,
    pub(super) profile: String,
    /// n² vectors, row = interval of dY, column = interval of dX.
    pub(super) displacements: Vec<Displacement>,
    pub(super) provenance: Provenance,
    /// A position for each block.
    pub(super) ranks: Option<Ranks>,
    /// A mix of this map.
    pub(super) mix: Option<Mix>,
}

impl Parts {
    /// Refuses a wrong number of vectors, vectors that are too long, a profile name that is not
    /// allowed, and a history beyond the format's limits.
    pub(super) fn check(&self) -> Result<(), Error> {
        let refused = |field, value: String, allowed: String| {
            Err(Error::new(ErrorKind::Table, field, value, allowed))
        };
        let expected = self.map.intervals() * self.map.intervals();
        if self.displacements.len() != expected {
            let value = format!("{} vectors", self.displacements.len());
            let allowed = format!("{expected} vectors, the number of blocks");
            return refused("displacements", value, allowed);
        }
        let limit = (MAX_DISPLACEMENT as i32) << FRACTION_BITS;
        let too_long = |d: &Displacement| d.iter().any(|v| !(-limit < *v && *v < limit));
        if let Some(block) = self.displacements.iter().position(too_long) {
            let [x, y] = self.displacements[block].map(to_grid_units);
            let most = number(MAX_DISPLACEMENT);
            let allowed = format!("less than {most} grid units along an axis");
            return refused(
                "displacements",
                format!("({}, {}) in block {block}", number(x), number(y)),
                allowed,
            );
        }
        check_profile(&self.profile)?;
        if let Some(ranks) = &self.ranks
            && ranks.positions().len() != expected
        {
            let value = format!("{} positions", ranks.positions().len());
            let allowed = format!("{expected} positions, the number of blocks");
            return refused("ranks", value, allowed);
        }
        if let Some(mix) = &self.mix
            && Mix::new(&self.map, mix.shares().clone(), mix.labels().to_vec())? != *mix
        {
            let (value, allowed) = ("of another map".into(), "a mix of the table's map".into());
            return refused("mix", value, allowed);
        }
        self.provenance.check()
    }
}

/// Refuses the name of a profile that is not allowed.
pub(super) fn check_profile(profile: &str) -> Result<(), Error> {
    let is_allowed = |c: u8| c.is_ascii_lowercase() || c.is_ascii_digit() || c == b'-';
    if (1..=32).contains(&profile.len()) && profile.bytes().all(is_allowed) {
        return Ok(());
    }
    let allowed = "1 to 32 characters of a-z, 0-9 and -";
    let value = quoted(profile);
    Err(Error::new(ErrorKind::Table, "profile", value, allowed))
}
