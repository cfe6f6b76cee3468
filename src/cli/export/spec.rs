//! What an export is: the options that decide its bytes. Two exports of the same spec are the same, bit for bit.

use anyhow::anyhow;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde::{Deserialize, Serialize};
use strew_core::{ALGORITHM_VERSION, Keep};

use super::grid::{Grid, Level};
use crate::{
    cli::{Failure, compression::Compression, flags::Flags, refusal::Source},
    config::Config,
    service::{
        Catalog, Draft, Encoding, Error, Options, Output, Planned, Query, Ready, Worlds,
        query::{
            Parameter, RegionDraft, ShapeDraft, Value, groups,
            parameters::{BBOX, KEEP, WORLD},
            parse_pairs,
        },
    },
};

/// What stays as it is in addresses: what neither addresses nor the settings of servers understand otherwise.
const PLAIN: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b',')
    .remove(b':');

/// What an export is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Spec {
    /// The program's version and that of the algorithm: others may write other bytes.
    pub(super) strew: String,
    pub(super) algorithm: u32,
    /// The world.
    pub(super) world: Option<WorldName>,
    /// The digests of the tables, fields and lists that points depend on.
    pub(super) digests: Vec<String>,
    /// The parameters of addresses, but for `keep`.
    pub(super) query: String,
    /// The format of the files and its content type.
    pub(super) format: String,
    pub(super) content_type: String,
    /// What was wanted of the world.
    pub(super) bbox: [f64; 4],
    /// The endings of compressed files beside the plain ones.
    pub(super) compressed: Vec<String>,
    /// How members of an archive are packed; none for a folder.
    pub(super) archive: Option<String>,
    /// The setting `limits.block_bytes`, in formats whose bytes depend on it; else none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) block_bytes: Option<usize>,
    /// Levels of detail.
    pub(super) levels: Vec<Level>,
}

/// A world and its digest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WorldName {
    pub(super) name: String,
    pub(super) digest: String,
}

/// A query of chunks, checked, with its tables: what a level is made with.
#[derive(Clone, Debug)]
pub(super) struct Checked {
    pub(super) query: Query,
    /// The share of its points, or the common one beside layers.
    keep: f64,
    pub(super) output: Output,
}

/// The tables, fields, lists and worlds of the settings.
pub(super) fn catalog(config: &Config) -> Result<Catalog, Failure> {
    let catalog = config.tables()?;
    let worlds = Worlds::load(&config.worlds, &catalog, config.limits.max_vertices)
        .map_err(|error| Failure::Usage(error.into()))?;
    Ok(catalog.with_worlds(worlds))
}

/// What flags say beside the query.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) size: f64,
    pub(super) levels: u32,
    /// How files are compressed, if flags say so.
    pub(super) compressed: Option<Vec<Compression>>,
    pub(super) is_archive: bool,
}

impl Shape {
    /// How files of a format are compressed: those beside the plain ones, and how members of an archive are packed.
    fn packing(&self, encoding: Encoding) -> Result<(Vec<String>, Option<String>), Failure> {
        let otherwise = || {
            if encoding.is_text() {
                vec![Compression::Gzip]
            } else {
                vec![]
            }
        };
        let wanted = self.compressed.clone().unwrap_or_else(otherwise);
        if !self.is_archive {
            return Ok((wanted.iter().map(|one| one.ending().into()).collect(), None));
        }
        match wanted.as_slice() {
            [] => Ok((vec![], Some(STORED.into()))),
            [Compression::Gzip] => Ok((vec![], Some(DEFLATE.into()))),
            _ => Err(Failure::Usage(anyhow!(
                "--compress zst: most readers of zip files do not know it; allowed with --archive: none, gz"
            ))),
        }
    }
}

/// How members of an archive are packed.
pub(super) const STORED: &str = "stored";
pub(super) const DEFLATE: &str = "deflate";

impl Spec {
    /// The spec of some flags.
    pub(super) fn new<T>(
        flags: &Flags<T>,
        shape: &Shape,
        catalog: &Catalog,
        config: &Config,
    ) -> Result<Self, Failure> {
        let bbox = bbox(flags)?;
        let text = |wanted: &Parameter| {
            let mut texts = flags.texts();
            texts.find_map(|(parameter, text)| (parameter == wanted).then(|| text.to_owned()))
        };
        let world = text(&WORLD);
        let others = flags
            .texts()
            .filter(|(parameter, _)| ![&BBOX, &WORLD, &KEEP].contains(parameter));
        let pairs = others.map(|(parameter, text)| {
            format!(
                "{}={}",
                parameter.name,
                utf8_percent_encode(text.trim(), PLAIN)
            )
        });
        let query = pairs.collect::<Vec<_>>().join("&");
        let with_keep = |keep: Option<&str>| match (keep, query.is_empty()) {
            (None, _) => query.clone(),
            (Some(keep), true) => format!("keep={keep}"),
            (Some(keep), false) => format!("{query}&keep={keep}"),
        };
        let given = text(&KEEP);
        let given = given
            .as_deref()
            .map(|text| utf8_percent_encode(text.trim(), PLAIN).to_string());
        let finest = Level::new(shape.size, 1.0, with_keep(given.as_deref()), bbox)?;
        let first = check(
            world.as_deref(),
            &finest,
            [finest.columns[0], finest.rows[0]],
            catalog,
            config,
        )?;
        let encoding = first.output.encoding;
        if !encoding.is_streamed() {
            let formats = Encoding::ALL.map(Encoding::name).join(", ");
            return Err(Failure::Usage(anyhow!(
                "--format {}: no daemon writes it; allowed: {formats}",
                encoding.name()
            )));
        }
        let (compressed, archive) = shape.packing(encoding)?;
        let share = first.keep;
        let mut levels = vec![Level {
            keep: share,
            ..finest
        }];
        for k in 1..shape.levels {
            let keep = share * 0.25_f64.powi(k as i32);
            if keep < Keep::MIN {
                return Err(Failure::Usage(anyhow!(
                    "--levels {}: level {k} has the share {keep:e} of the points; allowed with keep = {share}: at most \
                     {k} levels, because the smallest share is {:e}",
                    shape.levels,
                    Keep::MIN
                )));
            }
            let size = shape.size * f64::from(k).exp2();
            levels.push(Level::new(
                size,
                keep,
                with_keep(Some(&keep.to_string())),
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
            compressed,
            archive,
            block_bytes: blocks(encoding, config),
            levels,
        })
    }

    /// Its chunks.
    pub(super) fn grid(&self) -> Result<Grid, Failure> {
        let world = self.world.as_ref().map(|world| world.name.as_str());
        Grid::new(world, self.levels.clone())
    }

    /// How files are compressed beside the plain ones.
    pub(super) fn compressions(&self) -> Vec<Compression> {
        let all = [Compression::Gzip, Compression::Zstd];
        let is_wanted =
            |one: &Compression| self.compressed.iter().any(|ending| ending == one.ending());
        all.into_iter().filter(is_wanted).collect()
    }

    /// What each level is made with, and the tables of all.
    ///
    /// # Errors
    /// A query that is not valid with these tables, or has become another one.
    pub(super) fn checked(
        &self,
        catalog: &Catalog,
        config: &Config,
    ) -> Result<(Vec<Checked>, Vec<Ready>), Failure> {
        let world = self.world.as_ref().map(|world| world.name.as_str());
        let levels = self.levels.iter().map(|level| {
            check(
                world,
                level,
                [level.columns[0], level.rows[0]],
                catalog,
                config,
            )
        });
        let levels: Vec<Checked> = levels.collect::<Result<_, _>>()?;
        let now = blocks(levels[0].output.encoding, config);
        if self.block_bytes != now {
            let shown =
                |bytes: Option<usize>| bytes.map_or("none".into(), |bytes| bytes.to_string());
            return Err(Failure::Usage(anyhow!(
                "limits.block_bytes {}: the export was made with {}, and the bytes of --format {} depend on it",
                shown(now),
                shown(self.block_bytes),
                self.format
            )));
        }
        let query = &levels[0].query;
        let tables = Planned::tables(query).map_err(|error| Source::Flags.refused(error))?;
        Ok((levels, tables))
    }

    /// Whether points still come from what they came from when it was made.
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

/// The box of the flags.
fn bbox<T>(flags: &Flags<T>) -> Result<[f64; 4], Failure> {
    let values = flags.values_of(groups::POINTS);
    let region = RegionDraft::of(&values).map_err(|faults| Source::Flags.refused(faults.into()))?;
    let Some(region) = region else {
        return Err(Failure::Usage(anyhow!("a region is missing: give --bbox")));
    };
    let checked = region
        .check()
        .map_err(|faults| Source::Flags.refused(faults.into()))?;
    Ok(checked.bbox())
}

/// Checks the query of a level as the daemon checks the address of a chunk.
fn check(
    world: Option<&str>,
    level: &Level,
    at: [i64; 2],
    catalog: &Catalog,
    config: &Config,
) -> Result<Checked, Failure> {
    let mut values = parse_pairs(&level.query, groups::CHUNK);
    if let Some(name) = world {
        values.replace(&WORLD, Some(Value::Text(name.into())));
    }
    let draft = Draft::new(values).within(Ok(chunk(level.size, at)));
    let checked = draft.check(catalog, config.limits.max_vertices);
    // Flags or the world's document have it.
    let keep = || -> Result<f64, Error> {
        let (whole, _) = draft.filled(catalog.worlds())?;
        Ok(whole.values.get(&KEEP)?.unwrap_or(1.0))
    };
    let looks = |(query, options): (Query, Options)| -> Result<Checked, Error> {
        let encoding = options.encoding.unwrap_or(Encoding::Json);
        Ok(Checked {
            output: options.output(encoding)?,
            query,
            keep: keep()?,
        })
    };
    checked
        .and_then(looks)
        .map_err(|error| Source::Flags.refused(error))
}

/// The region of a chunk.
pub(super) fn chunk(size: f64, at: [i64; 2]) -> RegionDraft {
    RegionDraft {
        path: "chunk".into(),
        shape: ShapeDraft::Chunk(size, at),
    }
}
