//! A query in parts, each a request of its own.

use prost::Message as _;
use strew_error::{Error, Fault};
use strew_query as query;
use strew_query::{Token, Value, Values, groups, parameters::PARTS};

use super::proto::{Part, StreamPointsRequest};

/// The most bytes of all requests of an answer: what clients accept in one message by default.
const MAX_BYTES: usize = 4 << 20;

/// The bytes of a part besides the query: a cursor, a limit, a count.
const PART_BYTES: usize = 256;

/// Checks the number of parts, and that all of them fit into an answer.
pub(super) fn check(request: &StreamPointsRequest, parts: u32) -> Result<u32, Error> {
    let mut values = Values::new(groups::SPLIT, "");
    values.add_value(&PARTS, Value::Integer(parts.into()));
    let parts = query::parts(&values)?;
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
