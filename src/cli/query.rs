//! The query of a command: from flags, from a file of JSON, with a region from a file of GeoJSON.

use std::{
    io::Read as _,
    path::{Path, PathBuf},
};

use anyhow::{Context as _, anyhow};

use super::{
    Failure, config,
    flags::{Flags, Takes, WHERE, flag},
    refusal::Source,
};
use crate::{
    config::Config,
    service::{
        Catalog, Encoding, Error, Placed, Planned, PlannedSet, Ready, Set,
        catalog::CatalogError,
        encode::Options,
        query::{
            Body, Draft, LOOKS_NAMES, Parameters, REGION_NAMES, RegionDraft, ShapeDraft, read_body,
            read_region,
        },
    },
};

/// A query with a region: by flags, or whole in a file.
#[derive(Debug, clap::Args)]
pub(super) struct Asked<T: Takes> {
    /// A whole query as JSON, the body of POST /v1/points:query; - is standard input. Beside it only
    /// the looks of the answer may be given.
    #[arg(long, value_name = "FILE")]
    query: Option<PathBuf>,
    /// The region: a chunk of the world grid. Coordinates are relative to its corner,
    /// SIZE·CX,SIZE·CY.
    #[arg(long, value_name = "SIZE/CX/CY", help_heading = WHERE, allow_hyphen_values = true)]
    chunk: Option<String>,
    /// The region: the polygons of a GeoJSON file; - is standard input.
    #[arg(long, value_name = "FILE", help_heading = WHERE)]
    region: Option<PathBuf>,
    #[command(flatten)]
    pub(super) flags: Flags<T>,
    #[command(flatten)]
    pub(super) settings: config::Args,
}

/// A query that is in order, with its plan.
#[derive(Debug)]
pub(super) struct Ask {
    pub(super) draft: Draft,
    pub(super) options: Options,
    pub(super) planned: Planned,
    pub(super) source: Source,
}

impl<T: Takes> Asked<T> {
    /// The query, checked and planned.
    pub(super) fn plan(&self, config: &Config) -> Result<Ask, Failure> {
        let (body, source) = self.read()?;
        let (options, mut faults) = (body.options, body.faults);
        // Formats of files are unknown to queries.
        let is_of_file = |fault: &mut crate::service::Fault| {
            fault.field == "format" && fault.value.as_deref().and_then(of_file).is_some()
        };
        let refused: Vec<_> = faults.extract_if(.., is_of_file).collect();
        let file = refused
            .iter()
            .find_map(|fault| of_file(fault.value.as_deref()?));
        let mut options = Options {
            encoding: options.encoding.or(file),
            ..options
        };
        self.override_looks(&mut options)?;
        let catalog = config.tables()?;
        let limits = &config.limits;
        let query = body.draft.check(&catalog, limits.max_vertices, faults);
        let planned = query.and_then(|query| Planned::at_once(query, limits));
        Ok(Ask {
            draft: body.draft,
            options,
            planned: planned.map_err(|error| source.refused(error))?,
            source,
        })
    }

    fn read(&self) -> Result<(Body, Source), Failure> {
        let Some(file) = &self.query else {
            let region = self.region()?;
            let parameters = self.flags.parameters(|name| name != "parts");
            return Ok((parameters.draft(region, vec![]), Source::Flags));
        };
        let source = Source::File(format!("--query {}", file.display()));
        let others = self.flags.given().map(|(name, _)| name);
        let others = others.filter(|name| !LOOKS_NAMES.contains(name) && *name != "parts");
        let places = [
            self.chunk.as_ref().map(|_| "chunk"),
            self.region.as_ref().map(|_| "region"),
        ];
        let others: Vec<String> = others
            .chain(places.into_iter().flatten())
            .map(flag)
            .collect();
        if !others.is_empty() {
            return Err(Failure::Usage(anyhow!(
                "{} cannot be given beside --query {}, which holds the whole query; allowed beside \
                 it: {}",
                others.join(", "),
                file.display(),
                LOOKS_NAMES.map(flag).join(", ")
            )));
        }
        let bytes = read_file("--query", file)?;
        let body = read_body(&bytes).map_err(|error| source.refused(error))?;
        Ok((body, source))
    }

    /// What flags say of the looks is stronger than what a file says.
    fn override_looks(&self, options: &mut Options) -> Result<(), Failure> {
        if self.query.is_none() {
            return Ok(());
        }
        let file = self.flags.get("format").and_then(of_file);
        let is_known = |name: &str| file.is_none() || name != "format";
        let wanted = |name: &str| LOOKS_NAMES.contains(&name) && is_known(name);
        let looks = self.flags.parameters(wanted).looks();
        let looks = looks.map_err(|faults| Source::Flags.refused(Error::Invalid(faults)))?;
        let encoding = looks.encoding.or(file);
        options.encoding = encoding.or(options.encoding);
        options.decimals = looks.decimals.or(options.decimals);
        options.size = looks.size.or(options.size);
        Ok(())
    }

    /// A region that is no parameter.
    fn region(&self) -> Result<Option<RegionDraft>, Failure> {
        let shapes = self.flags.given().map(|(name, _)| name);
        let shapes = shapes.filter(|name| REGION_NAMES.contains(name));
        let others = [
            self.chunk.as_ref().map(|_| "chunk"),
            self.region.as_ref().map(|_| "region"),
        ];
        let given: Vec<String> = shapes
            .chain(others.into_iter().flatten())
            .map(flag)
            .collect();
        if given.len() > 1 {
            return Err(Failure::Usage(anyhow!(
                "{} are given; a query has one region (several: --query with include and exclude)",
                given.join(" and ")
            )));
        }
        if let Some(file) = &self.region {
            let bytes = read_file("--region", file)?;
            let source = Source::File(format!("--region {}", file.display()));
            let read = read_region(&bytes);
            return Ok(Some(
                read.map_err(|fault| source.refused(Error::Invalid(vec![fault])))?,
            ));
        }
        self.chunk.as_deref().map(chunk).transpose()
    }
}

/// The format of a name, if only files have it.
fn of_file(name: &str) -> Option<Encoding> {
    Encoding::from_any_name(name).filter(|encoding| Encoding::FILES.contains(encoding))
}

fn chunk(text: &str) -> Result<RegionDraft, Failure> {
    let read = || {
        let [size, x, y] = text.split('/').collect::<Vec<_>>().try_into().ok()?;
        Some(ShapeDraft::Chunk(
            size.parse().ok()?,
            [x.parse().ok()?, y.parse().ok()?],
        ))
    };
    let shape = read().ok_or_else(|| {
        Failure::Usage(anyhow!(
            "--chunk {text}: it is not such an address; allowed: SIZE/CX/CY, a size above 0 and \
             two integers, such as 64/-3/2"
        ))
    })?;
    Ok(RegionDraft {
        path: "chunk".into(),
        shape,
    })
}

/// The bytes of a file, or of standard input.
fn read_file(flag: &str, path: &Path) -> Result<Vec<u8>, Failure> {
    let read = if path == Path::new("-") {
        let mut bytes = vec![];
        std::io::stdin().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        std::fs::read(path)
    };
    let read = read.with_context(|| format!("{flag}: cannot read {}", path.display()));
    read.map_err(Failure::Usage)
}

/// A set of points without a region, laid into the world.
pub(super) fn placed(
    parameters: &Parameters,
    others: &[&str],
    config: &Config,
) -> Result<Placed, Failure> {
    let catalog = config.tables()?;
    let place = |set: Set| {
        let ready = Ready::load(&set.entry)?;
        Placed::new(set, ready)
    };
    let set = parameters.check_set(&catalog, others, vec![]);
    set.and_then(place)
        .map_err(|error| Source::Flags.refused(error))
}

/// What a planned query asks for, in a few words.
pub(super) fn described(planned: &Planned) -> String {
    let sets = planned.query.sets.iter().zip(&planned.sets);
    let one = |(set, planned): (&Set, &PlannedSet)| {
        let name = if set.name.is_empty() {
            String::new()
        } else {
            format!("{}: ", set.name)
        };
        format!(
            "{name}profile {}, alpha {}, map {}, spacing {}, seed {}, warp {}, table {}",
            set.entry.key.profile,
            set.entry.key.alpha,
            set.entry.key.size,
            planned.spacing.get(),
            set.seed.0,
            set.warp.strength(),
            planned.entry.digest
        )
    };
    sets.map(one).collect::<Vec<_>>().join("; ")
}

impl Config {
    /// The tables that the settings ask for.
    pub(super) fn catalog(&self) -> Result<Catalog, CatalogError> {
        Catalog::load(self.tables.embedded, self.tables.folder())
    }

    /// The same; settings that lead to none are wrong usage.
    pub(super) fn tables(&self) -> Result<Catalog, Failure> {
        self.catalog().map_err(|error| Failure::Usage(error.into()))
    }
}
