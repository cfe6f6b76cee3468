//! Reading a table file. Checks run from the outside in, so the error names the first thing that does
//! not hold.

use alloc::{format, string::String, vec::Vec};

use super::layout::{
    BASE, CUBE, DIGEST_BYTES, HEADER_BYTES, MIX, RANKS, Reader, check_header, position_bytes,
};
use crate::{
    error::{Error, ErrorKind},
    map::{Map, Twin},
    pattern::Alpha,
    table::{
        Digest, Figures, Mix, Provenance, Ranks, Shares,
        parts::{Parts, Vector},
    },
};

/// The content of a table file, and its digest.
pub(crate) fn read<V: Vector>(bytes: &[u8]) -> Result<(Parts<V>, Digest), Error> {
    let (found, digest) = sections(bytes)?;
    Ok((found.into_parts()?, digest))
}

/// The sections of a file, and its digest.
pub(super) fn sections(bytes: &[u8]) -> Result<(Sections<'_>, Digest), Error> {
    // The digest of this very file. With optional sections that are skipped it is not the digest of the parts when they
    // are written again.
    let (sections, digest) = check_frame(bytes)?;
    let body = &bytes[..bytes.len() - DIGEST_BYTES];

    let mut found = Sections::default();
    let mut at = HEADER_BYTES;
    for _ in 0..sections {
        at = found.add(body, at)?;
    }
    if at != body.len() {
        let problem = format!("{} bytes are left after the last section", body.len() - at);
        return Err(wrong(b"none", at, problem));
    }
    Ok((found, digest))
}

/// Checks the header and the digest. Returns the number of sections, and the digest.
fn check_frame(bytes: &[u8]) -> Result<(u32, Digest), Error> {
    let header = &bytes[..bytes.len().min(HEADER_BYTES)];
    let sections = check_header(bytes.len() as u64, header)?;
    let (body, seal) = bytes.split_at(bytes.len() - DIGEST_BYTES);
    let computed = Digest::of(body);
    if computed.as_bytes() != seal {
        let mut digest = [0; DIGEST_BYTES];
        digest.copy_from_slice(seal);
        let allowed = format!("{}, as its last 32 bytes state", Digest::from_bytes(digest));
        let field = "the digest of the table file";
        let error = Error::new(ErrorKind::Table, field, computed, allowed);
        return Err(error.because("the file is damaged"));
    }
    Ok((sections, computed))
}

/// A section's payload and where it starts.
pub(super) type Payload<'a> = (&'a [u8], usize);

/// The sections that this release knows.
const KNOWN: [[u8; 4]; 7] = [*b"HEAD", *b"PROV", *b"DISP", CUBE, BASE, RANKS, MIX];

/// The known sections of a file by their names.
#[derive(Default)]
pub(super) struct Sections<'a>(Vec<([u8; 4], Payload<'a>)>);

impl<'a> Sections<'a> {
    /// Files the section at `at`. Returns the place after it.
    fn add(&mut self, body: &'a [u8], at: usize) -> Result<usize, Error> {
        let mut reader = Reader::new(&body[at..]);
        let tag = reader
            .array("a section's name")
            .map_err(|p| wrong(b"none", at, p))?;
        let length = reader
            .u64("a section's length")
            .map_err(|p| wrong(&tag, at, p))?;
        let length = usize::try_from(length).unwrap_or(usize::MAX);
        let payload = reader
            .take(length, "its content")
            .map_err(|p| wrong(&tag, at, p))?;
        if KNOWN.contains(&tag) {
            if self.get(&tag).is_some() {
                return Err(wrong(&tag, at, "occurs twice".into()));
            }
            self.0.push((tag, (payload, at + 12)));
        } else if !tag[0].is_ascii_lowercase() {
            return Err(wrong(&tag, at, "unknown to this release".into()));
        }
        Ok(at + 12 + length)
    }

    /// A section that may be missing.
    pub(super) fn get(&self, tag: &[u8; 4]) -> Option<Payload<'a>> {
        let found = self.0.iter().find(|(name, _)| name == tag);
        found.map(|(_, payload)| *payload)
    }

    /// A section that may not be missing.
    pub(super) fn need(&self, tag: &[u8; 4]) -> Result<Payload<'a>, Error> {
        let missing = || wrong(tag, HEADER_BYTES, "missing".into());
        self.get(tag).ok_or_else(missing)
    }

    fn into_parts<V: Vector>(self) -> Result<Parts<V>, Error> {
        for (tag, problem) in V::FOREIGN {
            if let Some((_, at)) = self.get(tag) {
                return Err(wrong(tag, at, (*problem).into()));
            }
        }
        let (head, head_at) = self.need(b"HEAD")?;
        let (prov, prov_at) = self.need(b"PROV")?;
        let (vectors, at) = self.need(&V::SECTION)?;

        let head = HeadSection::read(head, head_at)?;
        let map = head.map(head_at)?;
        let provenance = read_prov(prov).map_err(|p| wrong(b"PROV", prov_at, p))?;
        let blocks = Parts::<V>::blocks(&map);
        let vectors = of_blocks(vectors, blocks, size_of::<V>(), V::read)
            .map_err(|p| wrong(&V::SECTION, at, p))?;
        let ranks = self.get(&RANKS).map(|payload| ranks(payload, blocks));
        let kind = self.get(&MIX).filter(|_| cfg!(feature = "kinds"));
        let mix = kind.map(|payload| mix(payload, &map));
        let parts = Parts {
            map,
            profile: head.profile,
            vectors,
            provenance,
            ranks: ranks.transpose()?,
            mix: mix.transpose()?,
        };
        parts.check()?;
        Ok(parts)
    }
}

/// The error of a section that is wrong at a byte of the file.
pub(super) fn wrong(tag: &[u8], at: usize, problem: String) -> Error {
    let section = format!("section {} of the table file", String::from_utf8_lossy(tag));
    let value = format!("not valid at byte {at}");
    Error::new(ErrorKind::Table, section, value, "").because(problem)
}

/// The section `HEAD`.
pub(super) struct HeadSection {
    pub(super) alpha: Alpha,
    pub(super) radius: u32,
    pub(super) intervals: u32,
    pub(super) profile: String,
}

impl HeadSection {
    /// Reads the section, which begins at byte `at` of the file.
    pub(super) fn read(bytes: &[u8], at: usize) -> Result<Self, Error> {
        let wrong = |problem| wrong(b"HEAD", at, problem);
        let mut reader = Reader::new(bytes);
        let text = reader.text("alpha").map_err(wrong)?;
        let radius = reader.u32("R").map_err(wrong)?;
        let intervals = reader.u32("n").map_err(wrong)?;
        let profile = reader.text("profile").map_err(wrong)?;
        reader.end("profile").map_err(wrong)?;
        let alpha: Alpha = text.parse()?;
        if format!("{alpha}") != text {
            let problem = format!("alpha `{text}` is not in its canonical form `{alpha}`");
            return Err(wrong(problem));
        }
        Ok(Self {
            alpha,
            radius,
            intervals,
            profile,
        })
    }

    /// The map, whose number of intervals the section states.
    pub(super) fn map(&self, at: usize) -> Result<Map, Error> {
        let alpha = self.alpha;
        let map = Map::new(alpha, self.radius)?;
        if map.intervals() == self.intervals as usize {
            return Ok(map);
        }
        let problem = format!(
            "states {} intervals, but alpha = {alpha} with R = {} has {}",
            self.intervals,
            self.radius,
            map.intervals()
        );
        Err(wrong(b"HEAD", at, problem))
    }
}

pub(super) fn read_prov(bytes: &[u8]) -> Result<Provenance, String> {
    let mut reader = Reader::new(bytes);
    let provenance = Provenance {
        optimizer: reader.text("optimizer")?,
        seed: reader.u64("seed")?,
        parameters: reader.list(8, "parameters", |r| {
            Ok((r.text("a parameter")?, r.text("a parameter")?))
        })?,
        twins: reader.list(16, "twins", |r| {
            let (p, q) = (r.u64("a twin")?, r.u64("a twin")?);
            Twin::new(p, q).ok_or_else(|| format!("{p}/{q} is not a twin"))
        })?,
        figures: reader.list(20, "figures", |r| {
            Ok(Figures {
                subject: r.text("a subject")?,
                seen: match r.u32("seen")? {
                    0 => false,
                    1 => true,
                    other => return Err(format!("seen is {other}; allowed: 0 or 1")),
                },
                points: r.u64("points")?,
                values: r.list(12, "values", |r| {
                    Ok((r.text("a figure")?, r.f64("a figure")?))
                })?,
            })
        })?,
    };
    reader.end("figures")?;
    Ok(provenance)
}

/// The entries of blocks, each of some bytes.
fn of_blocks<T>(
    bytes: &[u8],
    blocks: usize,
    width: usize,
    read: impl Fn(&[u8]) -> T,
) -> Result<Vec<T>, String> {
    let need = width * blocks;
    if bytes.len() == need {
        return Ok(bytes.chunks_exact(width).map(read).collect());
    }
    Err(format!(
        "{} bytes; {blocks} blocks need {need}",
        bytes.len()
    ))
}

/// The section `rank` of a map of some blocks.
pub(super) fn ranks((bytes, at): Payload<'_>, blocks: usize) -> Result<Ranks, Error> {
    let position = |bytes: &[u8]| {
        let mut wide = [0; 4];
        wide[..bytes.len()].copy_from_slice(bytes);
        u32::from_le_bytes(wide)
    };
    let positions = of_blocks(bytes, blocks, position_bytes(blocks), position);
    Ranks::new(positions.map_err(|p| wrong(&RANKS, at, p))?)
}

/// The section `kind` of a map.
pub(super) fn mix((bytes, at): Payload<'_>, map: &Map) -> Result<Mix, Error> {
    let (shares, labels) = read_kind(bytes).map_err(|p| wrong(&MIX, at, p))?;
    Mix::new(map, shares, labels)
}

/// The shares of kinds, and the kind of each block.
fn read_kind(bytes: &[u8]) -> Result<(Shares, Vec<u8>), String> {
    let mut reader = Reader::new(bytes);
    let parts = reader.list(2, "parts", |r| r.array("a part").map(u16::from_le_bytes))?;
    let shares = Shares::new(parts.iter().map(|&part| f64::from(part)))
        .map_err(|error| format!("{error}"))?;
    if shares.parts() != parts {
        return Err(format!(
            "the parts {parts:?} are not ascending and in lowest terms: {shares}"
        ));
    }
    let labels = reader.take(reader.remaining(), "labels")?;
    Ok((shares, labels.to_vec()))
}
