//! Requests as drafts of queries. Nothing is checked here but what drafts cannot hold.

use prost::Message as _;
use strew_error::{Checked, Error, Fault};
use strew_query::{
    Draft, LayerDraft, RegionDraft, SPACE_AT, Token, Value, Values, groups,
    parameters::{AT, CURSOR, K, LIMIT, OFFSET, PARTS, RADIUS, WORLD, WORLD_DIGEST},
};

use super::{
    proto::{Encoding, FindNearestRequest, Part, Position, Region, StreamPointsRequest},
    region, set,
};

/// The encoding of a request, with the default filled in.
fn encoding(request: &StreamPointsRequest) -> Result<Encoding, Fault> {
    match Encoding::try_from(request.encoding) {
        Ok(Encoding::Unspecified) => Ok(Encoding::Points),
        Ok(encoding) => Ok(encoding),
        Err(_) => {
            let known = [Encoding::Points, Encoding::F64Le, Encoding::F32Le];
            let allowed = known.map(|encoding| encoding.as_str_name()).join(", ");
            let detail = "unknown encoding";
            Err(Fault::new("encoding", request.encoding, detail, allowed))
        }
    }
}

/// The draft of a request, with its encoding.
pub(super) fn read(request: &StreamPointsRequest) -> (Draft, Result<Encoding, Fault>) {
    let mut draft = draft(request);
    let encoding = encoding(request);
    if let Err(fault) = &encoding {
        draft.values.refuse(fault.clone());
    }
    (draft, encoding)
}

fn draft(request: &StreamPointsRequest) -> Draft {
    let is_in_space = request.region.as_ref().is_some_and(region::is_volume);
    let (whole, of_layer) = match is_in_space {
        true => (groups::SPACE_QUERY, groups::SPACE_SET),
        false => (groups::QUERY, groups::SET),
    };
    let mut values = set::values(request.set.as_ref(), whole, "");
    let cursor = &request.cursor;
    values.add_values([
        (&WORLD, request.world.clone().map(Value::Text)),
        (&WORLD_DIGEST, request.world_digest.clone().map(Value::Text)),
        (&OFFSET, Some(Value::Integer(request.offset))),
        (&LIMIT, request.limit.map(Value::Integer)),
        (
            &CURSOR,
            (!cursor.is_empty()).then(|| Value::Text(cursor.clone())),
        ),
    ]);
    let layers = request.layers.iter().enumerate().map(|(i, layer)| {
        let path = format!("layers[{i}].");
        LayerDraft {
            name: Ok((!layer.name.is_empty()).then(|| layer.name.clone())),
            region: region_of(layer.region.as_ref(), &format!("{path}region")),
            values: set::values(layer.set.as_ref(), of_layer, &path),
            clear_of: Ok(layer.clear_of.clone().into_iter().collect()),
        }
    });
    Draft {
        region: region_of(request.region.as_ref(), "region"),
        values,
        layers: Ok(layers.collect()),
    }
}

fn region_of(region: Option<&Region>, path: &str) -> Checked<Option<RegionDraft>> {
    region
        .map(|region| region::draft(region, path, 0))
        .transpose()
}

/// Names the fields of faults as messages do, whether they show when the query is checked or when it is
/// planned.
pub(super) fn by_field(error: Error) -> Error {
    match error {
        Error::Invalid(faults) => set::in_messages(faults).into(),
        other => other,
    }
}

/// The values of a request.
pub(super) fn nearest(request: &FindNearestRequest) -> Values {
    let (groups, at, place) = match request.at {
        Some(Position { x, y, z: Some(z) }) => {
            (groups::SPACE_NEAREST, &SPACE_AT, Some(vec![x, y, z]))
        }
        Some(Position { x, y, z: None }) => (groups::NEAREST, &AT, Some(vec![x, y])),
        None => (groups::NEAREST, &AT, None),
    };
    let mut values = set::values(request.set.as_ref(), groups, "");
    values.add_values([
        (at, place.map(Value::Numbers)),
        (&K, request.k.map(|k| Value::Integer(k.into()))),
        (&RADIUS, request.radius.map(Value::Number)),
    ]);
    values
}

/// The most bytes of all requests of an answer: what clients accept in one message by default.
const MAX_BYTES: usize = 4 << 20;

/// The bytes of a part besides the query: a cursor, a limit, a count.
const PART_BYTES: usize = 256;

/// Checks the number of parts of a query, and that all of them fit into an answer.
pub(super) fn parts(request: &StreamPointsRequest, parts: u32) -> Result<u32, Error> {
    let mut values = Values::new(groups::SPLIT, "");
    values.add_value(&PARTS, Value::Integer(parts.into()));
    let parts = strew_query::parts(&values)?;
    let one = request.encoded_len() + PART_BYTES;
    let most = MAX_BYTES / one;
    if parts as usize <= most {
        return Ok(parts);
    }
    let detail =
        format!("each request takes about {one} bytes, all together more than {MAX_BYTES}");
    let allowed = format!("1 to {most} for this query");
    Err(Fault::new(PARTS.name, parts, detail, allowed).into())
}

/// The part of a request that begins at a place and has this number of points.
pub(super) fn part(request: &StreamPointsRequest, (token, count): (Token, u64)) -> Part {
    Part {
        count,
        request: Some(StreamPointsRequest {
            offset: 0,
            limit: Some(count),
            cursor: token.to_string(),
            ..request.clone()
        }),
    }
}
