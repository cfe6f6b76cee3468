//! Writing a table file: the fixed numbers of the format, and little-endian writing and checked reading of a section's
//! bytes.

use alloc::{format, string::String, vec, vec::Vec};

use crate::{
    error::{Error, ErrorKind},
    map::Map,
    table::{
        Digest, Mix, Provenance, Ranks,
        parts::{Parts, Vector},
    },
};

/// The version of the file format that this release writes and reads.
pub const FORMAT_VERSION: u32 = 1;

/// The size of the largest table file, in bytes: more than the largest map needs.
///
/// ```
/// use strew_core::{Table, map::MAX_RADIUS, table::MAX_FILE_BYTES};
///
/// let largest = Table::undisplaced("sqrt(3)".parse()?, MAX_RADIUS, "pattern")?;
/// assert!((largest.to_bytes().len() as u64) < MAX_FILE_BYTES);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub const MAX_FILE_BYTES: u64 = 64 << 20;

pub(super) const MAGIC: [u8; 8] = *b"\x89STREW\r\n";
pub(super) const HEADER_BYTES: usize = 24;
pub(super) const DIGEST_BYTES: usize = 32;
pub(super) const MAX_SECTIONS: u32 = 64;
/// The section of the vectors of points in space.
pub(super) const CUBE: [u8; 4] = *b"CUBE";
/// The section of the order in which blocks leave.
pub(super) const RANKS: [u8; 4] = *b"rank";
/// The section of the digest of the table that labels are of.
pub(super) const BASE: [u8; 4] = *b"BASE";
/// The section of the kinds of points.
pub(super) const MIX: [u8; 4] = *b"kind";

/// The bytes of a block's position in the order: 2, or 4 in maps of more than 2¹⁶ blocks.
pub(super) const fn position_bytes(blocks: usize) -> usize {
    if blocks <= 1 << 16 { 2 } else { 4 }
}

/// Refuses a file of more than [`MAX_FILE_BYTES`].
pub(super) fn check_size(bytes: u64) -> Result<(), Error> {
    if bytes <= MAX_FILE_BYTES {
        return Ok(());
    }
    let (value, allowed) = (
        format!("{bytes} bytes"),
        format!("at most {MAX_FILE_BYTES} bytes"),
    );
    let kind = ErrorKind::TableTooLarge;
    Err(Error::new(kind, "the table file", value, allowed))
}

/// Checks size, magic and version of a file of `have` bytes that begins with `header`. Returns the number of sections.
pub(super) fn check_header(have: u64, header: &[u8]) -> Result<u32, Error> {
    const FILE: &str = "the table file";
    let refused = |kind, allowed: String, problem| {
        let error = Error::new(kind, FILE, format!("{have} bytes long"), allowed);
        Err(error.because(problem))
    };
    check_size(have)?;
    let long = |need: u64| format!("{need} bytes long");
    let short = |need: u64| refused(ErrorKind::TableTruncated, long(need), "truncated");
    let least = (HEADER_BYTES + DIGEST_BYTES) as u64;
    let Some((magic, numbers)) = header.split_first_chunk() else {
        return short(least);
    };
    if *magic != MAGIC {
        let value = format!("{magic:02x?} in its first 8 bytes");
        let allowed = "89 'STREW' 0d 0a: this is not a Strew table";
        return Err(Error::new(ErrorKind::Table, FILE, value, allowed));
    }
    let (&[version, sections, low, high], []) = numbers.as_chunks() else {
        return short(least);
    };
    let [version, sections] = [version, sections].map(u32::from_le_bytes);
    if version != FORMAT_VERSION {
        let problem = match version < FORMAT_VERSION {
            true => "written by an older release",
            false => "written by a newer release",
        };
        let allowed = format!("{FORMAT_VERSION}, the version this release reads");
        let field = "the format version of the table file";
        return Err(Error::new(ErrorKind::TableVersion, field, version, allowed).because(problem));
    }
    if sections > MAX_SECTIONS {
        let allowed = format!("at most {MAX_SECTIONS}");
        let field = "the number of sections of the table file";
        return Err(Error::new(ErrorKind::Table, field, sections, allowed));
    }
    let stated = u64::from(u32::from_le_bytes(low)) | u64::from(u32::from_le_bytes(high)) << 32;
    if have < stated.max(least) {
        return short(stated.max(least));
    }
    if have > stated {
        let allowed = format!("{}, as its header states", long(stated));
        return refused(ErrorKind::Table, allowed, "oversized");
    }
    Ok(sections)
}

/// Appends values in the file's encoding.
#[derive(Default)]
pub(super) struct Writer {
    pub(super) bytes: Vec<u8>,
}

impl Writer {
    pub(super) fn u32(&mut self, value: u32) {
        self.bytes.extend(value.to_le_bytes());
    }

    pub(super) fn u64(&mut self, value: u64) {
        self.bytes.extend(value.to_le_bytes());
    }

    pub(super) fn f64(&mut self, value: f64) {
        self.bytes.extend(value.to_le_bytes());
    }

    pub(super) fn text(&mut self, value: &str) {
        self.length(value.len());
        self.bytes.extend(value.as_bytes());
    }

    /// A number of items; every list a table may hold is far below 2³².
    pub(super) fn length(&mut self, items: usize) {
        self.u32(items as u32);
    }
}

/// Takes values off the front of a section; what is wrong is said in words.
pub(super) struct Reader<'a> {
    rest: &'a [u8],
}

type Read<T> = Result<T, String>;

impl<'a> Reader<'a> {
    pub(super) const fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    pub(super) const fn remaining(&self) -> usize {
        self.rest.len()
    }

    pub(super) fn take(&mut self, bytes: usize, what: &str) -> Read<&'a [u8]> {
        let (taken, rest) = self
            .rest
            .split_at_checked(bytes)
            .ok_or_else(|| format!("{what} needs {bytes} bytes, {} are left", self.rest.len()))?;
        self.rest = rest;
        Ok(taken)
    }

    pub(super) fn array<const N: usize>(&mut self, what: &str) -> Read<[u8; N]> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, what)?);
        Ok(array)
    }

    pub(super) fn u32(&mut self, what: &str) -> Read<u32> {
        self.array(what).map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self, what: &str) -> Read<u64> {
        self.array(what).map(u64::from_le_bytes)
    }

    pub(super) fn f64(&mut self, what: &str) -> Read<f64> {
        self.array(what).map(f64::from_le_bytes)
    }

    pub(super) fn text(&mut self, what: &str) -> Read<String> {
        let length = self.u32(what)? as usize;
        let bytes = self.take(length, what)?;
        core::str::from_utf8(bytes)
            .map(Into::into)
            .map_err(|_| format!("{what} is not UTF-8"))
    }

    /// A list whose items take at least `least` bytes each, so that a wrong length never reserves
    /// more memory than the file has.
    pub(super) fn list<T>(
        &mut self,
        least: usize,
        what: &str,
        mut item: impl FnMut(&mut Self) -> Read<T>,
    ) -> Read<Vec<T>> {
        let length = self.u32(what)? as usize;
        if length > self.rest.len() / least {
            return Err(format!(
                "{what} states {length} items, too many for what is left"
            ));
        }
        (0..length).map(|_| item(self)).collect()
    }

    pub(super) fn end(&self, what: &str) -> Read<()> {
        match self.rest.len() {
            0 => Ok(()),
            left => Err(format!("{left} bytes are left after {what}")),
        }
    }
}

/// A table as a file.
pub(crate) fn write<V: Vector>(table: &Parts<V>) -> Vec<u8> {
    let mut bytes = body(table);
    let digest = Digest::of(&bytes);
    bytes.extend(digest.as_bytes());
    bytes
}

/// The digest of the file that a table will have.
pub(crate) fn digest<V: Vector>(table: &Parts<V>) -> Result<Digest, Error> {
    let body = body(table);
    check_size((body.len() + DIGEST_BYTES) as u64)?;
    Ok(Digest::of(&body))
}

/// Everything before the digest.
fn body<V: Vector>(table: &Parts<V>) -> Vec<u8> {
    let mut sections = vec![
        (*b"HEAD", head(&table.map, &table.profile)),
        (*b"PROV", prov(&table.provenance)),
        (V::SECTION, vectors(&table.vectors)),
    ];
    sections.extend(table.ranks.as_ref().map(|ranks| (RANKS, rank(ranks))));
    sections.extend(table.mix.as_ref().map(|mix| (MIX, kind(mix))));
    framed(sections)
}

/// A file of some sections, without its digest.
pub(super) fn framed(sections: Vec<([u8; 4], Vec<u8>)>) -> Vec<u8> {
    let payload: usize = sections.iter().map(|(_, bytes)| 12 + bytes.len()).sum();
    let mut out = Writer::default();
    out.bytes.extend(MAGIC);
    out.u32(FORMAT_VERSION);
    out.length(sections.len());
    out.u64((HEADER_BYTES + payload + DIGEST_BYTES) as u64);
    for (tag, bytes) in sections {
        out.bytes.extend(tag);
        out.u64(bytes.len() as u64);
        out.bytes.extend(bytes);
    }
    out.bytes
}

fn head(map: &Map, profile: &str) -> Vec<u8> {
    let mut out = Writer::default();
    out.text(&alloc::format!("{}", map.alpha()));
    out.u32(map.radius());
    out.length(map.intervals());
    out.text(profile);
    out.bytes
}

fn prov(provenance: &Provenance) -> Vec<u8> {
    let mut out = Writer::default();
    out.text(&provenance.optimizer);
    out.u64(provenance.seed);
    out.length(provenance.parameters.len());
    for (name, value) in &provenance.parameters {
        out.text(name);
        out.text(value);
    }
    out.length(provenance.twins.len());
    for twin in &provenance.twins {
        out.u64(twin.p());
        out.u64(twin.q());
    }
    out.length(provenance.figures.len());
    for figures in &provenance.figures {
        out.text(&figures.subject);
        out.u32(figures.seen.into());
        out.u64(figures.points);
        out.length(figures.values.len());
        for (name, value) in &figures.values {
            out.text(name);
            out.f64(*value);
        }
    }
    out.bytes
}

fn vectors<V: Vector>(vectors: &[V]) -> Vec<u8> {
    let mut section = Vec::with_capacity(size_of_val(vectors));
    vectors.iter().for_each(|vector| vector.write(&mut section));
    section
}

pub(super) fn rank(ranks: &Ranks) -> Vec<u8> {
    let width = position_bytes(ranks.positions().len());
    let bytes = |position: &u32| position.to_le_bytes().into_iter().take(width);
    ranks.positions().iter().flat_map(bytes).collect()
}

pub(super) fn kind(mix: &Mix) -> Vec<u8> {
    let mut out = Writer::default();
    let parts = mix.shares().parts();
    out.length(parts.len());
    out.bytes
        .extend(parts.iter().flat_map(|part| part.to_le_bytes()));
    out.bytes.extend(mix.labels());
    out.bytes
}
