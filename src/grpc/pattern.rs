//! Arrangements, clusters and maps as messages.

use std::sync::Arc;

use bytes::Bytes;
use futures_util::TryStreamExt as _;
use strew_access::Caller;
use strew_core::server::Stop;
use strew_error::{Error, Fault};
use strew_query::{
    Parameter, Value, Values, groups,
    patterns::{
        ALPHA, BLOCK, CURSOR, DISTANCE, GRID, LIMIT, LIST, MOST, OFFSETS, RADIUS, REFINED, UP_TO,
    },
};
use strew_service::{
    Record, Service,
    pattern::{
        self, ArrangementQuery, ClustersDocument, ClustersQuery, Facts, MapDocument, MapQuery,
        Occurrences,
    },
};
use tonic::Status;

use super::{
    frames::{FrameStream, framed},
    message::Received,
    proto::{
        Arrangement, ArrangementRequest, Block, ClusterShape, ClustersRequest, ClustersResponse,
        GridBox, GridOffset, IndexRange, ListOccurrencesResponse, MapRequest, MapResponse,
        Occurrence, OccurrenceBlock, OccurrencesHeader, OccurrencesSummary,
        list_occurrences_response::Message,
    },
    set, status,
};

/// The checked query of a request, with a list or without.
fn query(
    service: &Service,
    request: &ArrangementRequest,
    is_list: bool,
) -> Result<ArrangementQuery, Error> {
    if is_list && request.grid.is_none() {
        return Err(Fault::missing(GRID.name, GRID.allowed()).into());
    }
    let mut values = set::values(request.set.as_ref(), groups::ARRANGEMENT, "");
    let offsets = request.offsets.iter();
    let numbers: Vec<f64> = offsets.flat_map(|o| [o.x as f64, o.y as f64]).collect();
    let corners = |grid: GridBox| [grid.min_x, grid.min_y, grid.max_x, grid.max_y];
    let grid = request.grid.map(|grid| corners(grid).map(|v| v as f64));
    let cursor = (!request.cursor.is_empty()).then(|| Value::Text(request.cursor.clone()));
    let given: [(&'static Parameter, Option<Value>); 5] = [
        (&OFFSETS, Some(Value::Numbers(numbers))),
        (&GRID, grid.map(|grid| Value::Numbers(grid.into()))),
        (&LIST, is_list.then(|| Value::Text("json".into()))),
        (&LIMIT, request.limit.map(Value::Integer)),
        (&CURSOR, cursor),
    ];
    add(&mut values, given);
    ArrangementQuery::check(&values, &service.catalog())
}

fn add<const N: usize>(values: &mut Values, given: [(&'static Parameter, Option<Value>); N]) {
    values.add_values(given);
}

fn named(text: &str) -> Option<Value> {
    (!text.is_empty()).then(|| Value::Text(text.into()))
}

/// The facts about an arrangement.
pub(super) async fn arrangement(
    service: &Arc<Service>,
    Received { message, effort }: Received<ArrangementRequest>,
) -> Result<Arrangement, Error> {
    let facts = move |service: &Service, _: &Stop| -> Result<Facts, Error> {
        Ok(query(service, &message, false)?.facts())
    };
    Ok(described(service.process(effort, facts).await??))
}

fn described(facts: Facts) -> Arrangement {
    let range = |[start, end]: [f64; 2]| Some(IndexRange { start, end });
    let [image_x, image_y] = facts.image.map(range);
    let [margin_x, margin_y] = facts.margin.map_or([None; 2], |margin| margin.map(range));
    Arrangement {
        alpha: facts.alpha,
        exists: facts.exists,
        side: facts.side,
        image_x,
        image_y,
        margin_x,
        margin_y,
        area: facts.area,
        density: facts.density,
        frequency: facts.frequency,
        count: facts
            .count
            .map_or_else(String::new, |count| count.to_string()),
    }
}

/// The occurrences of an arrangement.
pub(super) async fn occurrences(
    service: &Arc<Service>,
    caller: &Caller,
    Received { message, effort }: Received<ArrangementRequest>,
) -> Result<FrameStream, Error> {
    let read = move |service: &Service, _: &Stop| query(service, &message, true);
    let query = service.process(effort, read).await??;
    let (permit, listing) = service.list(caller, &query).await?;
    Record::in_format("points");
    let header = OccurrencesHeader {
        arrangement: Some(described(query.facts())),
        listed: listing.count,
        next_cursor: listing.cursor().unwrap_or_default(),
    };
    let summary = OccurrencesSummary {
        listed: listing.count,
    };
    let messages = ListMessages {
        first: Some(header),
        rest: listing.occurrences(),
        last: Some(summary),
    };
    let stream = service.stream(permit, messages);
    let stream = stream.map_err(status::interrupted);
    Ok(Box::pin(stream.and_then(std::future::ready)))
}

/// A list as framed messages, made when they are taken.
struct ListMessages {
    first: Option<OccurrencesHeader>,
    rest: Occurrences,
    last: Option<OccurrencesSummary>,
}

impl Iterator for ListMessages {
    type Item = Result<Bytes, Status>;

    fn next(&mut self) -> Option<Self::Item> {
        let message = if let Some(header) = self.first.take() {
            Message::Header(header)
        } else {
            match self.rest.next() {
                Some(Ok(batch)) => {
                    let one = |one: pattern::Occurrence| Occurrence {
                        at: Some(place(one.at)),
                        places: one.places.into_flattened(),
                    };
                    Message::Block(OccurrenceBlock {
                        occurrences: batch.into_iter().map(one).collect(),
                    })
                }
                Some(Err(error)) => {
                    self.last = None;
                    return Some(Err(status::status(&error)));
                }
                None => Message::Summary(self.last.take()?),
            }
        };
        Some(Ok(framed(&ListOccurrencesResponse {
            message: Some(message),
        })))
    }
}

const fn place((x, y): (i64, i64)) -> GridOffset {
    GridOffset { x, y }
}

/// A number of things of which there are never billions.
fn small(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// The clusters of a pattern.
pub(super) async fn clusters(
    service: &Service,
    caller: &Caller,
    request: &ClustersRequest,
) -> Result<ClustersResponse, Error> {
    let mut values = Values::new(groups::CLUSTERS, "");
    let up_to = request
        .up_to_symmetry
        .then(|| Value::Text("symmetry".into()));
    let given: [(&'static Parameter, Option<Value>); 4] = [
        (&ALPHA, named(&request.alpha)),
        (&DISTANCE, request.distance.map(Value::Number)),
        (&MOST, request.most.map(Value::Integer)),
        (&UP_TO, up_to),
    ];
    add(&mut values, given);
    let query = ClustersQuery::check(&values)?;
    let answer = move |found: &_| Ok(shapes(query.document(found)));
    service.clusters(caller, query, answer).await
}

fn shapes(document: ClustersDocument) -> ClustersResponse {
    let shapes = document.shapes.into_iter().map(|shape| ClusterShape {
        points: shape.points.into_iter().map(place).collect(),
        class: small(shape.class),
        density: shape.density,
        share_of_points: shape.share_of_points,
        images: shape.images.map(small),
    });
    ClustersResponse {
        radius: document.radius,
        intervals: small(document.intervals),
        classes: small(document.classes),
        shapes: shapes.collect(),
        larger_share: document.larger_share,
    }
}

/// A neighborhood map.
pub(super) async fn map(
    service: &Service,
    caller: &Caller,
    request: &MapRequest,
) -> Result<MapResponse, Error> {
    let mut values = Values::new(groups::MAP, "");
    let block = |block: Block| Value::Numbers(vec![block.column.into(), block.row.into()]);
    let given: [(&'static Parameter, Option<Value>); 4] = [
        (&ALPHA, named(&request.alpha)),
        (&RADIUS, request.radius.map(Value::Integer)),
        (&REFINED, request.refined.map(Value::Integer)),
        (&BLOCK, request.block.map(block)),
    ];
    add(&mut values, given);
    let query = MapQuery::check(&values)?;
    service.map(caller, query, |map| Ok(message(map))).await
}

fn message(map: MapDocument) -> MapResponse {
    let (refined_starts, parents) = map.refined.map_or((vec![], vec![]), |refined| {
        let parents = refined.parents.into_iter().map(small).collect();
        (refined.starts, parents)
    });
    let neighbors = map.neighbors.map_or(vec![], |neighbors| neighbors.offsets);
    MapResponse {
        side: map.side,
        starts: map.starts,
        interval_counts: map.interval_counts.into_iter().map(small).collect(),
        refined_starts,
        parents,
        neighbors: neighbors.into_iter().map(place).collect(),
    }
}
