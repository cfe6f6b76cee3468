//! Records of written files, and the documents that complete an export.

use std::fmt::Write as _;

use anyhow::{Context as _, anyhow};
use serde::{Deserialize, Serialize};
use strew_query::{Assets, World};

use super::{
    chunks::Maker,
    grid::{Level, MOST_LEVELS},
    servers,
    spec::Spec,
};
use crate::{cli::Failure, rest::world_document};

/// The manifest, which comes last: an export without it is not complete.
pub(super) const MANIFEST: &str = "manifest.json";
/// The digests of all other files, as `b3sum` writes them.
pub(super) const DIGESTS: &str = "files.b3";

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Record {
    pub(super) points: u64,
    /// The digest and the length of the plain file, then those of the compressed ones.
    pub(super) files: Vec<(blake3::Hash, u64)>,
}

impl Record {
    pub(super) fn line(&self, i: usize) -> String {
        let mut line = format!("{i} {}", self.points);
        for (digest, length) in &self.files {
            let _ = write!(line, " {digest}:{length}");
        }
        line.push('\n');
        line
    }

    /// Reads a line of a journal; `None` for a broken one.
    pub(super) fn read(line: &str) -> Option<(usize, Self)> {
        let mut words = line.strip_suffix('\n')?.split(' ');
        let (i, points) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
        let file = |word: &str| {
            let (digest, length) = word.split_once(':')?;
            Some((blake3::Hash::from_hex(digest).ok()?, length.parse().ok()?))
        };
        let files = words.map(file).collect::<Option<_>>()?;
        Some((i, Self { points, files }))
    }
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Manifest {
    pub(super) export: Spec,
    pub(super) path: String,
    /// For formats without names in them: the columns.
    pub(super) columns: Option<serde_json::Value>,
    pub(super) levels: Vec<Total>,
    pub(super) total: Total,
    /// The digest of the list of digests.
    pub(super) files: String,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Total {
    pub(super) chunks: u64,
    pub(super) points: u64,
    /// The bytes of plain files.
    pub(super) bytes: u64,
}

impl Total {
    fn add(&mut self, record: &Record) {
        self.chunks += 1;
        self.points += record.points;
        self.bytes += record.files[0].1;
    }
}

/// The documents beside the chunks, in the order in which they are written.
pub(super) fn documents(
    spec: &Spec,
    maker: &Maker,
    catalog: &Assets,
    records: &[Record],
) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let legend = maker.legend()?;
    let mut files = vec![];
    let world = spec
        .world
        .as_ref()
        .and_then(|world| catalog.worlds.get(&world.name));
    if let Some(world) = world {
        files.push((
            world_path(world),
            world_document(world).context("a world cannot be written")?,
        ));
    }
    let served = servers::Served {
        spec,
        grid: &maker.grid,
        tables: maker.query().tables().join(", "),
        columns: legend.as_deref(),
    };
    files.push((servers::NGINX.into(), served.nginx().into()));
    files.push((servers::HEADERS.into(), served.headers().into()));
    let digests = digests(spec, maker, records, &files);
    let columns = legend.as_deref().map(serde_json::from_str).transpose();
    let mut levels = vec![Total::default(); spec.levels.len()];
    let mut total = Total::default();
    for (i, record) in records.iter().enumerate() {
        levels[maker.grid.place(i).level].add(record);
        total.add(record);
    }
    let manifest = Manifest {
        export: spec.clone(),
        path: format!("/{}/{{size}}/{{cx}}/{{cy}}", maker.grid.path()),
        columns: columns.context("the columns are no JSON")?,
        levels,
        total,
        files: blake3::hash(digests.as_bytes()).to_hex().to_string(),
    };
    let mut written =
        serde_json::to_vec_pretty(&manifest).context("a manifest cannot be written")?;
    written.push(b'\n');
    files.push((DIGESTS.into(), digests.into()));
    files.push((MANIFEST.into(), written));
    Ok(files)
}

/// The file of a world's description: a server answers with it to the path of its folder.
pub(super) fn world_path(world: &World) -> String {
    format!("v1/worlds/{}/index.json", world.name)
}

fn digests(spec: &Spec, maker: &Maker, records: &[Record], files: &[(String, Vec<u8>)]) -> String {
    let mut text = String::new();
    let compressions = spec.compressions();
    for (i, record) in records.iter().enumerate() {
        let plain = maker.grid.name(i);
        for ((digest, _), packed) in record.files.iter().zip(&compressions) {
            let _ = writeln!(text, "{digest}  {}", packed.name(&plain));
        }
    }
    for (name, bytes) in files {
        let _ = writeln!(text, "{}  {name}", blake3::hash(bytes));
    }
    text
}

impl Manifest {
    pub(super) fn read(bytes: &[u8]) -> anyhow::Result<Self> {
        let manifest: Self = serde_json::from_slice(bytes)
            .map_err(|error| anyhow!("{MANIFEST} is no manifest of an export: {error}"))?;
        let levels = &manifest.export.levels;
        if !(1..=MOST_LEVELS as usize).contains(&levels.len()) {
            return Err(anyhow!(
                "{MANIFEST}: export.levels: {} levels; allowed: 1 to {MOST_LEVELS}",
                levels.len()
            ));
        }
        for (k, level) in levels.iter().enumerate() {
            level
                .validate()
                .map_err(|fault| anyhow!("{MANIFEST}: export.levels[{k}].{fault}"))?;
        }
        let chunks: u128 = levels.iter().map(Level::chunks).sum();
        if u128::from(manifest.total.chunks) != chunks {
            return Err(anyhow!(
                "{MANIFEST}: total.chunks: {}; allowed: {chunks}, the chunks of export.levels",
                manifest.total.chunks
            ));
        }
        Ok(manifest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damaged_members_of_a_manifest_are_named() {
        let level = r#"{"size": 16, "lod": 1, "query": "", "columns": [0, 2], "rows": [0, 2]}"#;
        let manifest = format!(
            r#"{{"export": {{"strew": "1", "algorithm": 3, "world": null, "digests": [], "query": "", "format": "f32",
            "content_type": "", "bbox": [0, 0, 1, 1], "compressed": [], "levels": [{level}]}},
            "path": "", "columns": null, "levels": [], "total": {{"chunks": 4, "points": 0, "bytes": 0}}, "files": ""}}"#
        );
        let read = |text: &str| Manifest::read(text.as_bytes()).map_err(|error| error.to_string());
        assert!(read(&manifest).is_ok());
        let columns = "\"columns\": [0, 2]";
        for (old, new, fault) in [
            (level, "", "export.levels: 0 levels"),
            (
                "\"size\": 16",
                "\"size\": -16",
                "export.levels[0].size: -16",
            ),
            ("\"lod\": 1", "\"lod\": 0", "export.levels[0].lod: 0"),
            (
                columns,
                "\"columns\": [2, 0]",
                "export.levels[0].columns: [2, 0]",
            ),
            (
                "\"rows\": [0, 2]",
                "\"rows\": [0, 9223372036854775807]",
                "export.levels[0].rows: [0, ",
            ),
            (
                columns,
                "\"columns\": [0, 3]",
                "total.chunks: 4; allowed: 6",
            ),
        ] {
            let error = read(&manifest.replace(old, new)).expect_err(fault);
            assert!(error.contains(fault), "{error}");
        }
    }

    #[test]
    fn a_line_that_is_broken_off_is_none() {
        let record = Record {
            points: 12,
            files: vec![(blake3::hash(b"a"), 96), (blake3::hash(b"b"), 80)],
        };
        let line = record.line(7);
        assert_eq!(Record::read(&line), Some((7, record)));
        for end in 0..line.len() {
            assert_eq!(Record::read(&line[..end]), None);
        }
    }
}
