//! `GET /v1/profiles/{name}` and `…/spectrum.svg`: one table with its curves and its picture.

use std::sync::Arc;

use axum::{
    body::Body,
    extract::{Path, State},
    response::Response,
};
use http::{HeaderValue, Uri, header};
use serde::Serialize;

use super::profiles::Profile;
use crate::service::{Entry, Error, Portrait, Service, query::parse_pairs};

/// The table of a profile with its measured curves.
pub(super) async fn get(
    State(service): State<Arc<Service>>,
    Path(name): Path<String>,
    uri: Uri,
) -> Result<Response, Error> {
    let (entry, portrait) = portrait(&service, &name, &uri).await?;
    let document = Document {
        table: Profile::new(&entry),
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
    };
    let mut body = serde_json::to_vec(&document)
        .map_err(|_| Error::Internal("the profile cannot be written"))?;
    body.push(b'\n');
    Ok(typed(body, "application/json"))
}

/// The picture.
pub(super) async fn svg(
    State(service): State<Arc<Service>>,
    Path(name): Path<String>,
    uri: Uri,
) -> Result<Response, Error> {
    let (_, portrait) = portrait(&service, &name, &uri).await?;
    Ok(typed(portrait.svg.clone().into_bytes(), "image/svg+xml"))
}

async fn portrait(
    service: &Service,
    name: &str,
    uri: &Uri,
) -> Result<(Arc<Entry>, Arc<Portrait>), Error> {
    if service.catalog().alphas(name).is_empty() {
        return Err(Error::NoSuchPath {
            path: uri.path().into(),
            available: service
                .catalog()
                .profiles()
                .iter()
                .map(|profile| format!("/v1/profiles/{profile}"))
                .collect::<Vec<_>>()
                .join(", "),
        });
    }
    let (parameters, faults) = parse_pairs(uri.query().unwrap_or_default());
    let entry = parameters.entry(service.catalog(), name, faults)?;
    let portrait = service.portrait(&entry).await?;
    Ok((entry, portrait))
}

fn typed(body: Vec<u8>, content_type: &'static str) -> Response {
    let mut response = Response::new(Body::from(body));
    let value = HeaderValue::from_static(content_type);
    response.headers_mut().insert(header::CONTENT_TYPE, value);
    response
}

#[derive(Serialize)]
struct Document<'a> {
    table: Profile<'a>,
    measured: Measured<'a>,
}

/// What was measured on a window of the unbounded pattern.
#[derive(Serialize)]
struct Measured<'a> {
    points: u64,
    radial: Curve<'a, 3>,
    rdf: Curve<'a, 2>,
}

#[derive(Serialize)]
struct Curve<'a, const N: usize>
where
    [f64; N]: Serialize,
    [&'static str; N]: Serialize,
{
    columns: [&'static str; N],
    values: &'a [[f64; N]],
}
