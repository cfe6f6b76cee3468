//! Checks an export: the digests of all files, missing and foreign files, and whether this program still makes the same
//! points.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use anyhow::{Context as _, anyhow};
use rayon::prelude::*;
use strew_config::Config;

use super::{
    chunks::Maker,
    folder::WORK,
    record::{DIGESTS, MANIFEST, Manifest},
};
use crate::cli::{
    Failure,
    compression::Compression,
    config,
    progress::{Progress, Steps},
    refuse,
};

/// The number of chunks that are made again, unless all are.
const SAMPLE: usize = 100;
const NAMED: usize = 20;

struct Tree<'a>(&'a Path);

/// The faults, by the names of files.
#[derive(Default)]
struct Faults(BTreeMap<String, &'static str>);

/// Checks a folder; `all` makes every chunk again.
pub(super) fn run(path: &Path, all: bool, quiet: bool, config: &Config) -> Result<(), Failure> {
    if !path.is_dir() {
        refuse!(
            "--check {}: not a folder; allowed: the folder of an export (unpack a zip file of one first)",
            path.display()
        );
    }
    let tree = Tree(path);
    let manifest = tree.read(MANIFEST).with_context(|| {
        format!(
            "{} has no {MANIFEST}: it is no export, or incomplete",
            path.display()
        )
    });
    let manifest = Manifest::read(&manifest?)?;
    let mut faults = Faults::default();
    let digests = tree.digests(&manifest)?;
    tree.compare_names(&digests, &mut faults)?;
    let steps = Steps::new(Progress::new("files", digests.len() as u64, quiet), 0);
    let changed = digests.par_iter().filter_map(|(name, digest)| {
        let found = tree.read(name).map(|bytes| blake3::hash(&bytes));
        steps.step();
        match found {
            Ok(found) if found == *digest => None,
            Ok(_) => Some((name, "changed")),
            Err(_) => Some((name, "missing or unreadable")),
        }
    });
    for (name, fault) in changed.collect::<Vec<_>>() {
        faults.add(name, fault);
    }
    steps.finish();
    // Changed files need no further check.
    faults.report(path)?;
    let made = made_again(&tree, &manifest, all, quiet, config, &mut faults)?;
    faults.report(path)?;
    let total = manifest.total;
    if !quiet {
        eprintln!(
            "{} is complete: {} files, {} chunks, {} points; {made} chunks made again",
            path.display(),
            digests.len() + 2,
            total.chunks,
            total.points
        );
    }
    Ok(())
}

/// Makes chunks again and compares all their files; returns the number of chunks.
fn made_again(
    tree: &Tree<'_>,
    manifest: &Manifest,
    all: bool,
    quiet: bool,
    config: &Config,
    faults: &mut Faults,
) -> Result<usize, Failure> {
    let spec = &manifest.export;
    let maker = Maker::new(spec, &config::assets(config)?, config)?;
    let (chunks, compressions) = (maker.grid.chunks(), spec.compressions());
    let number = if all { chunks } else { SAMPLE.min(chunks) };
    let picked = |k: usize| (2 * k + 1) * chunks / (2 * number);
    let steps = Steps::new(Progress::new("chunks", number as u64, quiet), 0);
    // Compared chunks are dropped, so memory holds one for each thread.
    let differ = (0..number).into_par_iter().map(|k| {
        let i = picked(k);
        let chunk = maker.make(i)?;
        let plain = maker.grid.name(i);
        // Unreadable files are reported already.
        let differing = |packed: &Compression| {
            let name = packed.name(&plain);
            let bytes = packed.unpack(tree.read(&name).ok()?).ok();
            (bytes.as_ref() != Some(&chunk.bytes)).then_some(name)
        };
        let names: Vec<String> = compressions.iter().filter_map(differing).collect();
        steps.step();
        Ok(names)
    });
    for name in differ.collect::<Result<Vec<_>, Failure>>()?.concat() {
        faults.add(&name, "has other points than this program makes now");
    }
    steps.finish();
    Ok(number)
}

impl Tree<'_> {
    fn read(&self, name: &str) -> anyhow::Result<Vec<u8>> {
        let path = self.0.join(name);
        fs::read(&path).with_context(|| format!("cannot read {}", path.display()))
    }

    /// The digests of all files but the list of them and the manifest.
    fn digests(&self, manifest: &Manifest) -> anyhow::Result<BTreeMap<String, blake3::Hash>> {
        let list = self.read(DIGESTS)?;
        if blake3::hash(&list).to_hex().as_str() != manifest.files {
            return Err(anyhow!(
                "{DIGESTS} has changed: its digest is not that of {MANIFEST}"
            ));
        }
        let list = String::from_utf8(list).context("the list of digests is no text")?;
        let line = |line: &str| {
            let (digest, name) = line.split_once("  ")?;
            Some((name.to_owned(), blake3::Hash::from_hex(digest).ok()?))
        };
        let lines = list.lines().map(line).collect::<Option<_>>();
        lines.with_context(|| format!("{DIGESTS} is no list of digests"))
    }

    /// Reports files that are not in the list.
    fn compare_names(
        &self,
        digests: &BTreeMap<String, blake3::Hash>,
        faults: &mut Faults,
    ) -> anyhow::Result<()> {
        let names = below(self.0)?;
        let is_known = |name: &String| {
            digests.contains_key(name) || [MANIFEST, DIGESTS].contains(&name.as_str())
        };
        for name in names.iter().filter(|name| !is_known(name)) {
            faults.add(name, "foreign: the export has no such file");
        }
        Ok(())
    }
}

/// The names of all files below a folder.
fn below(root: &Path) -> anyhow::Result<BTreeSet<String>> {
    let mut open = vec![root.to_owned()];
    let mut names = BTreeSet::new();
    while let Some(folder) = open.pop() {
        let unreadable = || format!("cannot read {}", folder.display());
        for entry in fs::read_dir(&folder).with_context(unreadable)? {
            let entry = entry.with_context(unreadable)?;
            let path = entry.path();
            if entry.file_type().with_context(unreadable)?.is_dir() {
                open.push(path);
                continue;
            }
            let name = path.strip_prefix(root).unwrap_or(&path);
            names.insert(name.to_string_lossy().replace('\\', "/"));
        }
    }
    if names
        .iter()
        .any(|name| name.starts_with(&format!("{WORK}/")))
    {
        return Err(anyhow!(
            "{} is incomplete: run the export again",
            root.display()
        ));
    }
    Ok(names)
}

impl Faults {
    fn add(&mut self, name: &str, what: &'static str) {
        self.0.entry(name.into()).or_insert(what);
    }

    fn report(&self, path: &Path) -> Result<(), Failure> {
        if self.0.is_empty() {
            return Ok(());
        }
        let named = self
            .0
            .iter()
            .take(NAMED)
            .map(|(name, what)| format!("\n  {name}: {what}"));
        let more = match self.0.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!("\n  and {more} more"),
        };
        let differ = match self.0.len() {
            1 => "1 file differs".into(),
            number => format!("{number} files differ"),
        };
        Err(Failure::Other(anyhow!(
            "{}: {differ} from the export:{}{more}",
            path.display(),
            named.collect::<String>()
        )))
    }
}
