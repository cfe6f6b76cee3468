//! Requests as the service's drafts. Nothing is checked here but what drafts cannot hold.

use super::{
    proto::{
        Encoding, FindNearestRequest, GetPointRequest, Layer, Position, Region, ScaleRange,
        StreamPointsRequest, Variant, find_nearest_request, get_point_request, layer,
        stream_points_request,
    },
    region,
};
use crate::service::{
    Draft, Error, Fault, Query, Service,
    query::{
        AmountDraft, AroundDraft, AttributesDraft, LayerDraft, RegionDraft, SetDraft, TableDraft,
        WindowDraft,
    },
};

/// The amounts of messages, which say the same in types of their own.
macro_rules! amounts {
    ($($message:ident: $($variant:ident = $field:ident),+;)+) => {$(
        impl From<$message::Amount> for AmountDraft {
            fn from(given: $message::Amount) -> Self {
                let mut draft = Self::default();
                match given {
                    $($message::Amount::$variant(value) => draft.$field = Some(value),)+
                }
                draft
            }
        }
    )+};
}

amounts! {
    stream_points_request: Density = density, Spacing = spacing, MinDistance = min_distance, Count = count;
    layer: Density = density, Spacing = spacing, MinDistance = min_distance, Count = count;
    get_point_request: Density = density, Spacing = spacing, MinDistance = min_distance;
    find_nearest_request: Density = density, Spacing = spacing, MinDistance = min_distance;
}

/// The sets of messages, which have the same fields.
macro_rules! sets {
    ($($message:ident),+) => {$(
        impl From<&$message> for SetDraft {
            fn from(given: &$message) -> Self {
                Self {
                    amount: given.amount.map(Into::into).unwrap_or_default(),
                    table: TableDraft {
                        profile: given.profile.clone(),
                        alpha: given.alpha.clone(),
                        map: given.map.clone(),
                        table: given.table.clone(),
                    },
                    seed: given.seed,
                    warp: given.warp,
                    keep: given.keep,
                    attributes: attributes(&given.attributes, given.scale_range, &given.variants),
                }
            }
        }
    )+};
}

sets!(
    StreamPointsRequest,
    Layer,
    GetPointRequest,
    FindNearestRequest
);

fn attributes(
    names: &[String],
    scale_range: Option<ScaleRange>,
    variants: &[Variant],
) -> AttributesDraft {
    let variant = |variant: &Variant| (variant.name.clone(), variant.weight.unwrap_or(1.0));
    AttributesDraft {
        names: names.into(),
        scale_range: scale_range.map(|range| [range.min, range.max]),
        variants: (!variants.is_empty()).then(|| variants.iter().map(variant).collect()),
    }
}

/// The encoding of a request, with the default filled in.
fn encoding(request: &StreamPointsRequest) -> Result<Encoding, Fault> {
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

/// The checked query of a request, with its encoding.
pub(super) fn query(
    request: &StreamPointsRequest,
    service: &Service,
) -> Result<(Query, Encoding), Error> {
    let mut faults = vec![];
    let encoding = encoding(request).map_err(|fault| faults.push(fault));
    let mut layers = vec![];
    for (i, layer) in request.layers.iter().enumerate() {
        let path = format!("layers[{i}].region");
        layers.push(LayerDraft {
            name: layer.name.clone(),
            region: draft_of(layer.region.as_ref(), &path, &mut faults),
            set: layer.into(),
            clear_of: layer.clear_of.clone().into_iter().collect(),
        });
    }
    let draft = Draft {
        region: draft_of(request.region.as_ref(), "region", &mut faults),
        set: request.into(),
        layers,
        window: WindowDraft {
            offset: Some(request.offset),
            limit: request.limit,
            cursor: (!request.cursor.is_empty()).then(|| request.cursor.clone()),
        },
    };
    let query = draft.check(&service.catalog(), service.limits().max_vertices, faults)?;
    let encoding = encoding.map_err(|()| Error::Internal("a fault is lost"))?;
    Ok((query, encoding))
}

fn draft_of(given: Option<&Region>, path: &str, faults: &mut Vec<Fault>) -> Option<RegionDraft> {
    given.map(|given| region::draft(given, path, 0, faults))
}

/// Which neighbors a request asks for.
pub(super) fn around(request: &FindNearestRequest) -> AroundDraft {
    AroundDraft {
        at: request.at.map(|Position { x, y }| [x, y]),
        k: request.k.map(u64::from),
        radius: request.radius,
    }
}
