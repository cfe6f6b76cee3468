//! `GET /v1/mask.png` and `GET /v1/mask/spectrum.svg`: tileable threshold masks.

use std::{pin::pin, sync::Arc};

use axum::extract::State;
use strew_error::{Error, Kind};
use strew_query::groups;
use strew_service::{
    Service,
    mask::{Drawn, MaskQuery},
    pattern::Format,
};

use super::{
    api::{self, Endpoint, Operation, Tag, schemas},
    context::{Context, Shared},
    document,
};
use crate::{body::Response, rest::Refused};

pub(super) fn endpoints(service: &Arc<Service>) -> [Endpoint; 2] {
    let mask = Operation {
        id: "getMask",
        summary: "A tileable threshold mask",
        about: "A gray picture that tiles: the pixels darker than a share of the gray levels are spread evenly, \
                whatever the share. For dithering and halftoning.",
        parameters: groups::MASK,
        example: "'/v1/mask.png?size=64&seed=7' -o mask.png".into(),
        ..Operation::new(Tag::Profiles, vec![])
    };
    let spectrum = Operation {
        id: "getMaskSpectrum",
        summary: "The spectrum of a threshold mask",
        about: "The power spectra of the pixels below 1/8, 1/4 and 1/2.",
        parameters: groups::MASK_SPECTRUM,
        example: "'/v1/mask/spectrum.svg?size=64&seed=7' -o spectrum.svg".into(),
        ..Operation::new(Tag::Profiles, vec![])
    };
    [
        drawn(Drawn::Thresholds, "/v1/mask.png", service, mask),
        drawn(Drawn::Spectrum, "/v1/mask/spectrum.svg", service, spectrum),
    ]
}

fn drawn(
    drawn: Drawn,
    path: &'static str,
    service: &Arc<Service>,
    mut operation: Operation,
) -> Endpoint {
    let (format, schema) = match drawn {
        Drawn::Thresholds => (Format::Png, schemas::any as schemas::Content),
        Drawn::Spectrum => (Format::Svg, schemas::text as schemas::Content),
    };
    let (content_type, parameters) = (format.content_type(), operation.parameters);
    operation.answers = api::Answer::file(operation.summary, content_type, schema).or_unchanged();
    operation.problems.push(Kind::OtherTable);
    let handler = move |State(service): Shared, context: Context| async move {
        let query = MaskQuery::check(&context.values(parameters), &service.catalog())?;
        let freshness = context.freshness(content_type, &query.entry.digest);
        let freshness = freshness.pinned(query.is_pinned);
        let make = async {
            let file = service.mask(&context.caller, query, drawn).await?;
            Ok::<Response, Error>(document::file(file, content_type))
        };
        Ok::<_, Refused>(freshness.answer(&context.headers, pin!(make)).await?)
    };
    Endpoint::only(path, service.clone(), operation, handler)
}
