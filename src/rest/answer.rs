//! Answers with points on every path: checked, planned, streamed.

use std::{cell::RefCell, collections::BTreeMap, convert::Infallible, pin::pin, sync::LazyLock};

use bytes::Bytes;
use futures_util::{StreamExt as _, stream};
use http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use schemars::JsonSchema;
use strew_core::ALGORITHM_VERSION;
use strew_encode::{Answer, Encoding, Output, legend, write_number};
use strew_error::{Error, Kind, integer::Long};
use strew_plan::{Planned, QueryEcho, TableEcho};
use strew_query::{Options, Query};
use strew_service::{Record, Service};

use super::{
    api::{self, schemas},
    coding,
    context::Context,
    freshness::{self, Freshness, Verdict, Wanted},
    negotiate::{self, Chosen},
};
use crate::body::{Body, Response};

pub(super) const COUNT: HeaderName = HeaderName::from_static("strew-count");
const TABLE: HeaderName = HeaderName::from_static("strew-table");
const WORLD: HeaderName = HeaderName::from_static("strew-world");
const ALGORITHM: HeaderName = HeaderName::from_static("strew-algorithm");
const ORIGIN: HeaderName = HeaderName::from_static("strew-origin");

const COLUMNS: HeaderName = HeaderName::from_static("strew-columns");
static VERSION: LazyLock<HeaderValue> = LazyLock::new(|| ALGORITHM_VERSION.into());
/// The columns of what most requests ask for.
const PLAIN_F32: HeaderValue = HeaderValue::from_static(legend::F32);
const KINDS: HeaderName = HeaderName::from_static("strew-kinds");
/// Proxies hold the head of an answer in 4 kB, and the other headers take up to 3.6.
const LONGEST_KINDS: usize = 400;
const WARNING: HeaderName = HeaderName::from_static("strew-warning");
pub(super) const NEXT: HeaderName = HeaderName::from_static("strew-next");
const CURSOR: HeaderName = HeaderName::from_static("strew-cursor");

const HEADERS: [(&str, &str); 12] = [
    ("strew-count", "The exact number of points that follow."),
    (
        "strew-table",
        "The digest of the table that answers; with layers each digest once, in the order of the layers, joined by \
         commas.",
    ),
    (
        "strew-world",
        "The digest of the world, if the query names one: of its document, tables, fields and lists.",
    ),
    (
        "strew-algorithm",
        "The version of the algorithm that answers.",
    ),
    (
        "strew-origin",
        "The origin of the coordinates: with f32 the lower corner of a box around the region, \
         with a chunk its corner.",
    ),
    (
        "strew-next",
        "With a limit: the cursor of the points after these, if there are any.",
    ),
    (
        "strew-cursor",
        "The cursor of the first of these points, for answers that are streamed. One that breaks off continues with \
         this cursor and the number of points that came as `offset`.",
    ),
    (
        "strew-columns",
        "With npy, f32, f64 and ply: the columns in their order, as a JSON list of objects with name, \
         type and, where values are indices, the names that they stand for; their number, names_left_out, where they \
         would make it longer than 1,000 bytes: formats with names in them have them, and the query of /v1/count.",
    ),
    (
        "strew-kinds",
        "The number of points of the region that each variant has, if they are evenly spread: a JSON object by name; \
         with layers, one for each layer that has such variants. One of more than 400 bytes is left out: the answer of \
         /v1/count has the same numbers.",
    ),
    (
        "accept-ranges",
        "`bytes` with npy, f32, f64, ply, multimesh and instances: GET with `Range: bytes=first-last` is answered \
         206 with these bytes of the whole, and only their points are made; all other headers are those of the whole.",
    ),
    (
        "strew-warning",
        "A caution about values that readers of the format may misinterpret.",
    ),
    (
        "content-disposition",
        "The name under which browsers save the answer, and whether they show it.",
    ),
];

/// The points of a query as one JSON document.
#[derive(JsonSchema)]
#[schemars(rename = "Points")]
#[allow(dead_code, reason = "only described; the encoder writes it")]
struct PointsDocument {
    /// The query with everything filled in.
    query: QueryEcho,
    /// The table that answers, if there are no layers.
    #[schemars(default)]
    table: Option<TableEcho>,
    /// The tables of the layers.
    #[schemars(default)]
    tables: Option<Vec<TableEcho>>,
    /// The number of points.
    count: Long<u128>,
    /// The cursor of the points after these, if there are any.
    #[schemars(default)]
    next: Option<String>,
    /// The points.
    points: Vec<Point>,
}

/// A point, with a member for each attribute.
#[derive(JsonSchema)]
#[allow(dead_code, reason = "only described; the encoder writes it")]
struct Point {
    /// The stable id: the lattice address.
    #[schemars(regex(pattern = "^-?[0-9]+:-?[0-9]+(:-?[0-9]+)?$"))]
    id: String,
    /// The x coordinate.
    x: f64,
    /// The y coordinate.
    y: f64,
    /// The z coordinate of a point in space, or the height on a terrain.
    #[schemars(default)]
    z: Option<f64>,
    /// The name of its layer, if there are layers.
    #[schemars(default)]
    layer: Option<String>,
    /// Its attributes by name.
    #[serde(flatten)]
    attributes: BTreeMap<String, serde_json::Value>,
}

fn contents() -> Vec<(&'static str, schemas::Content)> {
    let schema = |content_type| match content_type {
        "application/json" => schemas::of::<PointsDocument>,
        _ => schemas::any,
    };
    let all = negotiate::content_types().into_iter();
    all.map(|content_type| (content_type, schema(content_type) as schemas::Content))
        .collect()
}

pub(super) fn problems() -> Vec<Kind> {
    vec![
        Kind::Invalid,
        Kind::NotAcceptable,
        Kind::OtherTable,
        Kind::OtherWorld,
        Kind::TooManyPoints,
        Kind::TooManyRows,
        Kind::TooManyStreams,
        Kind::ShuttingDown,
    ]
}

pub(super) fn described() -> api::Answer {
    api::Answer {
        status: 200,
        about: "The points.",
        headers: HEADERS.into(),
        contents: contents(),
    }
}

pub(super) async fn stream(
    service: &Service,
    context: &Context,
    query: Box<Query>,
    options: Options,
) -> Result<Response, Error> {
    let Context {
        method, headers, ..
    } = context;
    let chosen = match options.encoding {
        Some(encoding) => Chosen::named(encoding),
        None => negotiate::accepted(headers)?,
    };
    Record::in_format(chosen.encoding.name());
    let mut output = options.output(chosen.encoding)?;
    output.relative_to = query.region.corner;
    if *method == Method::POST {
        // A body is not part of the address, so caches do not keep its answer.
        return points(service, context, query, (chosen, output), true).await;
    }
    let mut freshness = freshness(service, context, &query, chosen.content_type);
    freshness.negotiated = true;
    let is_wanted = freshness.verdict(headers) == Verdict::Wanted;
    if is_wanted && let Some(wanted) = Wanted::of(method, headers, &freshness) {
        // On the heap, lest all answers have room for it.
        let mut make = Box::pin(part(service, context, query, chosen, output, wanted));
        return freshness.answer(headers, make.as_mut()).await;
    }
    let is_wanted = is_wanted && *method != Method::HEAD;
    let make = points(service, context, query, (chosen, output), is_wanted);
    freshness.answer(headers, pin!(make)).await
}

/// The response with the points, or without a body if they are not wanted.
async fn points(
    service: &Service,
    context: &Context,
    query: Box<Query>,
    (chosen, output): (Chosen, Output),
    is_wanted: bool,
) -> Result<Response, Error> {
    let caller = &context.caller;
    // An svg is made row by row.
    let picture = (chosen.encoding == Encoding::Png).then_some(output.size);
    let (permit, planned) = if is_wanted {
        let (permit, planned) = service.open(caller, query, picture).await?;
        (Some(permit), planned)
    } else {
        (None, service.plan(caller, query).await?)
    };
    let answer = planned.answer(&output, service.limits().block_bytes)?;
    let mut response_headers = describe(&planned, &answer, chosen)?;
    let size = answer.size();
    let body = match permit {
        // Without a body there is nothing to stream, and HTTP wants to hear so at once.
        _ if size == Some(0) => Body::empty(),
        None => coding::unknown_length(),
        Some(permit) if planned.query.is_small() && !chosen.encoding.is_picture() => {
            let whole = service.at_once(permit, answer)?;
            if size.is_some() {
                Body::from(whole)
            } else {
                // As the answer to HEAD says: the size is not known before.
                Body::from_stream(stream::iter([Ok::<_, Infallible>(whole)]))
            }
        }
        Some(permit) => Body::from_stream(service.blocks(permit, answer)),
    };
    let is_told = http_body::Body::size_hint(&body).exact().is_some();
    if let Some(size) = size.filter(|_| !is_told) {
        response_headers.insert(header::CONTENT_LENGTH, size.into());
    }
    let mut response = Response::new(body);
    *response.headers_mut() = response_headers;
    Ok(response)
}

/// Answers with a part, or with the whole if the format has no parts.
async fn part(
    service: &Service,
    context: &Context,
    query: Box<Query>,
    chosen: Chosen,
    output: Output,
    wanted: Wanted,
) -> Result<Response, Error> {
    let block_bytes = service.limits().block_bytes;
    let planned = service.plan(&context.caller, query.clone()).await?;
    let whole = planned.answer(&output, block_bytes)?;
    let (Some(size), Some(record)) = (whole.size(), whole.record_bytes()) else {
        return points(service, context, query, (chosen, output), true).await;
    };
    let Some(part) = wanted.within(size) else {
        return Ok(freshness::unsatisfiable(size));
    };
    let before = whole.head().cloned().unwrap_or_default();
    let length = before.len() as u64;
    let in_head = |place: u64| usize::try_from(place.min(length)).unwrap_or(before.len());
    let front = before.slice(in_head(part.start)..in_head(part.end));
    // The bytes among the records, and the records that have them.
    let bytes = part.start.max(length) - length..part.end.max(length) - length;
    let records = bytes.start / record..bytes.end.div_ceil(record);
    let body = if bytes.is_empty() {
        Body::from(front)
    } else {
        let mut some = query.clone();
        some.window.offset = some.window.offset.saturating_add(records.start);
        some.window.limit = Some(records.end - records.start);
        let (permit, planned) = service.open(&context.caller, some, None).await?;
        let rows = planned.answer(&output, block_bytes)?;
        if rows.legend() != whole.legend() || rows.origin() != whole.origin() {
            drop(permit);
            return points(service, context, query, (chosen, output), true).await;
        }
        let head = rows.head().map_or(0, |head| head.len() as u64);
        let start = head + bytes.start - records.start * record;
        let blocks = service.blocks(permit, rows);
        let wanted = freshness::cut(blocks, start..start + (bytes.end - bytes.start));
        Body::from_stream(stream::iter([Ok(front)]).chain(wanted))
    };
    let mut response = Response::new(body);
    *response.status_mut() = StatusCode::PARTIAL_CONTENT;
    *response.headers_mut() = describe(&planned, &whole, chosen)?;
    let place = format!("bytes {}-{}/{size}", part.start, part.end - 1);
    let place = HeaderValue::from_str(&place).map_err(|_| Error::Internal("a range is no text"))?;
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_RANGE, place);
    headers.insert(header::CONTENT_LENGTH, (part.end - part.start).into());
    Ok(response)
}

/// The freshness of the answer to the query of an address. Besides the address, which has all of the query, the answer
/// depends on the tables and on a limit.
pub(super) fn freshness(
    service: &Service,
    context: &Context,
    query: &Query,
    content_type: &'static str,
) -> Freshness {
    let (limit, world) = (service.limits().max_points, query.world.as_ref());
    let write = |written: &mut Vec<u8>| {
        written.extend_from_slice(&limit.to_le_bytes());
        let worlds = world.map(|world| world.digest.as_str());
        for digest in worlds.into_iter().chain([""]).chain(query.digests()) {
            // As much of it as the tag has of its own.
            written.extend_from_slice(&digest.as_bytes()[..digest.len().min(32)]);
            written.push(b'\n');
        }
    };
    let Context { uri, headers, .. } = context;
    Freshness::made(uri, headers, content_type, write).pinned(query.is_pinned())
}

fn disposition(encoding: Encoding) -> HeaderValue {
    static KNOWN: LazyLock<Vec<(Encoding, HeaderValue)>> = LazyLock::new(|| {
        let made = |encoding: Encoding| {
            let way = if encoding.is_shown() {
                "inline"
            } else {
                "attachment"
            };
            let text = format!("{way}; filename=\"{}\"", encoding.file_name());
            (encoding, HeaderValue::from_str(&text).expect("plain names"))
        };
        Encoding::ALL.iter().copied().map(made).collect()
    });
    let found = KNOWN.iter().find(|(known, _)| *known == encoding);
    found.map_or(HeaderValue::from_static("attachment"), |(_, value)| {
        value.clone()
    })
}

/// The header of a table. Most answers of a thread are of one.
fn table(digest: &str) -> Result<HeaderValue, Error> {
    thread_local! {
        static LAST: RefCell<HeaderValue> = const { RefCell::new(HeaderValue::from_static("")) };
    }
    LAST.with_borrow_mut(|last| {
        if last.as_bytes() != digest.as_bytes() {
            *last = HeaderValue::from_str(digest)
                .map_err(|_| Error::Internal("a digest is no text"))?;
        }
        Ok(last.clone())
    })
}

fn describe(planned: &Planned, answer: &Answer, chosen: Chosen) -> Result<HeaderMap, Error> {
    let text = |text: &str| {
        HeaderValue::from_str(text).map_err(|_| Error::Internal("a header is not text"))
    };
    // Answers of more points than the limit, which has 64 bits, are refused.
    let count = u64::try_from(planned.count()).unwrap_or(u64::MAX);
    // With what is put onto it later there are a dozen: a map that grows is filled anew.
    let mut headers = HeaderMap::with_capacity(16);
    headers.insert(
        header::CONTENT_TYPE,
        HeaderValue::from_static(chosen.content_type),
    );
    headers.insert(COUNT, text(itoa::Buffer::new().format(count))?);
    let tables = match planned.query.tables().as_slice() {
        [only] => table(only)?,
        all => text(&all.join(", "))?,
    };
    headers.insert(TABLE, tables);
    if let Some(token) = planned.next() {
        headers.insert(NEXT, text(&token.to_string())?);
    }
    if !planned.query.is_small()
        && !chosen.encoding.is_picture()
        && let Some(token) = planned.beginning()
    {
        headers.insert(CURSOR, text(&token.to_string())?);
    }
    headers.insert(ALGORITHM, VERSION.clone());
    if let Some(world) = &planned.query.world {
        headers.insert(WORLD, text(&world.digest)?);
    }
    if let Some(place) = answer.origin() {
        let mut origin = Vec::with_capacity(64);
        for (i, &v) in place.as_slice().iter().enumerate() {
            if i > 0 {
                origin.push(b',');
            }
            write_number(v, &mut origin);
        }
        let origin = HeaderValue::from_maybe_shared(Bytes::from(origin));
        let no_text = |_| Error::Internal("an origin is no text");
        headers.insert(ORIGIN, origin.map_err(no_text)?);
    }
    if planned.sets.iter().any(|set| !set.kinds.is_empty())
        && let Some(kinds) = planned.resolved().kinds()
        && let kinds = kinds.to_string()
        && kinds.len() <= LONGEST_KINDS
    {
        headers.insert(KINDS, text(&kinds)?);
    }
    if let Some(columns) = answer.legend() {
        headers.insert(
            COLUMNS,
            match columns {
                legend::F32 => PLAIN_F32,
                columns => text(columns)?,
            },
        );
    }
    if let Some(warning) = answer.warning() {
        headers.insert(WARNING, HeaderValue::from_static(warning));
    }
    headers.insert(header::CONTENT_DISPOSITION, disposition(chosen.encoding));
    if answer.record_bytes().is_some() {
        headers.insert(header::ACCEPT_RANGES, freshness::BYTES);
    }
    Ok(headers)
}
