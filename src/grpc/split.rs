//! A query in parts, each a request of its own.

use prost::Message as _;

use super::proto::{Part, StreamPointsRequest};
use crate::service::{Fault, query::Token};

/// What all requests of an answer may take together: what clients accept in one message by default.
const MAX_BYTES: usize = 4 << 20;

/// What a part takes besides the query: a cursor, a limit, a count.
const PART_BYTES: usize = 256;

/// Checks that so many parts of a request fit into an answer.
pub(super) fn check_size(request: &StreamPointsRequest, parts: u32) -> Result<(), Fault> {
    let one = request.encoded_len() + PART_BYTES;
    let most = MAX_BYTES / one;
    if parts as usize <= most {
        return Ok(());
    }
    let detail =
        format!("each request would take about {one} bytes, all together over {MAX_BYTES}");
    let allowed = format!("1 to {most} for this query");
    Err(Fault::new("parts", parts, detail, allowed))
}

/// The part of a request that begins at a place and has so many points.
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
