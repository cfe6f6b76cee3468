//! The flags of a query, shared by the commands that take one.

use anyhow::anyhow;

use super::{Failure, config};
use crate::{
    config::Config,
    service::{
        Catalog, Encoding, Planned, PlannedSet, Set,
        catalog::CatalogError,
        encode::Options,
        query::{Parameters, read_bbox},
    },
};

/// The parameters of `GET /v1/points`, and the settings that say which tables there are.
#[derive(Debug, clap::Args)]
pub(super) struct Query {
    /// The box: minx,miny,maxx,maxy in world units, half-open.
    #[arg(long, value_name = "BOX", allow_hyphen_values = true)]
    bbox: Option<String>,
    /// Points per unit of area.
    #[arg(long, allow_hyphen_values = true)]
    density: Option<String>,
    /// The mean spacing, density^-1/2.
    #[arg(long, allow_hyphen_values = true)]
    spacing: Option<String>,
    /// The noise profile [default: blue].
    #[arg(long)]
    profile: Option<String>,
    /// The number alpha [default: (5-sqrt(3))/2].
    #[arg(long, allow_hyphen_values = true)]
    alpha: Option<String>,
    /// The size of the map: s, m or l, as far as it is loaded [default: s].
    #[arg(long)]
    map: Option<String>,
    /// Which set of points [default: 0].
    #[arg(long, allow_hyphen_values = true)]
    seed: Option<String>,
    /// off, on, or the strength of the warp, 0 to 2 [default: off for seed 0, else on].
    #[arg(long, allow_hyphen_values = true)]
    warp: Option<String>,
    /// The digest of the table that has to make them.
    #[arg(long, value_name = "DIGEST")]
    table: Option<String>,
    #[command(flatten)]
    settings: config::Args,
}

/// How an answer is to look.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Looks {
    /// json, ndjson, csv, geojson, geojsonseq, f32, f64, npy, ply, arrow, png, svg or parquet
    /// [default: what the output's name ends with, or json].
    #[arg(long)]
    format: Option<String>,
    /// Decimals of numbers in text formats, 0 to 17 [default: the shortest digits that read back].
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    decimals: Option<String>,
    /// The longer side of a png or svg in pixels, 16 to 4096 [default: 512].
    #[arg(long, value_name = "PIXELS", allow_hyphen_values = true)]
    size: Option<String>,
}

impl Query {
    /// The merged settings.
    pub(super) fn settings(&self) -> Result<Config, Failure> {
        self.settings.merged()
    }

    /// The query, checked and planned, and the options of the output.
    pub(super) fn planned(
        &self,
        config: &Config,
        looks: &Looks,
    ) -> Result<(Planned, Options), Failure> {
        let catalog = config
            .catalog()
            .map_err(|error| Failure::Usage(error.into()))?;
        // Only files are Parquet, so no query knows the name.
        let parquet = looks.format.as_deref() == Some(Encoding::Parquet.name());
        let parameters = Parameters::of([
            ("bbox", self.bbox.clone()),
            ("density", self.density.clone()),
            ("spacing", self.spacing.clone()),
            ("profile", self.profile.clone()),
            ("alpha", self.alpha.clone()),
            ("map", self.map.clone()),
            ("seed", self.seed.clone()),
            ("warp", self.warp.clone()),
            ("table", self.table.clone()),
            ("format", looks.format.clone().filter(|_| !parquet)),
            ("decimals", looks.decimals.clone()),
            ("size", looks.size.clone()),
        ]);
        let usage = |error| Failure::Usage(anyhow::Error::new(error));
        let limits = &config.limits;
        let (query, mut options) = parameters
            .check(&catalog, limits.max_vertices, None, vec![])
            .map_err(usage)?;
        let planned = Planned::from_catalog(&catalog, query, limits).map_err(usage)?;
        if parquet {
            options.encoding = Some(Encoding::Parquet);
        }
        Ok((planned, options))
    }

    /// Only the box: min x, min y, max x, max y.
    pub(super) fn corners(&self) -> anyhow::Result<[f64; 4]> {
        let read = read_bbox(self.bbox.as_deref()).map_err(|fault| anyhow!("{fault}"))?;
        read.ok_or_else(|| anyhow!("--bbox is missing"))
    }
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
            set.key.profile,
            set.key.alpha,
            set.key.size,
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
        let folder = (!self.tables.folder.as_os_str().is_empty()).then_some(&*self.tables.folder);
        Catalog::load(self.tables.embedded, folder)
    }
}
