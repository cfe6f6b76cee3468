//! The tables that are loaded, in the plane and in space, by their profiles.

use std::{collections::BTreeMap, pin::pin, sync::Arc};

use axum::extract::State;
use schemars::JsonSchema;
use serde::{Serialize, Serializer, ser::SerializeMap as _};
use strew_catalog::{Catalog, Dimension, Entry};
use strew_core::{ALGORITHM_VERSION, table};
use strew_error::integer::Long;
use strew_query::groups;
use strew_service::Service;

use super::{
    api::{self, Endpoint, Operation, Tag},
    context::Context,
    document,
};
use crate::{body::Response, rest::Refused};

/// The path of a dimension.
pub(super) fn endpoint(service: &Arc<Service>, dimension: Dimension) -> Endpoint {
    let (path, operation) = match dimension {
        Dimension::Plane => {
            let about = "The list, sorted by profile, then alpha.";
            let operation = Operation {
                id: "listProfiles",
                summary: "The noise profiles that are loaded",
                about: "Every table with its provenance and its measured figures.",
                ..Operation::new(Tag::Profiles, answers(about))
            };
            ("/v1/profiles", operation)
        }
        Dimension::Space => {
            let operation = Operation {
                id: "listSpaceProfiles",
                summary: "The tables of points in space",
                about: "The tables that are loaded, as GET /v1/profiles lists those of the plane.",
                ..Operation::new(Tag::Space, answers("The tables."))
            };
            ("/v1/space/profiles", operation)
        }
    };
    let operation = Operation {
        example: path.into(),
        ..operation
    };
    let get = move |State(service): State<Arc<Service>>, context: Context| async move {
        context.values(groups::NONE).read()?;
        let catalog = service.catalog();
        match dimension {
            Dimension::Plane => list(&context, &catalog, catalog.entries()).await,
            Dimension::Space => list(&context, &catalog, catalog.in_space()).await,
        }
    };
    Endpoint::only(path, service.clone(), operation, get)
}

fn answers(about: &'static str) -> Vec<api::Answer> {
    api::Answer::json::<Profiles<'_>>(about).or_unchanged()
}

/// Lists some tables of a catalog.
async fn list<'a>(
    context: &Context,
    catalog: &'a Catalog,
    entries: impl Iterator<Item = &'a Arc<Entry>> + Send,
) -> Result<Response, Refused> {
    let made_of: Vec<&str> = catalog.digests().collect();
    let make = async {
        document::json(&Profiles {
            algorithm: ALGORITHM_VERSION,
            profiles: entries.map(|entry| Profile::new(entry, catalog)).collect(),
        })
    };
    Ok(context.answer(document::JSON, &made_of, pin!(make)).await?)
}

/// The tables that are loaded.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Profiles")]
struct Profiles<'a> {
    /// The version of the algorithm that answers.
    algorithm: u32,
    /// Sorted by profile, then alpha.
    profiles: Vec<Profile<'a>>,
}

/// A table of a noise profile.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Profile")]
pub(super) struct Profile<'a> {
    /// The name of the noise profile.
    profile: &'a str,
    /// The number α of its pattern.
    alpha: String,
    /// The size of its map.
    map: String,
    /// The half-width R of its neighborhood map, in grid units.
    radius: u32,
    /// The intervals per axis, n.
    intervals: usize,
    /// The blocks, n², of a table in space n³.
    blocks: usize,
    /// The shares for which there is a table with joint kinds (`spread=joint`).
    joint_kinds: Vec<String>,
    /// The size of the file in bytes.
    bytes: u64,
    /// The BLAKE3 digest of the file.
    digest: &'a str,
    /// How it was made.
    provenance: Provenance<'a>,
}

/// How a table was made and what was measured on it.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Provenance")]
struct Provenance<'a> {
    /// The name of the optimizer.
    optimizer: &'a str,
    /// Its parameters by name.
    #[serde(serialize_with = "as_map")]
    #[schemars(with = "BTreeMap<String, String>")]
    parameters: &'a [(String, String)],
    /// The seed of its random start.
    seed: Long<u64>,
    /// The periodic twins it was optimized on, as fractions p/q.
    twins: Vec<String>,
    /// The figures that were measured.
    figures: Vec<Figures<'a>>,
}

/// Figures measured on one point set.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Figures")]
struct Figures<'a> {
    /// The point set that was measured.
    subject: &'a str,
    /// Whether the table was optimized on it.
    seen: bool,
    /// The number of its points.
    points: u64,
    /// The figures by name.
    #[serde(serialize_with = "as_map")]
    #[schemars(with = "BTreeMap<String, f64>")]
    values: &'a [(String, f64)],
}

impl<'a> Profile<'a> {
    pub(super) fn new(entry: &'a Entry, catalog: &Catalog) -> Self {
        Self {
            profile: &entry.key.profile,
            alpha: entry.key.alpha.to_string(),
            map: entry.key.size.to_string(),
            radius: entry.radius,
            intervals: entry.intervals,
            blocks: entry.blocks(),
            joint_kinds: catalog.joint_kinds(entry),
            bytes: entry.bytes,
            digest: &entry.digest,
            provenance: Provenance::new(&entry.provenance),
        }
    }
}

impl<'a> Provenance<'a> {
    fn new(of: &'a table::Provenance) -> Self {
        Self {
            optimizer: &of.optimizer,
            parameters: &of.parameters,
            seed: Long(of.seed),
            twins: of
                .twins
                .iter()
                .map(|t| format!("{}/{}", t.p(), t.q()))
                .collect(),
            figures: of
                .figures
                .iter()
                .map(|figures| Figures {
                    subject: &figures.subject,
                    seen: figures.seen,
                    points: figures.points,
                    values: &figures.values,
                })
                .collect(),
        }
    }
}

/// Pairs as an object, in their order.
fn as_map<S: Serializer, T: Serialize>(
    pairs: &&[(String, T)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(pairs.len()))?;
    for (name, value) in *pairs {
        map.serialize_entry(name, value)?;
    }
    map.end()
}
