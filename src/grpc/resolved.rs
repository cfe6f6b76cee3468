//! What was found, and queries as answers echo them.

use strew_catalog::Entry;
use strew_plan::{Found, Placed, Planned};
use strew_query::{PeriodEcho, Resolved, ResolvedSet, Value, parameters};

use super::{
    proto::{self, Block, Encoding, Point, Region, ResolvedQuery, StreamPointsRequest},
    region, set,
};

/// The query of a request, planned.
pub(super) fn query(
    request: &StreamPointsRequest,
    planned: &Planned,
    encoding: Encoding,
) -> ResolvedQuery {
    let Resolved {
        bbox,
        set: alone,
        layers,
        offset,
        limit,
        world,
        world_digest,
        ..
    } = planned.resolved();
    let sets = alone
        .into_iter()
        .chain(layers)
        .zip(&planned.sets)
        .enumerate();
    let (flat, cuboid) = region::boxed(&bbox);
    ResolvedQuery {
        bbox: flat,
        cuboid,
        region: request.region.clone(),
        sets: sets
            .map(|(i, (echo, planned))| {
                let layer = request.layers.get(i);
                let own = layer.and_then(|layer| layer.region.clone());
                resolved(echo, &planned.entry, own)
            })
            .collect(),
        encoding: encoding.into(),
        offset: u64::try_from(offset.0).unwrap_or(u64::MAX),
        limit: limit.map(|limit| limit.0),
        world,
        world_digest,
    }
}

/// The set that single points are of.
pub(super) fn placed(placed: &Placed) -> proto::ResolvedSet {
    resolved(placed.resolved.clone(), &placed.set.entry, None)
}

fn resolved(echo: ResolvedSet, entry: &Entry, region: Option<Region>) -> proto::ResolvedSet {
    let spacing = (&parameters::SPACING, Value::Number(echo.spacing));
    let table = (&parameters::TABLE, Value::Text(entry.digest.clone()));
    proto::ResolvedSet {
        name: echo.name,
        region,
        set: Some(set::message(
            [spacing, table].into_iter().chain(echo.values.0),
        )),
        density: echo.density,
        least_distance: echo.least_distance,
        field_digest: echo.field_digest,
        terrain_digest: echo.terrain_digest,
        variant_field_digests: echo.variant_field_digests.into_iter().collect(),
        clear_of: echo.clear_of.into_iter().collect(),
        kind_distances: (echo.kind_distances.into_iter())
            .map(|pair| {
                let [one, other] = pair.kinds;
                proto::KindDistance {
                    one,
                    other,
                    least_distance: pair.least_distance,
                }
            })
            .collect(),
        kinds: (echo.kinds.into_iter())
            .map(|(name, count)| (name, u64::try_from(count.0).unwrap_or(u64::MAX)))
            .collect(),
        period: echo.period.map(period),
        delta_min: entry.measured("delta_min"),
        delta_avg: entry.measured("delta_avg"),
    }
}

pub(super) const fn period(echo: PeriodEcho) -> proto::Period {
    proto::Period {
        p: echo.p,
        q: echo.q,
        points: echo.points,
        side: echo.side,
    }
}

pub(super) fn point(found: Found) -> Point {
    let attribute = |(name, value): (String, serde_json::Value)| proto::Value {
        name,
        value: match value {
            serde_json::Value::String(text) => Some(proto::value::Value::Text(text)),
            number => number.as_f64().map(proto::value::Value::Number),
        },
    };
    Point {
        id: found.id,
        x: found.x,
        y: found.y,
        z: found.z,
        distance: found.distance,
        attributes: found.attributes.into_iter().map(attribute).collect(),
        block: found.block.map(|block| {
            // A map has a few hundred intervals.
            let [column, row] = block.map(|i| u32::try_from(i).unwrap_or(u32::MAX));
            Block { column, row }
        }),
    }
}
