//! `GET /v1/mask.png` and `GET /v1/mask/spectrum.svg`: tileable threshold masks.

use std::sync::Arc;

use axum::{extract::State, response::Response, routing};
use http::Method;

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    context::Context,
    document,
    freshness::Freshness,
};
use crate::service::{
    Error, Kind, Service,
    mask::{Drawn, MaskQuery},
    pattern::Format,
    query::{Group, groups},
};

/// The path of the mask.
pub(super) fn endpoint(service: Arc<Service>) -> Endpoint {
    let operation = operation(
        "getMask",
        "A tileable threshold mask",
        "A gray picture that tiles: the pixels darker than a share of the gray levels are spread evenly, whatever \
         the share. For dithering and halftoning.",
        (Drawn::Thresholds, groups::MASK),
        "'/v1/mask.png?size=64&seed=7' -o mask.png",
    );
    let handler = routing::get(
        async |State(service): State<Arc<Service>>, context: Context| {
            answer(&service, &context, Drawn::Thresholds, groups::MASK).await
        },
    );
    Endpoint::new("/v1/mask.png", service, vec![(operation, handler)])
}

/// The path of its spectrum.
pub(super) fn spectrum(service: Arc<Service>) -> Endpoint {
    let operation = operation(
        "getMaskSpectrum",
        "The spectrum of a threshold mask",
        "The power spectra of the pixels below 1/8, 1/4 and 1/2.",
        (Drawn::Spectrum, groups::MASK_SPECTRUM),
        "'/v1/mask/spectrum.svg?size=64&seed=7' -o spectrum.svg",
    );
    let handler = routing::get(
        async |State(service): State<Arc<Service>>, context: Context| {
            answer(&service, &context, Drawn::Spectrum, groups::MASK_SPECTRUM).await
        },
    );
    Endpoint::new("/v1/mask/spectrum.svg", service, vec![(operation, handler)])
}

fn operation(
    id: &'static str,
    summary: &'static str,
    about: &'static str,
    (drawn, parameters): (Drawn, &'static [Group]),
    example: &str,
) -> Operation {
    Operation {
        method: Method::GET,
        id,
        summary,
        about,
        tag: Tag::Profiles,
        path_parameters: &[],
        parameters,
        body: None,
        answers: vec![
            api::Answer {
                status: 200,
                about: summary,
                headers: vec![],
                contents: vec![(content_type(drawn), content(drawn))],
            },
            api::Answer::unchanged(),
        ],
        problems: vec![Kind::Invalid, Kind::OtherTable],
        example: example.into(),
    }
}

const fn content_type(drawn: Drawn) -> &'static str {
    match drawn {
        Drawn::Thresholds => Format::Png.content_type(),
        Drawn::Spectrum => Format::Svg.content_type(),
    }
}

const fn content(drawn: Drawn) -> schemas::Content {
    match drawn {
        Drawn::Thresholds => schemas::any,
        Drawn::Spectrum => schemas::text,
    }
}

async fn answer(
    service: &Service,
    context: &Context,
    drawn: Drawn,
    parameters: &'static [Group],
) -> Result<Response, Error> {
    let query = MaskQuery::check(&context.values(parameters), &service.catalog())?;
    let content_type = content_type(drawn);
    let digest = &query.entry.digest;
    let freshness = Freshness::of(&context.uri, &context.headers, content_type, digest);
    let freshness = freshness.pinned(query.is_pinned);
    let make = async {
        let file = service.mask(&context.caller, query, drawn).await?;
        Ok(document::file(file, content_type))
    };
    freshness.answer(&context.headers, make).await
}
