//! The query of a command: from flags, from a file of JSON, with a region or features from a file of GeoJSON.

use std::{
    io::Read as _,
    path::{Path, PathBuf},
};

use anyhow::{Context as _, anyhow};
use strew_config::Config;
use strew_encode::Crs;
use strew_plan::{Planned, PlannedSet};
use strew_query::{
    BALL, Draft, Feature, Group, Options, RegionDraft, Set, ShapeDraft, Value, Values, groups, of,
    parameters::CRS, read_body, read_features, read_region,
};

use super::{
    Failure, config,
    failure::{Source, flag, refused},
    fields::{FieldArgs, StrataArgs},
    flags::{Flags, Takes, WHERE},
    refuse,
};

/// A query with a region: by flags, or whole in a file.
#[derive(Debug, clap::Args)]
pub(super) struct QueryArgs<T: Takes> {
    /// A whole query as JSON, the body of POST /v1/points:query; - is standard input. It allows no other flags
    /// than those of the output.
    #[arg(long, value_name = "FILE")]
    query: Option<PathBuf>,
    /// Points in space: --bbox takes six numbers, --chunk SIZE/CX/CY/CZ, and --query is the body of POST
    /// /v1/space/points.
    #[arg(long, help_heading = WHERE)]
    space: bool,
    /// The region: a chunk of the world grid. Coordinates are relative to its corner,
    /// SIZE·CX,SIZE·CY.
    #[arg(long, value_name = "SIZE/CX/CY[/CZ]", help_heading = WHERE)]
    chunk: Option<String>,
    /// The region: the polygons of a GeoJSON file; - is standard input.
    #[arg(long, value_name = "FILE", help_heading = WHERE)]
    region: Option<PathBuf>,
    /// The region: each feature of a GeoJSON collection by itself, as a layer of its name; - is standard input.
    #[arg(long, value_name = "FILE", help_heading = WHERE)]
    features: Option<PathBuf>,
    /// The property with the names of features [default: their places: 0, 1, 2, …]
    #[arg(long, value_name = "NAME", help_heading = WHERE, requires = "features")]
    feature_id: Option<String>,
    /// The property with the number of points of each feature.
    #[arg(long, value_name = "NAME", help_heading = WHERE, requires = "features")]
    feature_count: Option<String>,
    #[command(flatten)]
    pub(super) flags: Flags<T>,
    #[command(flatten)]
    field: FieldArgs,
    #[command(flatten)]
    strata: StrataArgs,
    #[command(flatten)]
    pub(super) settings: config::Args,
}

pub(super) struct PlannedQuery {
    pub(super) draft: Draft,
    pub(super) options: Options,
    pub(super) planned: Planned,
    pub(super) source: Source,
    /// The reference system of a file of PROJJSON.
    pub(super) crs: Option<Crs>,
}

impl<T: Takes> QueryArgs<T> {
    pub(super) fn plan(&self, config: &Config) -> Result<PlannedQuery, Failure> {
        let crs = self.defined()?;
        let (mut draft, source) = self.read(crs.as_ref())?;
        let catalog = self
            .field
            .load(&mut draft.values, config::tables(config)?)?;
        let (draft, catalog) = self.strata.split(draft, self.features()?, catalog)?;
        let catalog = config::with_worlds(config, catalog)?;
        let planned = config::planned(config, &draft, &catalog);
        let (planned, options) = planned.map_err(|error| source.refused(error))?;
        // The parts of a split may be sent to servers that do not have the world.
        let filled = draft.filled(&catalog.worlds);
        let filled = filled.map_err(|error| source.refused(error))?;
        Ok(PlannedQuery {
            draft: filled.0.into_owned(),
            options,
            planned,
            source,
            crs,
        })
    }

    fn in_file(&self) -> &'static [Group] {
        if self.space {
            return groups::SPACE_QUERY;
        }
        match T::GROUPS.contains(&Group::Output) {
            true => groups::QUERY,
            false => groups::COUNTED,
        }
    }

    /// The system of the file of PROJJSON that --crs names, if it names one.
    fn defined(&self) -> Result<Option<Crs>, Failure> {
        let text = self.flags.text(&CRS).unwrap_or_default();
        if !text.contains('/') && !text.ends_with("json") {
            return Ok(None);
        }
        let read = Crs::of_projjson(&read_file("--crs", Path::new(text))?.0);
        let crs = read.map_err(|detail| {
            Failure::Usage(anyhow!(
                "--crs {text}: {detail}; allowed: a file of PROJJSON, as `projinfo -o PROJJSON` writes it, or {}",
                CRS.allowed()
            ))
        });
        crs.map(Some)
    }

    /// The query. A reference system of a file goes by its name.
    fn read(&self, defined: Option<&Crs>) -> Result<(Draft, Source), Failure> {
        let name = |values: &mut Values| {
            if let Some(crs) = defined {
                values.replace(&CRS, Some(Value::Text(crs.to_string())));
            }
        };
        let Some(file) = &self.query else {
            let groups = match T::GROUPS.contains(&Group::Output) {
                true => groups::POINTS,
                false => groups::COUNT,
            };
            if !self.space && self.flags.has(&BALL) {
                refuse!("--ball is a region in space; allowed: --space beside it");
            }
            let mut values = match self.space {
                true => self.flags.values_in_space(groups::SPACE_POINTS),
                false => self.flags.values_of(groups),
            };
            name(&mut values);
            let draft = Draft::of(values);
            let draft = match self.region()? {
                Some(region) => draft.within(Ok(region)),
                None => draft,
            };
            return Ok((draft, Source::Flags));
        };
        let is_beside = |group| [Group::Output, Group::Reference, Group::Split].contains(&group);
        let others = self
            .flags
            .given()
            .filter(|parameter| !is_beside(parameter.group));
        let others = others.map(|parameter| parameter.name);
        let others: Vec<String> = others.chain(self.places()).map(flag).collect();
        if !others.is_empty() {
            let allowed = of(groups::OUTPUT).map(|parameter| flag(parameter.name));
            refuse!(
                "{} cannot be given beside --query {}, which holds the whole query; allowed beside \
                 it: {}",
                others.join(", "),
                file.display(),
                allowed.collect::<Vec<_>>().join(", ")
            );
        }
        let (bytes, source) = read_file("--query", file)?;
        let read = read_body(&bytes, self.in_file());
        let mut draft = read.map_err(|faults| source.refused(faults))?;
        // Flags of the output override the file.
        let mut output = self.flags.values_of(groups::OUTPUT);
        name(&mut output);
        let read = output.read();
        read.map_err(refused)?;
        for (parameter, value) in output.given() {
            draft.values.replace(parameter, Some(value.clone()));
        }
        Ok((draft, source))
    }

    /// The flags of regions that are no parameters.
    fn places(&self) -> impl Iterator<Item = &'static str> {
        let chunk = self.chunk.as_ref().map(|_| "chunk");
        let region = self.region.as_ref().map(|_| "region");
        let features = self.features.as_ref().map(|_| "features");
        chunk.into_iter().chain(region).chain(features)
    }

    /// The features of the flags, if there are any. Everything else that is given is common to all of them.
    fn features(&self) -> Result<Option<Vec<Feature>>, Failure> {
        let Some(file) = &self.features else {
            return Ok(None);
        };
        if self.space {
            refuse!(
                "--features is flat; in space a polygon between two heights is a prism of --query"
            );
        }
        let amounts = self.flags.given();
        let mut amounts =
            amounts.filter(|known| [Group::Amount, Group::Count].contains(&known.group));
        if let (Some(own), Some(amount)) = (&self.feature_count, amounts.next()) {
            refuse!(
                "{} beside --feature-count {own}, which has the numbers of points; allowed: one of both",
                flag(amount.name)
            );
        }
        let (bytes, source) = read_file("--features", file)?;
        let names = [self.feature_id.as_deref(), self.feature_count.as_deref()];
        let read = read_features(&bytes, names).map(Some);
        read.map_err(|faults| source.refused(faults))
    }

    fn region(&self) -> Result<Option<RegionDraft>, Failure> {
        let shapes = self
            .flags
            .given()
            .filter(|parameter| [Group::Region, Group::Volume].contains(&parameter.group));
        let shapes = shapes.map(|parameter| parameter.name);
        let given: Vec<String> = shapes.chain(self.places()).map(flag).collect();
        if given.len() > 1 {
            refuse!(
                "{} are given; a query has one region (for several use --query with include and exclude)",
                given.join(" and ")
            );
        }
        if let Some(file) = &self.region {
            if self.space {
                refuse!(
                    "--region is flat; in space a polygon between two heights is a prism of --query"
                );
            }
            let (bytes, source) = read_file("--region", file)?;
            let read = read_region(&bytes).map(Some);
            return read.map_err(|fault| source.refused(fault));
        }
        let chunk = |text| chunk(text, self.space);
        self.chunk.as_deref().map(chunk).transpose()
    }
}

fn chunk(text: &str, in_space: bool) -> Result<RegionDraft, Failure> {
    let read = || {
        let (size, cells) = text.split_once('/')?;
        let (size, cells) = (size.parse().ok()?, cells.split('/').map(str::parse));
        match *cells.collect::<Result<Vec<i64>, _>>().ok()? {
            [x, y] if !in_space => Some(ShapeDraft::Chunk(size, [x, y])),
            [x, y, z] if in_space => Some(ShapeDraft::Cube(size, [x, y, z])),
            _ => None,
        }
    };
    let allowed = match in_space {
        true => "SIZE/CX/CY/CZ, a size above 0 and three integers, such as 64/-3/2/0",
        false => "SIZE/CX/CY, a size above 0 and two integers, such as 64/-3/2",
    };
    let Some(shape) = read() else {
        refuse!("--chunk {text}: not a chunk; allowed: {allowed}");
    };
    Ok(RegionDraft {
        path: "chunk".into(),
        shape,
    })
}

/// The content of the file of a flag.
fn read_file(flag: &str, path: &Path) -> Result<(Vec<u8>, Source), Failure> {
    let read = if path == Path::new("-") {
        let mut bytes = vec![];
        std::io::stdin().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        std::fs::read(path)
    };
    let read = read.with_context(|| format!("{flag}: cannot read {}", path.display()));
    let source = Source::File(format!("{flag} {}", path.display()));
    read.map(|bytes| (bytes, source)).map_err(Failure::Usage)
}

pub(super) fn described(planned: &Planned) -> String {
    let sets = planned.query.sets.iter().zip(&planned.sets);
    let one = |(set, planned): (&Set, &PlannedSet)| {
        let name = if set.name.is_empty() {
            String::new()
        } else {
            format!("{}: ", set.name)
        };
        let period = set.period.map_or(String::new(), |period| {
            let (twin, side) = (period.twin, period.side);
            format!(
                ", period {twin} of {} points and side {side}",
                twin.points()
            )
        });
        format!(
            "{name}profile {}, alpha {}, map {}{period}, spacing {}, seed {}, warp {}, table {}",
            set.entry.key.profile,
            set.entry.key.alpha,
            set.entry.key.size,
            planned.spacing.get(),
            set.seed.0,
            set.warp.strength(),
            planned.entry.digest
        )
    };
    const SOME: usize = 4;
    let mut words: Vec<String> = sets.take(SOME).map(one).collect();
    if let more @ 1.. = planned.sets.len().saturating_sub(SOME) {
        words.push(format!("and {more} more"));
    }
    words.join("; ")
}
