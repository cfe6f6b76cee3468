//! The tables that are loaded: their list in the plane and in space, one of the plane with its curves and its picture,
//! and the periods that a table has.

use std::{collections::BTreeMap, pin::pin, sync::Arc};

use axum::extract::State;
use schemars::JsonSchema;
use serde::{Serialize, Serializer, ser::SerializeMap as _};
use strew_catalog::{Catalog, Dimension, Entry};
use strew_core::{ALGORITHM_VERSION, table};
use strew_error::{Error, Kind, integer::Long};
use strew_forge::Aim;
use strew_query::{self as query, Parameter, Periods, groups, parameters};
use strew_service::Service;

use super::{
    Refused,
    api::{self, Endpoint, Operation, Tag, either, schemas},
    context::{Answered, Context, Shared},
    document,
    freshness::Freshness,
};

pub(super) fn list(service: &Arc<Service>, dimension: Dimension) -> Endpoint {
    let summary = [
        "The noise profiles that are loaded",
        "The tables of points in space",
    ];
    let about = [
        "Every table with its provenance and its measured figures.",
        "The tables that are loaded, as GET /v1/profiles lists those of the plane.",
    ];
    let answer = either(
        dimension,
        ["The list, sorted by profile, then alpha.", "The tables."],
    );
    let answers = api::Answer::json::<Profiles<'_>>(answer).or_unchanged();
    let operation = Operation {
        id: either(dimension, ["listProfiles", "listSpaceProfiles"]),
        summary: either(dimension, summary),
        about: either(dimension, about),
        ..Operation::new(either(dimension, [Tag::Profiles, Tag::Space]), answers)
    };
    let get = move |State(service): Shared, context: Context| async move {
        context.values(groups::NONE).read()?;
        let catalog = service.catalog();
        let made_of: Vec<&str> = catalog.tables().map(|entry| &*entry.digest).collect();
        let make = async {
            let new = |entry| Profile::new(entry, &catalog);
            document::json(&Profiles {
                algorithm: ALGORITHM_VERSION,
                profiles: match dimension {
                    Dimension::Plane => catalog.entries().map(new).collect(),
                    Dimension::Space => catalog.in_space().map(new).collect(),
                },
            })
        };
        Ok::<_, Refused>(context.answer(document::JSON, &made_of, pin!(make)).await?)
    };
    let path = either(dimension, ["/v1/profiles", "/v1/space/profiles"]);
    Endpoint::only(path, service.clone(), operation, get)
}

/// The tables that are loaded.
#[derive(Serialize, JsonSchema)]
struct Profiles<'a> {
    /// The version of the algorithm that answers.
    algorithm: u32,
    /// Sorted by profile, then alpha.
    profiles: Vec<Profile<'a>>,
}

/// A table of a noise profile.
#[derive(Serialize, JsonSchema)]
struct Profile<'a> {
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
    fn new(entry: &'a Arc<Entry>, catalog: &Catalog) -> Self {
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
        let figures = of.figures.iter().map(|figures| Figures {
            subject: &figures.subject,
            seen: figures.seen,
            points: figures.points,
            values: &figures.values,
        });
        Self {
            optimizer: &of.optimizer,
            parameters: &of.parameters,
            seed: Long(of.seed),
            twins: of.twins.iter().map(ToString::to_string).collect(),
            figures: figures.collect(),
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

pub(super) fn one(service: &Arc<Service>) -> [Endpoint; 2] {
    let answer = "One noise profile with its curves";
    let answers = api::Answer::json::<ProfileCurves<'_>>(answer).or_unchanged();
    let curves = Operation {
        id: "getProfile",
        summary: answer,
        about: "The table's provenance and figures; the aim that it was made for, with the radial power curve it \
                follows if it follows one; radial power, anisotropy and radial distribution of a window of \
                the unbounded pattern.",
        path_parameters: &[&NAME],
        parameters: groups::TABLE,
        problems: vec![Kind::Invalid, Kind::NoSuchPath, Kind::OtherTable],
        example: "'/v1/profiles/blue?alpha=sqrt(3)'".into(),
        ..Operation::new(Tag::Profiles, answers)
    };
    let answer = "A picture of one noise profile";
    let picture = Operation {
        id: "getSpectrum",
        summary: answer,
        about: "Points, radial power, anisotropy and radial distribution.",
        answers: api::Answer::file(answer, SVG, schemas::text).or_unchanged(),
        example: "/v1/profiles/blue/spectrum.svg -o spectrum.svg".into(),
        ..curves.clone()
    };
    [
        Endpoint::only("/v1/profiles/{name}", service.clone(), curves, get),
        Endpoint::only(
            "/v1/profiles/{name}/spectrum.svg",
            service.clone(),
            picture,
            svg,
        ),
    ]
}

const SVG: &str = "image/svg+xml";

const NAME: Parameter = Parameter {
    name: "name",
    about: "The noise profile. The list of profiles shows what is loaded.",
    allowed: Some("the name of a loaded profile"),
    is_required: true,
    example: "blue",
    ..Parameter::PLAIN
};

async fn get(State(service): Shared, context: Context) -> Answered {
    let [name] = context.path();
    let (entry, freshness) = chosen(&service, name, &context, document::JSON)?;
    let make = async {
        let portrait = service.portrait(&entry).await?;
        let aim = entry.aim();
        document::json(&ProfileCurves {
            table: Profile::new(&entry, &service.catalog()),
            target: aim.as_ref().map(Target::new),
            measured: Measured {
                points: portrait.points,
                radial: Curve {
                    columns: ["nu", "power", "anisotropy_db"],
                    values: &portrait.radial,
                },
                rdf: Curve {
                    columns: ["distance", "g"],
                    values: &portrait.rdf,
                },
            },
        })
    };
    Ok(freshness.answer(&context.headers, pin!(make)).await?)
}

async fn svg(State(service): Shared, context: Context) -> Answered {
    let [name] = context.path();
    let (entry, freshness) = chosen(&service, name, &context, SVG)?;
    let make = async {
        let portrait = service.portrait(&entry).await?;
        Ok(document::file(portrait.svg.clone(), SVG))
    };
    Ok(freshness.answer(&context.headers, pin!(make)).await?)
}

/// The table that is wanted, and how fresh what is made of it is.
fn chosen(
    service: &Service,
    name: &str,
    context: &Context,
    content_type: &'static str,
) -> Result<(Arc<Entry>, Freshness), Error> {
    let catalog = service.catalog();
    if catalog.alphas(Dimension::Plane, name).is_empty() {
        let profiles = catalog.profiles(Dimension::Plane);
        let paths = profiles.iter().map(|name| format!("/v1/profiles/{name}"));
        return Err(context.nothing(paths.collect::<Vec<_>>().join(", ")));
    }
    let values = context.values(groups::TABLE);
    let entry = query::entry(&values, name, &catalog)?;
    let freshness = context.freshness(content_type, &entry.digest);
    Ok((entry, freshness.pinned(values.has(&parameters::TABLE))))
}

/// A table of a noise profile with its curves.
#[derive(Serialize, JsonSchema)]
struct ProfileCurves<'a> {
    /// The table.
    table: Profile<'a>,
    /// The aim that it was made for; null if the table does not say.
    target: Option<Target<'a>>,
    /// The measured curves.
    measured: Measured<'a>,
}

/// The aim that a table was made for.
#[derive(Serialize, JsonSchema)]
struct Target<'a> {
    /// In words.
    statement: &'a str,
    /// Bounds on its figures.
    bounds: Vec<Bound>,
    /// The radial power curve that it follows, if it follows one.
    curve: Option<Curve<'a, 2>>,
}

/// A bound on a figure.
#[derive(Serialize, JsonSchema)]
struct Bound {
    /// The name of the figure.
    figure: &'static str,
    /// `at most` or `at least`.
    side: String,
    /// The bound.
    limit: f64,
}

impl<'a> Target<'a> {
    fn new(aim: &'a Aim) -> Self {
        let bounds = aim.bounds.iter().map(|bound| Bound {
            figure: bound.figure.name(),
            side: bound.side.to_string(),
            limit: bound.limit,
        });
        Self {
            statement: &aim.statement,
            bounds: bounds.collect(),
            curve: aim.curve.as_ref().map(|curve| Curve {
                columns: ["nu", "power"],
                values: curve.points(),
            }),
        }
    }
}

/// The curves of a window of the unbounded pattern.
#[derive(Serialize, JsonSchema)]
struct Measured<'a> {
    /// The number of points in the window.
    points: u64,
    /// Radial power and anisotropy by frequency.
    radial: Curve<'a, 3>,
    /// The radial distribution by distance.
    rdf: Curve<'a, 2>,
}

/// A curve: rows of numbers.
#[derive(Serialize, JsonSchema)]
#[schemars(inline)]
struct Curve<'a, const N: usize>
where
    [f64; N]: Serialize,
    [&'static str; N]: Serialize,
{
    /// The names of the columns.
    #[schemars(with = "Vec<String>")]
    columns: [&'static str; N],
    /// The rows.
    #[schemars(with = "Vec<Vec<f64>>")]
    values: &'a [[f64; N]],
}

pub(super) fn periods(service: &Arc<Service>) -> Endpoint {
    let answers = api::Answer::json::<Periods>("The list.").or_unchanged();
    let operation = Operation {
        id: "listPeriods",
        summary: "The periods of a table",
        about: "The sizes of periodic sets, smallest first: with periodic, from that number of points on.",
        parameters: groups::PERIODS,
        problems: vec![Kind::Invalid, Kind::OtherTable],
        example: "'/v1/periods?periodic=20000&most=3'".into(),
        ..Operation::new(Tag::Profiles, answers)
    };
    let get = async |State(service): Shared, context: Context| {
        let periods = Periods::of(&context.values(groups::PERIODS), &service.catalog())?;
        let made_of = (&periods.alpha, periods.radius);
        let make = async { document::json(&periods) };
        Ok::<_, Refused>(context.answer(document::JSON, &made_of, pin!(make)).await?)
    };
    Endpoint::only("/v1/periods", service.clone(), operation, get)
}
