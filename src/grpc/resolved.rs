//! Queries as answers echo them.

use strew_core::Attribute;

use super::proto::{
    self, BoundingBox, Encoding, Region, ResolvedQuery, ScaleRange, StreamPointsRequest, Variant,
};
use crate::service::{
    Entry, Placed, Planned, Set,
    query::{Resolved, ResolvedSet},
};

/// The query of a request, planned.
pub(super) fn query(
    request: &StreamPointsRequest,
    planned: &Planned,
    encoding: Encoding,
) -> ResolvedQuery {
    let Resolved {
        bbox: [min_x, min_y, max_x, max_y],
        set: alone,
        layers,
        offset,
        limit,
        ..
    } = planned.resolved();
    let sets = &planned.query.sets;
    let echoes = alone.into_iter().chain(layers).zip(sets.iter());
    let echoes = echoes.zip(&planned.sets).enumerate();
    ResolvedQuery {
        bbox: Some(BoundingBox {
            min_x,
            min_y,
            max_x,
            max_y,
        }),
        region: request.region.clone(),
        sets: echoes
            .map(|(i, ((echo, asked), planned))| {
                let layer = request.layers.get(i);
                let region = layer.and_then(|layer| layer.region.clone());
                set(echo, asked, &planned.entry, region, sets)
            })
            .collect(),
        encoding: encoding.into(),
        offset: u64::try_from(offset).unwrap_or(u64::MAX),
        limit,
    }
}

/// The set that single points are of.
pub(super) fn placed(placed: &Placed) -> proto::ResolvedSet {
    let entry = &placed.set.entry;
    set(placed.resolved.clone(), &placed.set, entry, None, &[])
}

fn set(
    echo: ResolvedSet,
    asked: &Set,
    entry: &Entry,
    region: Option<Region>,
    all: &[Set],
) -> proto::ResolvedSet {
    let clear_of = asked.clear_of.iter().filter_map(|&(place, distance)| {
        let layer = all.get(place)?;
        Some((layer.name.clone(), distance))
    });
    proto::ResolvedSet {
        name: echo.name,
        region,
        density: echo.density,
        spacing: echo.spacing,
        least_distance: echo.least_distance,
        profile: echo.profile,
        alpha: echo.alpha,
        map: echo.map,
        table: entry.digest.clone(),
        seed: echo.seed,
        warp: echo.warp,
        keep: echo.keep,
        attributes: asked.attributes.as_slice().iter().map(attribute).collect(),
        clear_of: clear_of.collect(),
        delta_min: entry.measured("delta_min"),
        delta_avg: entry.measured("delta_avg"),
    }
}

fn attribute(attribute: &Attribute) -> proto::Attribute {
    let (mut range, mut variants) = (None, vec![]);
    match attribute {
        Attribute::Scale(scale) => {
            let (min, max) = (scale.min(), scale.max());
            range = Some(ScaleRange { min, max });
        }
        Attribute::Variant(list) => {
            let weights = list.weights().map(|(name, weight)| Variant {
                name: name.into(),
                weight: Some(weight),
            });
            variants.extend(weights);
        }
        _ => {}
    }
    proto::Attribute {
        name: attribute.name().to_string(),
        range,
        variants,
    }
}
