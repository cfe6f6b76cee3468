//! The table file: a header, tagged sections, a digest.
//!
//! ```text
//! 0   8  magic: 89 'STREW' 0d 0a (a text-mode transfer damages it)
//! 8   4  format version, little-endian as everything
//! 12  4  number of sections
//! 16  8  size of the whole file
//! 24  …  sections: 4 letters, u64 length, that many bytes
//! −32 32 BLAKE3 of everything before
//! ```
//!
//! `HEAD`: α as text, R, n, profile. `PROV`: the history. `DISP`: n² pairs of i32, row by row. A
//! section that starts with a lower-case letter may be skipped by a reader that does not know it,
//! so that later releases can add to a file without a new format.

use alloc::{string::String, vec::Vec};

use super::{
    Digest, Figures, Provenance, Table, TableError,
    wire::{Reader, Writer},
};
use crate::{
    map::{Map, Twin},
    pattern::Alpha,
};

/// The version of the file format that is written and read here.
pub const FORMAT_VERSION: u32 = 1;

/// The largest table file: more than the largest map needs.
pub const MAX_FILE_BYTES: u64 = 64 << 20;

const MAGIC: [u8; 8] = *b"\x89STREW\r\n";
const HEADER_BYTES: usize = 24;
const DIGEST_BYTES: usize = 32;
const MAX_SECTIONS: u32 = 64;

pub(super) fn write(table: &Table) -> Vec<u8> {
    let mut bytes = body(table);
    let digest = Digest::of(&bytes);
    bytes.extend(digest.as_bytes());
    bytes
}

/// The digest a table's file will have.
pub(super) fn digest(table: &Table) -> Result<Digest, TableError> {
    let body = body(table);
    match (body.len() + DIGEST_BYTES) as u64 {
        bytes if bytes > MAX_FILE_BYTES => Err(TableError::TooLarge { bytes }),
        _ => Ok(Digest::of(&body)),
    }
}

/// Everything before the digest.
fn body(table: &Table) -> Vec<u8> {
    let sections = [
        (*b"HEAD", head(table)),
        (*b"PROV", prov(&table.provenance)),
        (*b"DISP", disp(table)),
    ];
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

fn head(table: &Table) -> Vec<u8> {
    let mut out = Writer::default();
    out.text(&alloc::format!("{}", table.alpha()));
    out.u32(table.map.radius());
    out.length(table.map.intervals());
    out.text(&table.profile);
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

fn disp(table: &Table) -> Vec<u8> {
    let mut out = Writer::default();
    for [x, y] in &table.displacements {
        out.i32(*x);
        out.i32(*y);
    }
    out.bytes
}

pub(super) fn read(bytes: &[u8]) -> Result<Table, TableError> {
    let have = bytes.len() as u64;
    if have > MAX_FILE_BYTES {
        return Err(TableError::TooLarge { bytes: have });
    }
    let sections = check_frame(bytes)?;
    let body = &bytes[..bytes.len() - DIGEST_BYTES];

    let mut found = Sections::default();
    let mut at = HEADER_BYTES;
    for _ in 0..sections {
        at = found.add(body, at)?;
    }
    if at != body.len() {
        let problem = alloc::format!("{} bytes are left after the last section", body.len() - at);
        return Err(TableError::Section {
            section: "none".into(),
            at: at as u64,
            problem,
        });
    }
    // The file's own digest: with optional sections that are skipped here it is not the digest
    // that the table would get when written again.
    Ok(Table {
        digest: Digest::of(body),
        ..found.into_table()?
    })
}

/// Checks magic, version, size and digest; gives the number of sections.
fn check_frame(bytes: &[u8]) -> Result<u32, TableError> {
    let have = bytes.len() as u64;
    let need = (HEADER_BYTES + DIGEST_BYTES) as u64;
    let short = TableError::Truncated { have, need };
    let field = |at: usize, length: usize| bytes.get(at..at + length).ok_or_else(|| short.clone());
    let mut magic = [0; 8];
    magic.copy_from_slice(field(0, 8)?);
    if magic != MAGIC {
        return Err(TableError::Magic { found: magic });
    }
    let mut header = Reader::new(field(8, 16)?);
    let mut number = || header.u32("header").map_err(|_| short.clone());
    match number()? {
        FORMAT_VERSION => {}
        found if found < FORMAT_VERSION => return Err(TableError::OlderVersion { found }),
        found => return Err(TableError::NewerVersion { found }),
    }
    let sections = number()?;
    let stated = u64::from(number()?) | u64::from(number()?) << 32;
    if have < stated.max(need) {
        return Err(TableError::Truncated {
            have,
            need: stated.max(need),
        });
    }
    if have > stated {
        return Err(TableError::Oversized { have, need: stated });
    }
    let (body, stated) = bytes.split_at(bytes.len() - DIGEST_BYTES);
    let computed = Digest::of(body);
    if computed.as_bytes() != stated {
        let mut digest = [0; DIGEST_BYTES];
        digest.copy_from_slice(stated);
        return Err(TableError::Digest {
            computed: alloc::format!("{computed}"),
            stated: alloc::format!("{}", Digest::from_bytes(digest)),
        });
    }
    if sections > MAX_SECTIONS {
        return Err(TableError::Field {
            field: "number of sections",
            value: alloc::format!("{sections}"),
            allowed: alloc::format!("at most {MAX_SECTIONS}"),
        });
    }
    Ok(sections)
}

/// A section's payload and where it starts.
type Payload<'a> = (&'a [u8], usize);

#[derive(Default)]
struct Sections<'a> {
    head: Option<Payload<'a>>,
    prov: Option<Payload<'a>>,
    disp: Option<Payload<'a>>,
}

impl<'a> Sections<'a> {
    /// Files the section at `at`; gives the place after it.
    fn add(&mut self, body: &'a [u8], at: usize) -> Result<usize, TableError> {
        let mut reader = Reader::new(&body[at..]);
        let tag = reader
            .take(4, "a section's name")
            .map_err(|p| wrong(b"none", at, p))?;
        let length = reader
            .u64("a section's length")
            .map_err(|p| wrong(tag, at, p))?;
        let length = usize::try_from(length).unwrap_or(usize::MAX);
        let payload = reader
            .take(length, "its content")
            .map_err(|p| wrong(tag, at, p))?;
        let slot = match tag {
            b"HEAD" => &mut self.head,
            b"PROV" => &mut self.prov,
            b"DISP" => &mut self.disp,
            _ if tag[0].is_ascii_lowercase() => return Ok(at + 12 + length),
            _ => return Err(wrong(tag, at, "it is not known to this release".into())),
        };
        if slot.replace((payload, at + 12)).is_some() {
            return Err(wrong(tag, at, "it occurs twice".into()));
        }
        Ok(at + 12 + length)
    }

    fn into_table(self) -> Result<Table, TableError> {
        let missing = |tag: &[u8]| wrong(tag, HEADER_BYTES, "it is missing".into());
        let (head, head_at) = self.head.ok_or_else(|| missing(b"HEAD"))?;
        let (prov, prov_at) = self.prov.ok_or_else(|| missing(b"PROV"))?;
        let (disp, disp_at) = self.disp.ok_or_else(|| missing(b"DISP"))?;

        let head = Head::read(head).map_err(|p| wrong(b"HEAD", head_at, p))?;
        let alpha: Alpha = head.alpha.parse()?;
        if alloc::format!("{alpha}") != head.alpha {
            let problem = alloc::format!(
                "alpha `{}` is not in its canonical form `{alpha}`",
                head.alpha
            );
            return Err(wrong(b"HEAD", head_at, problem));
        }
        let map = Map::new(alpha, head.radius)?;
        if map.intervals() != head.intervals as usize {
            let problem = alloc::format!(
                "it states {} intervals, but alpha = {alpha} with R = {} has {}",
                head.intervals,
                head.radius,
                map.intervals()
            );
            return Err(wrong(b"HEAD", head_at, problem));
        }
        let provenance = read_prov(prov).map_err(|p| wrong(b"PROV", prov_at, p))?;
        let displacements =
            read_disp(disp, map.intervals()).map_err(|p| wrong(b"DISP", disp_at, p))?;
        Table::new(map, &head.profile, displacements, provenance)
    }
}

fn wrong(tag: &[u8], at: usize, problem: String) -> TableError {
    let section = String::from_utf8_lossy(tag).into_owned();
    TableError::Section {
        section,
        at: at as u64,
        problem,
    }
}

struct Head {
    alpha: String,
    radius: u32,
    intervals: u32,
    profile: String,
}

impl Head {
    fn read(bytes: &[u8]) -> Result<Self, String> {
        let mut reader = Reader::new(bytes);
        let head = Self {
            alpha: reader.text("alpha")?,
            radius: reader.u32("R")?,
            intervals: reader.u32("n")?,
            profile: reader.text("profile")?,
        };
        reader.end("profile")?;
        Ok(head)
    }
}

fn read_prov(bytes: &[u8]) -> Result<Provenance, String> {
    let mut reader = Reader::new(bytes);
    let provenance = Provenance {
        optimizer: reader.text("optimizer")?,
        seed: reader.u64("seed")?,
        parameters: reader.list(8, "parameters", |r| {
            Ok((r.text("a parameter")?, r.text("a parameter")?))
        })?,
        twins: reader.list(16, "twins", |r| {
            let (p, q) = (r.u64("a twin")?, r.u64("a twin")?);
            Twin::new(p, q).ok_or_else(|| alloc::format!("{p}/{q} is no twin"))
        })?,
        figures: reader.list(20, "figures", |r| {
            Ok(Figures {
                subject: r.text("a subject")?,
                seen: match r.u32("seen")? {
                    0 => false,
                    1 => true,
                    other => return Err(alloc::format!("seen is {other}; allowed: 0 or 1")),
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

fn read_disp(bytes: &[u8], intervals: usize) -> Result<Vec<[i32; 2]>, String> {
    let mut reader = Reader::new(bytes);
    let blocks = intervals * intervals;
    if reader.remaining() != 8 * blocks {
        return Err(alloc::format!(
            "{} bytes; {blocks} blocks need {}",
            bytes.len(),
            8 * blocks
        ));
    }
    (0..blocks)
        .map(|_| Ok([reader.i32("a vector")?, reader.i32("a vector")?]))
        .collect()
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    fn table() -> Table {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 5).expect("small");
        let n = map.intervals() * map.intervals();
        let displacements = (0..n as i32).map(|i| [i << 16, -(i << 14)]).collect();
        let provenance = Provenance {
            optimizer: "gaussian".into(),
            parameters: vec![("sigma".into(), "1".into())],
            seed: 7,
            twins: map.twins().take(2).collect(),
            figures: vec![Figures {
                subject: "twin 71/41".into(),
                seen: true,
                points: 5041,
                values: vec![("low_power".into(), 4e-6)],
            }],
        };
        Table::new(map, "blue", displacements, provenance).expect("valid")
    }

    /// Puts the digest right again after a deliberate change.
    fn resealed(mut bytes: Vec<u8>) -> Vec<u8> {
        let body = bytes.len() - DIGEST_BYTES;
        let digest = Digest::of(&bytes[..body]);
        bytes[body..].copy_from_slice(digest.as_bytes());
        bytes
    }

    #[test]
    fn round_trip() {
        let table = table();
        let bytes = table.to_bytes();
        let back = Table::from_bytes(&bytes).expect("valid");
        assert_eq!(back, table);
        assert_eq!(back.to_bytes(), bytes);
    }

    #[test]
    fn every_flipped_bit_is_caught() {
        let bytes = table().to_bytes();
        for at in 0..bytes.len() {
            for bit in 0..8 {
                let mut damaged = bytes.clone();
                damaged[at] ^= 1 << bit;
                assert!(Table::from_bytes(&damaged).is_err(), "byte {at} bit {bit}");
            }
        }
    }

    #[test]
    fn every_truncation_is_caught() {
        let bytes = table().to_bytes();
        for length in 0..bytes.len() {
            let error = Table::from_bytes(&bytes[..length]).expect_err("truncated");
            assert!(matches!(error, TableError::Truncated { have, .. } if have == length as u64));
        }
    }

    #[test]
    fn other_damage_has_its_own_name() {
        let good = table().to_bytes();
        let oversized = [good.clone(), vec![0]].concat();
        assert!(matches!(
            Table::from_bytes(&oversized),
            Err(TableError::Oversized { .. })
        ));
        let with_version = |v: u32| {
            let mut bytes = good.clone();
            bytes[8..12].copy_from_slice(&v.to_le_bytes());
            Table::from_bytes(&resealed(bytes))
        };
        assert!(matches!(
            with_version(0),
            Err(TableError::OlderVersion { found: 0 })
        ));
        assert!(matches!(
            with_version(9),
            Err(TableError::NewerVersion { found: 9 })
        ));
        assert!(matches!(
            Table::from_bytes(&vec![b'#'; 400]),
            Err(TableError::Magic { .. })
        ));
        assert!(matches!(
            Table::from_bytes(&vec![0; MAX_FILE_BYTES as usize + 1]),
            Err(TableError::TooLarge { .. })
        ));
    }

    #[test]
    fn sealed_nonsense_is_refused_with_its_place() {
        let good = table().to_bytes();
        // Every byte of the content changed in turn, under a right digest: never a panic, and
        // whatever is accepted round-trips.
        for at in HEADER_BYTES..good.len() - DIGEST_BYTES {
            for change in [1u8, 0x80, 0xff] {
                let mut bytes = good.clone();
                bytes[at] ^= change;
                let bytes = resealed(bytes);
                if let Ok(table) = Table::from_bytes(&bytes) {
                    assert_eq!(table.to_bytes(), bytes, "byte {at}");
                }
            }
        }
        let mut unknown = good.clone();
        unknown[HEADER_BYTES..HEADER_BYTES + 4].copy_from_slice(b"WHAT");
        let error = Table::from_bytes(&resealed(unknown)).expect_err("unknown section");
        assert!(alloc::format!("{error}").contains("WHAT"), "{error}");
    }

    #[test]
    fn optional_sections_of_later_releases_are_skipped() {
        let good = table().to_bytes();
        let mut bytes = good[..good.len() - DIGEST_BYTES].to_vec();
        bytes.extend(*b"rank");
        bytes.extend(3u64.to_le_bytes());
        bytes.extend([1, 2, 3]);
        bytes.extend([0; DIGEST_BYTES]);
        bytes[12] += 1;
        let size = bytes.len() as u64;
        bytes[16..24].copy_from_slice(&size.to_le_bytes());
        let read = Table::from_bytes(&resealed(bytes)).expect("skips what it may");
        assert_eq!(read.displacements(), table().displacements());
    }

    #[test]
    fn parts_out_of_range_are_refused() {
        let table = table();
        let make = |profile: &str, vectors: Vec<[i32; 2]>| {
            Table::new(table.map().clone(), profile, vectors, Provenance::default())
        };
        let good = table.displacements().to_vec();
        for name in ["", "Blue", "blue noise", "ä", &"x".repeat(33)] {
            assert!(matches!(
                make(name, good.clone()),
                Err(TableError::Field {
                    field: "profile",
                    ..
                })
            ));
        }
        assert!(make("blue", good[1..].to_vec()).is_err());
        let mut long = good.clone();
        long[3] = [i32::MIN, 0];
        assert!(make("blue", long).is_err());
    }
}
