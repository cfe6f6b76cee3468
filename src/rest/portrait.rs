//! `GET /v1/profiles/{name}` and `…/spectrum.svg`: one table with its curves and its picture.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use schemars::JsonSchema;
use serde::Serialize;
use strew_catalog::{Dimension, Entry};
use strew_error::{Error, Kind};
use strew_forge::Aim;
use strew_query as query;
use strew_query::{Parameter, groups, parameters};
use strew_service::Service;

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    context::Context,
    document,
    freshness::Freshness,
    profiles::Profile,
};
use crate::{body::Response, rest::Refused};

/// The path of the curves.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = operation(
        "getProfile",
        "One noise profile with its curves",
        "The table's provenance and figures; the aim that it was made for, with the radial power curve it \
         follows if it follows one; radial power, anisotropy and radial distribution of a window of \
         the unbounded pattern.",
        (document::JSON, schemas::of::<Document<'_>>),
        "'/v1/profiles/blue?alpha=sqrt(3)'",
    );
    Endpoint::only("/v1/profiles/{name}", service, operation, get)
}

/// The path of the picture.
pub(super) fn picture(service: Arc<Service>) -> Endpoint {
    let operation = operation(
        "getSpectrum",
        "A picture of one noise profile",
        "Points, radial power, anisotropy and radial distribution.",
        (SVG, schemas::text),
        "/v1/profiles/blue/spectrum.svg -o spectrum.svg",
    );
    Endpoint::only("/v1/profiles/{name}/spectrum.svg", service, operation, svg)
}

/// The content type of the picture.
const SVG: &str = "image/svg+xml";

const NAME: Parameter = Parameter {
    name: "name",
    about: "The noise profile. The list of profiles shows what is loaded.",
    allowed: Some("the name of a loaded profile"),
    is_required: true,
    example: "blue",
    ..Parameter::PLAIN
};

fn operation(
    id: &'static str,
    summary: &'static str,
    about: &'static str,
    content: (&'static str, schemas::Content),
    example: &str,
) -> Operation {
    Operation {
        id,
        summary,
        about,
        path_parameters: &[&NAME],
        parameters: groups::TABLE,
        problems: vec![Kind::Invalid, Kind::NoSuchPath, Kind::OtherTable],
        example: example.into(),
        ..Operation::new(
            Tag::Profiles,
            api::Answer::file(summary, content.0, content.1).or_unchanged(),
        )
    }
}

/// The table of a profile with its measured curves.
async fn get(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
    let [name] = context.path();
    let (entry, freshness) = chosen(&service, name, &context, document::JSON)?;
    let make = async {
        let portrait = service.portrait(&entry).await?;
        let aim = entry.aim();
        document::json(&Document {
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

/// The picture.
async fn svg(State(service): State<Arc<Service>>, context: Context) -> Result<Response, Refused> {
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
#[schemars(rename = "ProfileCurves")]
struct Document<'a> {
    /// The table.
    table: Profile<'a>,
    /// The aim that it was made for; null if the table does not say.
    target: Option<Target<'a>>,
    /// The measured curves.
    measured: Measured<'a>,
}

/// The aim that a table was made for.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Target")]
struct Target<'a> {
    /// In words.
    statement: &'a str,
    /// Bounds on its figures.
    bounds: Vec<Limit>,
    /// The radial power curve that it follows, if it follows one.
    curve: Option<Curve<'a, 2>>,
}

/// A bound on a figure.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Bound")]
struct Limit {
    /// The name of the figure.
    figure: &'static str,
    /// `at most` or `at least`.
    side: String,
    /// The bound.
    limit: f64,
}

impl<'a> Target<'a> {
    fn new(aim: &'a Aim) -> Self {
        let bounds = aim.bounds.iter().map(|bound| Limit {
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
#[schemars(rename = "Measured")]
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
