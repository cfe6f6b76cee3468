//! Answers with points on every path: checked, planned, streamed.

use std::{
    cell::RefCell,
    collections::BTreeMap,
    pin::pin,
    sync::{Arc, LazyLock},
};

use bytes::Bytes;
use futures_util::{StreamExt as _, stream};
use http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use schemars::JsonSchema;
use strew_core::ALGORITHM_VERSION;
use strew_encode::{Answer, Encoding, Index, Output, Piece, legend, write_number};
use strew_error::{Error, Kind, integer::Long};
use strew_plan::{Planned, QueryEcho, TableEcho, considered};
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
const PERIOD: HeaderName = HeaderName::from_static("strew-period");
/// Proxies hold the head of an answer in 4 kB, and the other headers take up to 3.6.
const LONGEST_KINDS: usize = 400;
const WARNING: HeaderName = HeaderName::from_static("strew-warning");
pub(super) const NEXT: HeaderName = HeaderName::from_static("strew-next");
const CURSOR: HeaderName = HeaderName::from_static("strew-cursor");

const HEADERS: [(&str, &str); 13] = [
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
        "strew-period",
        "With `periodic`: the period that was chosen, a JSON object with the fraction p/q, the number of points and the \
         side, as in the query of an answer.",
    ),
    (
        "accept-ranges",
        "`bytes` with npy, f32, f64, ply, multimesh, instances, parquet of up to 16,777,216 points, and small answers: \
         GET with `Range: bytes=first-last` is answered 206 with these bytes of the whole, and only their points are \
         made; all other headers are those of the whole.",
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
    let (method, headers) = (&context.method, &context.headers);
    let chosen = match options.encoding {
        Some(encoding) => Chosen::named(encoding),
        None => negotiate::accepted(headers)?,
    };
    Record::in_format(chosen.encoding.name());
    let mut output = options.output(chosen.encoding)?;
    output.relative_to = query.region.corner;
    if *method == Method::POST {
        // A body is not part of the address, so caches do not keep its answer.
        return points(service, context, query, (chosen, output)).await;
    }
    let mut freshness = freshness(service, context, &query, chosen.content_type);
    freshness.negotiated = true;
    let is_wanted = freshness.verdict(headers) == Verdict::Wanted;
    let range = Wanted::of(method, headers, &freshness).filter(|_| is_wanted);
    if !is_wanted || range.is_some() || *method == Method::HEAD {
        let tag = freshness.tag.as_bytes().into();
        // On the heap, lest all answers have room for it.
        let mut make = Box::pin(part(service, context, query, (chosen, output), range, tag));
        return freshness.answer(headers, make.as_mut()).await;
    }
    let make = points(service, context, query, (chosen, output));
    freshness.answer(headers, pin!(make)).await
}

/// The response with all points.
async fn points(
    service: &Service,
    context: &Context,
    query: Box<Query>,
    (chosen, output): (Chosen, Output),
) -> Result<Response, Error> {
    let (permit, planned) = service.open(&context.caller, query, Some(&output)).await?;
    let answer = planned.answer(&output, service.limits().block_bytes)?;
    let mut headers = describe(&planned, &answer, chosen)?;
    if let Some(size) = answer.size() {
        headers.insert(header::CONTENT_LENGTH, size.into());
    }
    // Where there is nothing to stream, HTTP wants to hear so at once.
    let body = match is_whole(&planned, chosen) || answer.size() == Some(0) {
        true => Body::from(service.at_once(answer)?),
        false => Body::from_stream(service.blocks(permit, answer)),
    };
    let mut response = Response::new(body);
    *response.headers_mut() = headers;
    Ok(response)
}

/// Whether an answer is made whole before it is sent.
fn is_whole(planned: &Planned, chosen: Chosen) -> bool {
    planned.query.is_small() && !chosen.encoding.traits().is_picture
}

/// The most points of an answer in blocks whose bytes can be asked for: all are made once to know where they lie.
const MOST_INDEXED: u128 = 1 << 24;

/// Whether any part of an answer can be made alone.
fn is_in_pieces(planned: &Planned, answer: &Answer) -> bool {
    match answer.piece() {
        Some(Piece::Points(_)) => planned.count() <= MOST_INDEXED,
        piece => piece.is_some(),
    }
}

/// The response with a part, with the whole if the answer has no parts, or without a body if no range is wanted.
async fn part(
    service: &Service,
    context: &Context,
    query: Box<Query>,
    (chosen, output): (Chosen, Output),
    range: Option<Wanted>,
    tag: Vec<u8>,
) -> Result<Response, Error> {
    let (caller, block_bytes) = (&context.caller, service.limits().block_bytes);
    let open = async |query: Box<Query>| {
        let (permit, planned) = service.open(caller, query, Some(&output)).await?;
        Ok::<_, Error>((permit, planned.answer(&output, block_bytes)?))
    };
    let planned = service.plan(caller, query.clone()).await?;
    let whole = planned.answer(&output, block_bytes)?;
    let mut headers = describe(&planned, &whole, chosen)?;
    let index = match whole.index() {
        Some(index) => Some(Arc::new(index)),
        None if is_whole(&planned, chosen) => {
            // A head returns no points, and costs none.
            caller.charge(range.as_ref().map_or(0, |_| considered(&planned)))?;
            let answer = planned.answer(&output, block_bytes)?;
            Some(Arc::new(Index::whole(service.at_once(answer)?)))
        }
        None if is_in_pieces(&planned, &whole) => {
            Some(service.index(tag, open(query.clone())).await?)
        }
        None => None,
    };
    let Some(range) = range else {
        if let Some(index) = index {
            headers.insert(header::CONTENT_LENGTH, index.size().into());
        }
        let mut response = Response::new(coding::unknown_length());
        *response.headers_mut() = headers;
        return Ok(response);
    };
    let Some(index) = index else {
        return points(service, context, query, (chosen, output)).await;
    };
    let size = index.size();
    let Some(part) = range.within(size) else {
        return Ok(freshness::unsatisfiable(size));
    };
    let cut = index.cut(part.clone());
    let body = if cut.rows.is_empty() {
        Body::from([cut.front, cut.back].concat())
    } else {
        let mut some = query.clone();
        some.window.offset = some.window.offset.saturating_add(cut.rows.start);
        let count = u64::try_from(planned.count()).unwrap_or(u64::MAX);
        some.window.limit = Some(cut.rows.end.min(count) - cut.rows.start);
        let (permit, made) = open(some).await?;
        if made.legend() != whole.legend() || made.origin() != whole.origin() {
            drop(permit);
            return points(service, context, query, (chosen, output)).await;
        }
        let head = made.head().map_or(0, |head| head.len() as u64);
        let blocks = service.blocks(permit, made);
        let wanted = freshness::cut(blocks, head + cut.bytes.start..head + cut.bytes.end);
        let [front, back] = [cut.front, cut.back].map(|end| stream::iter([Ok(end)]));
        Body::from_stream(front.chain(wanted).chain(back))
    };
    let mut response = Response::new(body);
    *response.status_mut() = StatusCode::PARTIAL_CONTENT;
    let place = format!("bytes {}-{}/{size}", part.start, part.end - 1);
    let place = HeaderValue::from_str(&place).map_err(|_| Error::Internal("a range is no text"))?;
    headers.insert(header::CONTENT_RANGE, place);
    headers.insert(header::CONTENT_LENGTH, (part.end - part.start).into());
    *response.headers_mut() = headers;
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
    /// In the order of [`Encoding`].
    static KNOWN: LazyLock<Vec<HeaderValue>> = LazyLock::new(|| {
        let made = |encoding: &Encoding| {
            let way = match encoding.traits().is_shown {
                true => "inline",
                false => "attachment",
            };
            let text = format!("{way}; filename=\"{}\"", encoding.file_name());
            HeaderValue::from_str(&text).expect("plain names")
        };
        Encoding::ALL.iter().map(made).collect()
    });
    KNOWN[encoding as usize].clone()
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
        && !chosen.encoding.traits().is_picture
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
    if let Some(period) = planned.query.sets[0].period {
        let period = serde_json::to_string(&period.echo());
        let period = period.map_err(|_| Error::Internal("a period is no text"))?;
        headers.insert(PERIOD, text(&period)?);
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
    if is_in_pieces(planned, answer) || is_whole(planned, chosen) {
        headers.insert(header::ACCEPT_RANGES, freshness::BYTES);
    }
    Ok(headers)
}
