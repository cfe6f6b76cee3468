//! Requests over gRPC: the queries as messages, and their points compared with the library's.

use std::{net::SocketAddr, time::Duration};

use serde_json::Value;
use strew::grpc::proto::{
    Encoding, StreamPointsRequest, point_service_client::PointServiceClient,
    stream_points_response::Message,
};
use strew_testkit::random::SplitMix;
use tonic::{Code, Status, transport::Endpoint};

use crate::{
    checks,
    library::Library,
    messages::query,
    tally::{Done, Trouble},
};

/// A JSON body as a message.
fn message(body: &Value) -> StreamPointsRequest {
    query(body, Encoding::Points.into())
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
