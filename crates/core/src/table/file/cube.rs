//! Files of tables of points in space: `CUBE` in place of `DISP`.
//!
//! `CUBE` has n³ triples of `i16`, in units of 2⁻¹² grid units: the block (i, j, k) of the intervals of dX, dY and dZ
//! is number (k·n + j)·n + i. All else is as in the plane.

use alloc::{format, string::String, vec, vec::Vec};

use super::{
    layout::{CUBE, DIGEST_BYTES, HEADER_BYTES, MIX, RANKS, check_size},
    read::{HeadSection, read_prov, read_rank, sections, wrong},
    write::{framed, head, prov, rank},
};
use crate::{
    error::{Error, ErrorKind},
    map::Map,
    table::{Digest, Provenance, Ranks, parts::check_profile},
};

/// The content of a table of points in space.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CubeParts {
    pub(crate) map: Map,
    pub(crate) profile: String,
    /// n³ vectors, in units of 2⁻¹² grid units.
    pub(crate) vectors: Vec<[i16; 3]>,
    pub(crate) provenance: Provenance,
    /// A position for each block.
    pub(crate) ranks: Option<Ranks>,
}

impl CubeParts {
    /// Reads and checks a file.
    pub(crate) fn read(bytes: &[u8]) -> Result<(Self, Digest), Error> {
        let (found, digest) = sections(bytes)?;
        let missing = |tag: &[u8]| wrong(tag, HEADER_BYTES, "missing".into());
        let (head, head_at) = found.head.ok_or_else(|| missing(b"HEAD"))?;
        let (prov, prov_at) = found.prov.ok_or_else(|| missing(b"PROV"))?;
        let (cube, cube_at) = found.cube.ok_or_else(|| missing(&CUBE))?;
        for (tag, section) in [(b"DISP", found.disp), (&MIX, found.kind)] {
            if let Some((_, at)) = section {
                return Err(wrong(tag, at, "not of a table of points in space".into()));
            }
        }
        let head = HeadSection::read(head, head_at)?;
        let map = head.map(head_at)?;
        let blocks = map.intervals().pow(3);
        let vectors = read_vectors(cube, blocks).map_err(|p| wrong(&CUBE, cube_at, p))?;
        let ranks = found.rank.map(|(bytes, at)| {
            let positions = read_rank(bytes, blocks).map_err(|p| wrong(&RANKS, at, p))?;
            Ranks::new(positions)
        });
        let parts = Self {
            map,
            profile: head.profile,
            vectors,
            provenance: read_prov(prov).map_err(|p| wrong(b"PROV", prov_at, p))?,
            ranks: ranks.transpose()?,
        };
        parts.check()?;
        Ok((parts, digest))
    }

    /// The parts as a file.
    pub(crate) fn write(&self) -> Vec<u8> {
        let mut bytes = self.body();
        let digest = Digest::of(&bytes);
        bytes.extend(digest.as_bytes());
        bytes
    }

    /// The digest of the file that the parts will have.
    pub(crate) fn digest(&self) -> Result<Digest, Error> {
        let body = self.body();
        check_size((body.len() + DIGEST_BYTES) as u64)?;
        Ok(Digest::of(&body))
    }

    fn body(&self) -> Vec<u8> {
        let vectors = self.vectors.iter().flatten();
        let mut sections = vec![
            (*b"HEAD", head(&self.map, &self.profile)),
            (*b"PROV", prov(&self.provenance)),
            (CUBE, vectors.flat_map(|v| v.to_le_bytes()).collect()),
        ];
        sections.extend(self.ranks.as_ref().map(|ranks| (RANKS, rank(ranks))));
        framed(sections)
    }

    /// Refuses a wrong number of vectors or positions, a vector that cannot be turned, a profile name that is not allowed, and a history beyond the
    /// format's limits.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let blocks = self.map.intervals().pow(3);
        let positions = self.ranks.as_ref().map(|ranks| ranks.positions().len());
        let numbers = [
            ("displacements", "vectors", Some(self.vectors.len())),
            ("ranks", "positions", positions),
        ];
        for (field, what, number) in numbers {
            if let Some(number) = number.filter(|&number| number != blocks) {
                let allowed = format!("{blocks} {what}, the number of blocks");
                let value = format!("{number} {what}");
                return Err(Error::new(ErrorKind::Table, field, value, allowed));
            }
        }
        // The opposite of the least number does not fit.
        if let Some(block) = self.vectors.iter().position(|v| v.contains(&i16::MIN)) {
            let value = format!("{:?} in block {block}", self.vectors[block]);
            let allowed = "within ±32767 along each axis";
            return Err(Error::new(
                ErrorKind::Table,
                "displacements",
                value,
                allowed,
            ));
        }
        check_profile(&self.profile)?;
        self.provenance.check()
    }
}

fn read_vectors(bytes: &[u8], blocks: usize) -> Result<Vec<[i16; 3]>, String> {
    if bytes.len() != 6 * blocks {
        let need = 6 * blocks;
        return Err(format!(
            "{} bytes; {blocks} blocks need {need}",
            bytes.len()
        ));
    }
    let number = |bytes: &[u8], at: usize| i16::from_le_bytes([bytes[at], bytes[at + 1]]);
    let vector = |bytes: &[u8]| [0, 2, 4].map(|at| number(bytes, at));
    Ok(bytes.chunks_exact(6).map(vector).collect())
}
