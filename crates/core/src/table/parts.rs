//! The checked parts of a table.

use alloc::{format, string::String, vec::Vec};

use super::{Mix, Provenance, Ranks, vector::Vector};
use crate::{
    error::{Error, ErrorKind, quoted},
    map::Map,
};

/// The content of a table: everything but its digest.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts<V> {
    pub(crate) map: Map,
    pub(crate) profile: String,
    /// A vector for each block: along x first, then along y, and then along z in space.
    pub(crate) vectors: Vec<V>,
    pub(crate) provenance: Provenance,
    /// A position for each block.
    pub(crate) ranks: Option<Ranks>,
    /// A mix of this map, in the plane.
    pub(crate) mix: Option<Mix>,
}

impl<V: Vector> Parts<V> {
    /// The number of blocks of a map.
    pub(crate) fn blocks(map: &Map) -> usize {
        map.intervals().pow(V::AXES)
    }

    /// Refuses a wrong number of vectors, vectors that are too long, a profile name that is not
    /// allowed, and a history beyond the format's limits.
    pub(super) fn check(&self) -> Result<(), Error> {
        let refused = |field, value: String, allowed: String| {
            Err(Error::new(ErrorKind::Table, field, value, allowed))
        };
        let expected = Self::blocks(&self.map);
        if self.vectors.len() != expected {
            let value = format!("{} vectors", self.vectors.len());
            let allowed = format!("{expected} vectors, the number of blocks");
            return refused("displacements", value, allowed);
        }
        let mut vectors = self.vectors.iter().enumerate();
        let long = vectors.find_map(|(block, vector)| Some((block, vector.too_long()?)));
        if let Some((block, [vector, allowed])) = long {
            return refused(
                "displacements",
                format!("{vector} in block {block}"),
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
fn check_profile(profile: &str) -> Result<(), Error> {
    let is_allowed = |c: u8| c.is_ascii_lowercase() || c.is_ascii_digit() || c == b'-';
    if (1..=32).contains(&profile.len()) && profile.bytes().all(is_allowed) {
        return Ok(());
    }
    let allowed = "1 to 32 characters of a-z, 0-9 and -";
    let value = quoted(profile);
    Err(Error::new(ErrorKind::Table, "profile", value, allowed))
}
