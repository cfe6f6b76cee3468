//! The least a client can do over gRPC: call, read frames, release their window, throw away.

use std::net::SocketAddr;

use bytes::Bytes;
use http::{Request, header};
use prost::Message as _;
use strew::grpc::proto::{
    BoundingBox, Encoding, PointSet, Region, StreamPointsRequest, point_set::Amount, region::Shape,
};

/// How much a client lets the server send, in bytes.
#[derive(Clone, Copy, Debug)]
pub struct Windows {
    frame: u32,
    stream: u32,
    connection: u32,
}

impl Windows {
    /// The defaults of hyper's and tonic's clients.
    pub const DEFAULT: Self = Self {
        frame: 16 << 10,
        stream: 2 << 20,
        connection: 5 << 20,
    };
    /// What clients set that want to be fast.
    pub const WIDE: Self = Self {
        frame: 256 << 10,
        stream: 8 << 20,
        connection: 16 << 20,
    };
}

/// A framed request for a square with about `points` points as packed `f32`.
pub fn request(points: u64) -> Bytes {
    let side = (points as f64).sqrt();
    let request = StreamPointsRequest {
        region: Some(Region {
            shape: Some(Shape::Bbox(BoundingBox {
                max_x: side,
                max_y: side,
                ..BoundingBox::default()
            })),
        }),
        set: Some(PointSet {
            amount: Some(Amount::Spacing(1.0)),
            ..PointSet::default()
        }),
        encoding: Encoding::F32Le.into(),
        ..StreamPointsRequest::default()
    };
    let message = request.encode_to_vec();
    let length = u32::try_from(message.len()).expect("small");
    [&[0], &length.to_be_bytes()[..], &message].concat().into()
}

/// Calls a method. Returns the number of bytes received.
pub fn call(address: SocketAddr, path: &str, request: Bytes, windows: Windows) -> f64 {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .expect("a runtime");
    runtime.block_on(async {
        let socket = tokio::net::TcpStream::connect(address).await;
        let (client, connection) = h2::client::Builder::new()
            .initial_window_size(windows.stream)
            .initial_connection_window_size(windows.connection)
            .max_frame_size(windows.frame)
            .handshake::<_, Bytes>(socket.expect("a listener"))
            .await
            .expect("HTTP/2");
        tokio::spawn(connection);
        let mut client = client.ready().await.expect("open");
        let head = Request::post(format!("http://{address}{path}"))
            .header(header::CONTENT_TYPE, "application/grpc")
            .header(header::TE, "trailers")
            .body(())
            .expect("a request");
        let (answer, mut body) = client.send_request(head, false).expect("sent");
        body.send_data(request, true).expect("sent");
        let mut answer = answer.await.expect("an answer").into_body();
        let mut total = 0;
        while let Some(data) = answer.data().await {
            let read = data.expect("whole").len();
            total += read;
            let flow = answer.flow_control();
            flow.release_capacity(read).expect("received");
        }
        total as f64
    })
}
