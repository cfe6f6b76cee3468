//! `GET /v1/pattern/figures/….svg` and `….png`: the figures of patterns.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use strew_error::Error;
use strew_service::{
    Service,
    pattern::{Figure, FigureQuery, Format},
};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    context::Context,
    document,
};
use crate::{body::Response, rest::Refused};

/// A figure as it is described: itself, its paths as a drawing and as pixels, their names for programs, a few words,
/// the rest of its address.
type Described = (
    Figure,
    [&'static str; 2],
    [&'static str; 2],
    &'static str,
    &'static str,
);

const FIGURES: [Described; 4] = [
    (
        Figure::Index,
        [
            "/v1/pattern/figures/index.svg",
            "/v1/pattern/figures/index.png",
        ],
        ["getIndexFigure", "getIndexPicture"],
        "A figure of the pattern, the index torus and the set region",
        "alpha=sqrt(3)&window=32",
    ),
    (
        Figure::Arrangement,
        [
            "/v1/pattern/figures/arrangement.svg",
            "/v1/pattern/figures/arrangement.png",
        ],
        ["getArrangementFigure", "getArrangementPicture"],
        "A figure of an arrangement, its image and its margin",
        "offsets=2,1+3,3",
    ),
    (
        Figure::Clusters,
        [
            "/v1/pattern/figures/clusters.svg",
            "/v1/pattern/figures/clusters.png",
        ],
        ["getClustersFigure", "getClustersPicture"],
        "A figure of clusters in the plane and in the set region",
        "alpha=sqrt(3)&distance=2&window=32",
    ),
    (
        Figure::Map,
        ["/v1/pattern/figures/map.svg", "/v1/pattern/figures/map.png"],
        ["getMapFigure", "getMapPicture"],
        "A figure of a neighborhood map, a block's neighbors and the growth with R",
        "radius=20&block=3,8",
    ),
];

/// The paths.
pub(super) fn endpoints(service: &Arc<Service>) -> Vec<Endpoint> {
    let both = |described| {
        [Format::Svg, Format::Png].map(|format| endpoint(service.clone(), described, format))
    };
    FIGURES.into_iter().flat_map(both).collect()
}

fn endpoint(service: Arc<Service>, described: Described, format: Format) -> Endpoint {
    let (figure, paths, ids, summary, query) = described;
    let (number, content, ending, more) = match format {
        Format::Svg => (0, schemas::text as schemas::Content, "svg", ""),
        Format::Png => (1, schemas::any as schemas::Content, "png", "&size=800"),
    };
    let operation = Operation {
        id: ids[number],
        summary,
        about: "As strew figure draws it, for any α.",
        parameters: figure.groups(format),
        example: format!("'{}?{query}{more}' -o figure.{ending}", paths[number]),
        ..Operation::new(
            Tag::Patterns,
            api::Answer::file("The figure.", format.content_type(), content).or_unchanged(),
        )
    };
    let handler = move |State(service): State<Arc<Service>>, context: Context| async move {
        Ok::<_, Refused>(draw(&service, &context, figure, format).await?)
    };
    Endpoint::only(paths[number], service, operation, handler)
}

async fn draw(
    service: &Service,
    context: &Context,
    figure: Figure,
    format: Format,
) -> Result<Response, Error> {
    let query = FigureQuery::check(figure, &context.values(figure.groups(format)))?;
    let content_type = format.content_type();
    let make = async {
        let file = service.figure(&context.caller, query, format).await?;
        Ok(document::file(file, content_type))
    };
    context.answer(content_type, &(), pin!(make)).await
}
