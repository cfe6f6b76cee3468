//! Requests over gRPC: the queries as messages, and their points compared with the library's.

use std::{net::SocketAddr, time::Duration};

use serde_json::Value;
use strew::grpc::proto::{
    BoundingBox, Chunk, Circle, Combined, Encoding, Layer, PointSet, Polygon, Polygons, Position,
    Region, Ring, StreamPointsRequest, point_service_client::PointServiceClient, point_set::Amount,
    region::Shape, stream_points_response::Message,
};
use strew_testkit::random::SplitMix;
use tonic::{Code, Status, transport::Endpoint};

use crate::{
    checks,
    library::Library,
    tally::{Done, Trouble},
};

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_default()
}

fn items(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn position(value: &Value) -> Position {
    Position {
        x: number(&value[0]),
        y: number(&value[1]),
        z: None,
    }
}

fn polygon(rings: &Value) -> Polygon {
    let ring = |ring: &Value| Ring {
        positions: items(ring).map(position).collect(),
    };
    Polygon {
        rings: items(rings).map(ring).collect(),
    }
}

fn region(value: &Value) -> Region {
    let shape = if let Some(b) = value.get("bbox") {
        Shape::Bbox(BoundingBox {
            min_x: number(&b[0]),
            min_y: number(&b[1]),
            max_x: number(&b[2]),
            max_y: number(&b[3]),
        })
    } else if let Some(circle) = value.get("circle") {
        Shape::Circle(Circle {
            center: Some(position(&circle["center"])),
            radius: number(&circle["radius"]),
        })
    } else if let Some(geometry) = value.get("polygon") {
        let coordinates = &geometry["coordinates"];
        let polygons = match geometry["type"].as_str() {
            Some("Polygon") => vec![polygon(coordinates)],
            _ => items(coordinates).map(polygon).collect(),
        };
        Shape::Polygons(Polygons { polygons })
    } else if let Some(chunk) = value.get("chunk") {
        Shape::Chunk(Chunk {
            size: number(&chunk["size"]),
            x: chunk["x"].as_i64().unwrap_or_default(),
            y: chunk["y"].as_i64().unwrap_or_default(),
        })
    } else {
        Shape::Combined(Combined {
            include: items(&value["include"]).map(region).collect(),
            exclude: items(&value["exclude"]).map(region).collect(),
        })
    };
    Region { shape: Some(shape) }
}

fn text(value: &Value) -> Option<String> {
    value.as_str().map(Into::into)
}

fn warp(value: &Value) -> Option<f64> {
    match value.as_str() {
        Some("off") => Some(0.0),
        Some("on") => Some(1.0),
        _ => value.as_f64(),
    }
}

fn names(value: &Value) -> Vec<String> {
    items(value).filter_map(text).collect()
}

/// The set of a JSON body, or of one of its layers.
fn set(body: &Value) -> PointSet {
    let of = |name| body.get(name).and_then(Value::as_f64);
    let count = body.get("count").and_then(Value::as_u64);
    let amount = of("density")
        .map(Amount::Density)
        .or_else(|| of("spacing").map(Amount::Spacing))
        .or_else(|| of("min_distance").map(Amount::MinDistance))
        .or_else(|| count.map(Amount::Count));
    PointSet {
        amount,
        profile: text(&body["profile"]),
        alpha: text(&body["alpha"]),
        map: text(&body["map"]),
        seed: body["seed"].as_u64(),
        warp: warp(&body["warp"]),
        keep: body["keep"].as_f64(),
        attributes: names(&body["attributes"]),
        ..PointSet::default()
    }
}

/// A JSON body as a message.
fn message(body: &Value) -> StreamPointsRequest {
    let layer = |body: &Value| {
        let clear_of = body["clear_of"].as_object().into_iter().flatten();
        let clear_of = clear_of.map(|(name, distance)| (name.clone(), number(distance)));
        Layer {
            name: text(&body["name"]).unwrap_or_default(),
            region: body.get("region").map(region),
            clear_of: clear_of.collect(),
            set: Some(set(body)),
        }
    };
    StreamPointsRequest {
        region: Some(region(&body["region"])),
        set: Some(set(body)),
        layers: items(&body["layers"]).map(layer).collect(),
        encoding: Encoding::Points.into(),
        ..StreamPointsRequest::default()
    }
}

async fn client(at: SocketAddr) -> Result<PointServiceClient<tonic::transport::Channel>, Trouble> {
    let endpoint = Endpoint::from_shared(format!("http://{at}")).expect("an address");
    let endpoint = endpoint
        .connect_timeout(Duration::from_secs(5))
        .timeout(Duration::from_secs(60));
    let channel = endpoint.connect().await;
    let channel = channel.map_err(|_| Trouble::Failed("no connection for calls".into()))?;
    Ok(PointServiceClient::new(channel))
}

/// The trouble that a failed call is; `None` if its status is an answer to compare.
fn refused(status: &Status) -> Option<Trouble> {
    match status.code() {
        Code::ResourceExhausted if status.message().contains("being streamed") => {
            Some(Trouble::Busy)
        }
        Code::Unavailable | Code::Unknown | Code::Cancelled | Code::Internal => {
            Some(Trouble::Failed(format!("call: {:?}", status.code())))
        }
        _ => None,
    }
}

/// A stream, compared point by point.
pub async fn stream(library: &Library, at: SocketAddr, body: &Value) -> Done {
    let asked = client(at).await?.stream_points(message(body)).await;
    let planned = library.planned(body);
    let mut stream = match (asked, &planned) {
        (Ok(answer), Ok(_)) => answer.into_inner(),
        (Err(status), planned) => {
            if let Some(trouble) = refused(&status) {
                return Err(trouble);
            }
            return match planned {
                Err(error) if error.kind().wire().code == status.code() as i32 => Ok(0),
                _ => Err(Trouble::Wrong(format!("{status:?}: {body}"))),
            };
        }
        (Ok(_), Err(error)) => {
            return Err(Trouble::Wrong(format!(
                "answered, but the library returns {error}: {body}"
            )));
        }
    };
    let planned = planned.expect("not an error");
    let csv = checks::whole(library, &planned, strew_encode::Encoding::Csv).expect("csv holds all");
    let csv = String::from_utf8(csv).expect("UTF-8");
    let mut lines = csv.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let place = |name| head.iter().position(|own| *own == name).expect("a column");
    let [id, x, y] = ["id", "x", "y"].map(place);
    let mut points = 0;
    let mut is_whole = false;
    loop {
        let message = match stream.message().await {
            Ok(Some(response)) => response.message,
            Ok(None) => break,
            Err(status) => {
                let failed = format!("call broke off: {:?}", status.code());
                return Err(Trouble::Failed(failed));
            }
        };
        match message {
            Some(Message::Block(block)) => {
                for (i, own) in block.id.iter().enumerate() {
                    let fields: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
                    let is = |at: usize, value: f64| {
                        fields.get(at).and_then(|text| text.parse().ok()) == Some(value)
                    };
                    if fields.get(id) != Some(&&**own) || !is(x, block.x[i]) || !is(y, block.y[i]) {
                        let what = format!("call: point {points} is {own}, not {fields:?}: {body}");
                        return Err(Trouble::Wrong(what));
                    }
                    points += 1;
                }
            }
            Some(Message::Summary(summary)) => is_whole = summary.count == points,
            _ => {}
        }
    }
    match is_whole && lines.next().is_none() {
        true => Ok(points),
        false => Err(Trouble::Wrong(format!(
            "call: {points} points are not all: {body}"
        ))),
    }
}

/// Calls for long streams, each reset after at most two messages.
pub async fn resets(at: SocketAddr, random: &mut SplitMix) -> Done {
    let mut client = client(at).await?;
    let body = serde_json::json!({ "region": { "bbox": [0, 0, 20000, 20000] }, "spacing": 1 });
    for _ in 0..20 {
        let answer = match client.stream_points(message(&body)).await {
            Ok(answer) => answer,
            Err(status) => {
                return Err(refused(&status).unwrap_or(Trouble::Failed(status.to_string())));
            }
        };
        let mut stream = answer.into_inner();
        for _ in 0..random.below(3) {
            let _ = stream.message().await;
        }
    }
    Ok(0)
}
