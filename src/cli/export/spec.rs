//! The options that decide the bytes of an export. Two exports of the same spec are equal, bit for bit.

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde::{Deserialize, Serialize};
use strew_catalog::Ready;
use strew_config::Config;
use strew_core::{ALGORITHM_VERSION, Keep};
use strew_encode::{Encoding, Output};
use strew_error::Error;
use strew_plan::Planned;
use strew_query::{
    Assets, Draft, Query, RegionDraft, ShapeDraft, Value, groups,
    parameters::{BBOX, LOD, WORLD},
    parse_pairs,
};

use super::grid::{Grid, Level};
use crate::cli::{Failure, compression::Compression, failure::refused, flags::Flags, refuse};

/// The characters that need no escaping in addresses or in the settings of servers.
const PLAIN: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b',')
    .remove(b':');

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Spec {
    /// The versions of the program and of the algorithm, on which the bytes depend.
    pub(super) strew: String,
    pub(super) algorithm: u32,
    pub(super) world: Option<WorldName>,
    pub(super) digests: Vec<String>,
    /// The parameters of addresses without `lod`.
    pub(super) query: String,
    pub(super) format: String,
    pub(super) content_type: String,
    pub(super) bbox: [f64; 4],
    compressed: Vec<Compression>,
    /// The setting `limits.block_bytes`, in formats whose bytes depend on it; else none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) block_bytes: Option<usize>,
    pub(super) levels: Vec<Level>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WorldName {
    pub(super) name: String,
    pub(super) digest: String,
}

#[derive(Clone, Debug)]
pub(super) struct Checked {
    pub(super) query: Query,
    /// The share of its points; of a world with layers, the share of all layers.
    lod: f64,
    pub(super) output: Output,
}

/// The options that are not part of the query.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) size: f64,
    pub(super) levels: u32,
    pub(super) compressed: Option<Vec<Compression>>,
}

impl Spec {
    pub(super) fn new<T>(
        flags: &Flags<T>,
        shape: &Shape,
        catalog: &Assets,
        config: &Config,
    ) -> Result<Self, Failure> {
        let bbox = bbox(flags)?;
        let encoded = |text: &str| utf8_percent_encode(text.trim(), PLAIN).to_string();
        let others = flags
            .texts()
            .filter(|(parameter, _)| ![&BBOX, &WORLD, &LOD].contains(parameter));
        let pairs = others.map(|(parameter, text)| format!("{}={}", parameter.name, encoded(text)));
        let query = pairs.collect::<Vec<_>>().join("&");
        let with_lod = |lod: Option<&str>| match (lod, query.is_empty()) {
            (None, _) => query.clone(),
            (Some(lod), true) => format!("lod={lod}"),
            (Some(lod), false) => format!("{query}&lod={lod}"),
        };
        let given = flags.text(&LOD).map(encoded);
        let finest = Level::new(shape.size, 1.0, with_lod(given.as_deref()), bbox)?;
        let first = check(flags.text(&WORLD), &finest, catalog, config)?;
        let encoding = first.output.encoding;
        let usual = if encoding.traits().is_text {
            vec![Compression::Gzip]
        } else {
            vec![]
        };
        let share = first.lod;
        let mut levels = vec![Level {
            lod: share,
            ..finest
        }];
        for k in 1..shape.levels {
            let lod = share * 0.25_f64.powi(k as i32);
            if lod < Keep::MIN {
                refuse!(
                    "--levels {}: level {k} has the share {lod:e} of the points; allowed with lod = {share}: at most \
                     {k} levels, because the smallest share is {:e}",
                    shape.levels,
                    Keep::MIN
                );
            }
            let size = shape.size * f64::from(k).exp2();
            levels.push(Level::new(
                size,
                lod,
                with_lod(Some(&lod.to_string())),
                bbox,
            )?);
        }
        Ok(Self {
            strew: env!("CARGO_PKG_VERSION").into(),
            algorithm: ALGORITHM_VERSION,
            world: first.query.world.as_ref().map(|world| WorldName {
                name: world.name.clone(),
                digest: world.digest.clone(),
            }),
            digests: first.query.digests().map(Into::into).collect(),
            query,
            format: encoding.name().into(),
            content_type: encoding.content_type().into(),
            bbox,
            compressed: shape.compressed.clone().unwrap_or(usual),
            block_bytes: blocks(encoding, config),
            levels,
        })
    }

    pub(super) fn grid(&self) -> Result<Grid, Failure> {
        let world = self.world.as_ref().map(|world| world.name.as_str());
        Grid::new(world, self.levels.clone())
    }

    /// The compressions of the files of each chunk; the plain one first.
    pub(super) fn compressions(&self) -> Vec<Compression> {
        [&[Compression::Plain], &self.compressed[..]].concat()
    }

    /// The checked query of each level, and the tables of all.
    pub(super) fn checked(
        &self,
        catalog: &Assets,
        config: &Config,
    ) -> Result<(Vec<Checked>, Vec<Ready>), Failure> {
        let world = self.world.as_ref().map(|world| world.name.as_str());
        let levels = self.levels.iter();
        let levels = levels.map(|level| check(world, level, catalog, config));
        let levels: Vec<Checked> = levels.collect::<Result<_, _>>()?;
        let now = blocks(levels[0].output.encoding, config);
        if self.block_bytes != now {
            let shown =
                |bytes: Option<usize>| bytes.map_or("none".into(), |bytes| bytes.to_string());
            refuse!(
                "limits.block_bytes {}: the export was made with {}, and the bytes of --format {} depend on it",
                shown(now),
                shown(self.block_bytes),
                self.format
            );
        }
        let query = &levels[0].query;
        let tables = Planned::tables(query).map_err(refused)?;
        Ok((levels, tables))
    }

    /// Whether the points still depend on the same program, world, tables, fields and lists.
    pub(super) fn is_of(&self, first: &Query) -> bool {
        let world = first.world.as_ref().map(|world| &world.digest);
        let program = (env!("CARGO_PKG_VERSION"), ALGORITHM_VERSION);
        (self.strew.as_str(), self.algorithm) == program
            && self.world.as_ref().map(|world| &world.digest) == world
            && self.digests.iter().map(String::as_str).eq(first.digests())
    }
}

/// The setting on which the bytes of columnar formats depend: the rows of a record batch.
fn blocks(encoding: Encoding, config: &Config) -> Option<usize> {
    (encoding == Encoding::Arrow).then_some(config.limits.block_bytes)
}

fn bbox<T>(flags: &Flags<T>) -> Result<[f64; 4], Failure> {
    let values = flags.values_of(groups::POINTS);
    let region = RegionDraft::of(&values).map_err(refused)?;
    let Some(region) = region else {
        refuse!("a region is missing: use --bbox");
    };
    let checked = region.check().map_err(refused)?;
    Ok(checked.bbox())
}

/// Checks the query of a level as the daemon checks the address of a chunk.
fn check(
    world: Option<&str>,
    level: &Level,
    catalog: &Assets,
    config: &Config,
) -> Result<Checked, Failure> {
    let mut values = parse_pairs(&level.query, groups::CHUNK);
    if let Some(name) = world {
        values.replace(&WORLD, Some(Value::Text(name.into())));
    }
    let at = [level.columns[0], level.rows[0]];
    let draft = Draft::new(values).within(Ok(chunk(level.size, at)));
    let checked = || -> Result<Checked, Error> {
        let (query, options) = draft.check(catalog, config.limits.max_vertices)?;
        let encoding = options.encoding.unwrap_or(Encoding::Json);
        let output = options.output(encoding)?;
        // The share comes from flags or from the world's document.
        let (whole, _) = draft.filled(&catalog.worlds)?;
        let lod = whole.values.get(&LOD)?.unwrap_or(1.0);
        Ok(Checked { query, lod, output })
    };
    checked().map_err(refused)
}

pub(super) fn chunk(size: f64, at: [i64; 2]) -> RegionDraft {
    RegionDraft {
        path: "chunk".into(),
        shape: ShapeDraft::Chunk(size, at),
    }
}
