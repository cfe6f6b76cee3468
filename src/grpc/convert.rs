//! Between messages and the service's types.

use super::proto::{
    BoundingBox, Encoding, Figure, Figures, Parameter, Profile, Provenance, ResolvedQuery,
    StreamPointsRequest, stream_points_request::Amount,
};
use crate::service::{Catalog, Draft, Entry, Error, Fault, Query};

/// The encoding of a request, with the default filled in.
pub(super) fn encoding(request: &StreamPointsRequest) -> Result<Encoding, Fault> {
    match Encoding::try_from(request.encoding) {
        Ok(Encoding::Unspecified) => Ok(Encoding::Points),
        Ok(encoding) => Ok(encoding),
        Err(_) => {
            let known = [Encoding::Points, Encoding::F64Le, Encoding::F32Le];
            Err(Fault::new(
                "encoding",
                request.encoding,
                "there is no such encoding",
                known.map(|encoding| encoding.as_str_name()).join(", "),
            ))
        }
    }
}

/// The checked query of a request, with its encoding if that is in order.
pub(super) fn query(
    request: &StreamPointsRequest,
    encoding: Result<Encoding, Fault>,
    catalog: &Catalog,
) -> Result<(Query, Encoding), Error> {
    let (density, spacing) = match request.amount {
        Some(Amount::Density(density)) => (Some(density), None),
        Some(Amount::Spacing(spacing)) => (None, Some(spacing)),
        None => (None, None),
    };
    let draft = Draft {
        bbox: request
            .bbox
            .as_ref()
            .map(|b| [b.min_x, b.min_y, b.max_x, b.max_y]),
        density,
        spacing,
        profile: request.profile.as_deref(),
        alpha: request.alpha.as_deref(),
        map: request.map.as_deref(),
        seed: request.seed,
        warp: request.warp,
        table: request.table.as_deref(),
    };
    let faults = encoding.as_ref().err().cloned().into_iter().collect();
    let query = draft.check(catalog, faults)?;
    encoding
        .map(|encoding| (query, encoding))
        .map_err(|fault| Error::Invalid(vec![fault]))
}

/// A query as answers echo it.
pub(super) fn resolved(query: &Query, encoding: Encoding) -> ResolvedQuery {
    let [min_x, min_y, max_x, max_y] = query.bbox();
    ResolvedQuery {
        bbox: Some(BoundingBox {
            min_x,
            min_y,
            max_x,
            max_y,
        }),
        density: query.density,
        spacing: query.spacing.get(),
        profile: query.profile.clone(),
        alpha: query.alpha.to_string(),
        map: query.size.to_string(),
        seed: query.seed.0,
        warp: query.warp.strength(),
        encoding: encoding.into(),
    }
}

/// A loaded table.
pub(super) fn profile(entry: &Entry) -> Profile {
    let number = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let of = &entry.provenance;
    Profile {
        profile: entry.key.profile.as_ref().into(),
        alpha: entry.key.alpha.to_string(),
        map: entry.key.size.to_string(),
        radius: entry.radius,
        intervals: number(entry.intervals),
        blocks: number(entry.blocks()),
        bytes: entry.bytes().len() as u64,
        digest: entry.digest.clone(),
        provenance: Some(Provenance {
            optimizer: of.optimizer.clone(),
            parameters: of
                .parameters
                .iter()
                .cloned()
                .map(|(name, value)| Parameter { name, value })
                .collect(),
            seed: of.seed,
            twins: of
                .twins
                .iter()
                .map(|t| format!("{}/{}", t.p(), t.q()))
                .collect(),
            figures: of
                .figures
                .iter()
                .map(|figures| Figures {
                    subject: figures.subject.clone(),
                    seen: figures.seen,
                    points: figures.points,
                    values: figures
                        .values
                        .iter()
                        .cloned()
                        .map(|(name, value)| Figure { name, value })
                        .collect(),
                })
                .collect(),
        }),
    }
}
