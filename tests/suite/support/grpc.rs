//! Messages for gRPC requests, and streams collected.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use strew::grpc::proto::{
    BoundingBox, ColumnHead, PointBlock, PointSet, Region, StreamHeader, StreamPointsRequest,
    StreamSummary, point_service_client::PointServiceClient, point_set::Amount, region::Shape,
    stream_points_response::Message,
};
use tonic::{Code, Status, Streaming, transport::Channel};
use tonic_types::StatusExt as _;

use super::daemon::PROFILE;

/// The status that breaks off a stream.
pub async fn broken_off<T>(stream: &mut Streaming<T>) -> Status {
    loop {
        match stream.message().await {
            Ok(Some(_)) => {}
            Ok(None) => panic!("the stream looks complete"),
            Err(status) => return status,
        }
    }
}

/// A box as a region.
pub fn boxed([min_x, min_y, max_x, max_y]: [f64; 4]) -> Option<Region> {
    shaped(Shape::Bbox(BoundingBox {
        min_x,
        min_y,
        max_x,
        max_y,
    }))
}

/// A region of a shape.
pub fn shaped(shape: Shape) -> Option<Region> {
    Some(Region { shape: Some(shape) })
}

/// A set of points of the test profile.
pub fn set(amount: Amount) -> Option<PointSet> {
    Some(PointSet {
        amount: Some(amount),
        profile: Some(PROFILE.into()),
        ..PointSet::default()
    })
}

/// The side of a square that holds a little over a billion points at density 1.
pub const LONG: f64 = 31_700.0;

/// A square with a corner at the origin, at density 1.
pub fn square(side: f64) -> StreamPointsRequest {
    StreamPointsRequest {
        region: boxed([0.0, 0.0, side, side]),
        set: set(Amount::Density(1.0)),
        ..StreamPointsRequest::default()
    }
}

/// A whole stream.
pub struct Whole {
    pub header: StreamHeader,
    pub blocks: Vec<PointBlock>,
    pub summary: StreamSummary,
}

/// Reads a stream to its end.
pub async fn collect(
    client: &mut PointServiceClient<Channel>,
    request: StreamPointsRequest,
) -> Whole {
    let answer = client.stream_points(request).await.expect("an answer");
    let mut stream = answer.into_inner();
    let (mut header, mut blocks, mut summary) = (None, vec![], None);
    while let Some(response) = stream.message().await.expect("a message") {
        assert!(summary.is_none(), "nothing follows the summary");
        match response.message.expect("one of the three") {
            Message::Header(message) => assert!(header.replace(message).is_none()),
            Message::Block(block) => {
                assert!(header.is_some(), "the header is first");
                blocks.push(block);
            }
            Message::Summary(message) => summary = Some(message),
        }
    }
    Whole {
        header: header.expect("first"),
        blocks,
        summary: summary.expect("last"),
    }
}

impl Whole {
    /// The points as in the JSON format: id, x, y, layer and attributes.
    pub fn points(&self) -> Vec<Value> {
        let sets = &self.header.query.as_ref().expect("set").sets;
        let mut points = vec![];
        for block in &self.blocks {
            let layer = &sets[block.layer as usize].name;
            assert_eq!(
                (block.x.len(), block.y.len()),
                (block.id.len(), block.id.len())
            );
            let columns = self.columns(block);
            for (i, id) in block.id.iter().enumerate() {
                let mut point = json!({ "id": id, "x": block.x[i], "y": block.y[i] });
                if let Some(z) = block.z.get(i) {
                    point["z"] = json!(z);
                }
                if !layer.is_empty() {
                    point["layer"] = layer.clone().into();
                }
                for (name, values) in &columns {
                    point[name] = values[i].clone();
                }
                points.push(point);
            }
        }
        assert_eq!(points.len() as u64, self.header.count);
        assert_eq!(points.len() as u64, self.summary.count);
        points
    }

    /// The values of each attribute column of a block; variants as names.
    pub fn columns(&self, block: &PointBlock) -> BTreeMap<String, Vec<Value>> {
        let columns = block.columns.iter().map(|column| {
            let is_head = |head: &&ColumnHead| head.name == column.name;
            let head = self.header.columns.iter().find(is_head).expect("a head");
            let name = |&i: &u32| head.names[i as usize].clone().into();
            let numbers = column.numbers.iter().map(|&v| Value::from(v));
            let values: Vec<Value> = numbers.chain(column.indices.iter().map(name)).collect();
            (column.name.clone(), values)
        });
        columns.collect()
    }

    /// The packed coordinates of all blocks.
    pub fn bytes(&self) -> Vec<u8> {
        self.blocks.iter().flat_map(|b| b.data.to_vec()).collect()
    }
}

/// JSON with all numbers as floating-point ones and without members that are null, for comparisons
/// between REST and gRPC.
pub fn normal(value: &Value) -> Value {
    match value {
        Value::Number(number) => number.as_f64().into(),
        Value::Array(items) => items.iter().map(normal).collect(),
        Value::Object(members) => {
            let members = members.iter().filter(|(_, value)| !value.is_null());
            let members = members.map(|(name, value)| (name.clone(), normal(value)));
            Value::Object(members.collect())
        }
        other => other.clone(),
    }
}

/// Fails unless a status names exactly these fields, and its message contains these texts.
pub fn assert_faults(status: &Status, fields: &[&str], texts: &[&str]) {
    assert_eq!(status.code(), Code::InvalidArgument, "{status:?}");
    let details = status.get_error_details();
    let info = details.error_info().expect("details");
    assert_eq!(
        (info.reason.as_str(), info.domain.as_str()),
        ("INVALID_QUERY", "strew")
    );
    let violations = &details.bad_request().expect("details").field_violations;
    let named: Vec<&str> = violations.iter().map(|v| v.field.as_str()).collect();
    assert_eq!(named, fields, "{status:?}");
    for text in texts.iter().chain(fields) {
        let message = status.message();
        assert!(message.contains(text), "no `{text}`: {message}");
    }
}
