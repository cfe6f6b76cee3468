//! Writing a table file.

use alloc::{vec, vec::Vec};

use super::{
    layout::{
        DIGEST_BYTES, FORMAT_VERSION, HEADER_BYTES, MAGIC, MIX, RANKS, check_size, position_bytes,
    },
    wire::Writer,
};
use crate::{
    error::Error,
    map::Map,
    table::{Digest, Mix, Provenance, Ranks, parts::Parts, vector::Vector},
};

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
