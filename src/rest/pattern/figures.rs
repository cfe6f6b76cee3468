//! `GET /v1/pattern/figures/….svg`: the figures of patterns.

use std::sync::Arc;

use axum::{body::Body, extract::State, response::Response, routing};
use http::{HeaderValue, Method, header};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    context::Context,
    freshness::Freshness,
};
use crate::service::{
    Error, Kind, Service,
    pattern::{Figure, FigureQuery},
};

/// The content type of figures.
const SVG: &str = "image/svg+xml";

/// What is said of a figure: itself, its path, its name for programs, a few words, the rest of its address.
type Described = (
    Figure,
    &'static str,
    &'static str,
    &'static str,
    &'static str,
);

const FIGURES: [Described; 4] = [
    (
        Figure::Index,
        "/v1/pattern/figures/index.svg",
        "getIndexFigure",
        "A figure of the pattern, the index torus and the set region",
        "alpha=sqrt(3)&window=32",
    ),
    (
        Figure::Arrangement,
        "/v1/pattern/figures/arrangement.svg",
        "getArrangementFigure",
        "A figure of an arrangement, its image and its margin",
        "offsets=2,1+3,3",
    ),
    (
        Figure::Clusters,
        "/v1/pattern/figures/clusters.svg",
        "getClustersFigure",
        "A figure of clusters in the plane and in the set region",
        "alpha=sqrt(3)&distance=2&window=32",
    ),
    (
        Figure::Map,
        "/v1/pattern/figures/map.svg",
        "getMapFigure",
        "A figure of a neighborhood map, a block's neighbors and the growth with R",
        "radius=20&block=3,8",
    ),
];

/// The paths.
pub(super) fn endpoints(service: &Arc<Service>) -> Vec<Endpoint> {
    let one = |described: Described| {
        let (figure, path, id, summary, query) = described;
        let operation = Operation {
            method: Method::GET,
            id,
            summary,
            about: "As strew figure draws it, for any α.",
            tag: Tag::Patterns,
            path_parameters: &[],
            parameters: figure.groups(),
            body: None,
            answers: vec![
                api::Answer {
                    status: 200,
                    about: "The figure.",
                    headers: vec![],
                    contents: vec![(SVG, schemas::text)],
                },
                api::Answer::unchanged(),
            ],
            problems: vec![Kind::Invalid],
            example: format!("'{path}?{query}' -o figure.svg"),
        };
        let handler = routing::get(
            move |State(service): State<Arc<Service>>, context: Context| async move {
                draw(&service, &context, figure).await
            },
        );
        Endpoint::new(path, service.clone(), vec![(operation, handler)])
    };
    FIGURES.into_iter().map(one).collect()
}

async fn draw(service: &Service, context: &Context, figure: Figure) -> Result<Response, Error> {
    let query = FigureQuery::check(figure, &context.values(figure.groups()))?;
    let freshness = Freshness::of(&context.uri, &context.headers, SVG, &());
    let make = service.figure(&context.caller, query, |drawing| {
        let mut response = Response::new(Body::from(drawing.to_svg()));
        let value = HeaderValue::from_static(SVG);
        response.headers_mut().insert(header::CONTENT_TYPE, value);
        Ok(response)
    });
    freshness.answer(&context.headers, make).await
}
