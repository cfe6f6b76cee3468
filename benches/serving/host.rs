//! The daemon inside this process, with further routes whose answers cost nothing to make: a
//! prepared block sent again and again, or copied first. Beside it, the HTTP library alone.

use std::{
    convert::Infallible,
    future::ready,
    net::{SocketAddr, TcpListener},
    sync::Arc,
};

use bytes::Bytes;
use futures_util::stream;
use http::{Method, header};
use hyper::{server::conn::http1, service::service_fn};
use hyper_util::rt::TokioIo;
use prost::Message as _;
use strew::{
    body::{Body, BoxError, Response},
    grpc::proto::{PointBlock, StreamPointsResponse, stream_points_response::Message},
    ops::App,
    rest::{
        Context, Refused,
        api::{Endpoint, Operation, Tag},
    },
};
use strew_config::Layers;
use strew_encode::Pool;
use strew_service::Service;
use strew_testkit::random::SplitMix;

/// A daemon that serves until it is dropped.
pub struct Host {
    pub address: SocketAddr,
    /// Where the HTTP library alone answers every request with `SMALL` bytes.
    pub alone: SocketAddr,
    _runtime: tokio::runtime::Runtime,
}

impl Host {
    pub fn start() -> Self {
        let layers = Layers::new().expect("the defaults");
        let config = layers.finish().expect("valid");
        let block_bytes = config.limits.block_bytes;
        let mut app = App::new(config).expect("tables and threads");
        app.more = endpoints(app.service(), block_bytes);
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = listener.local_addr().expect("bound");
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .enable_all()
            .build()
            .expect("a runtime");
        runtime.spawn(app.run(listener, std::future::pending()));
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let alone = listener.local_addr().expect("bound");
        runtime.spawn(answer_alone(listener, noise(SMALL).into()));
        Self {
            address,
            alone,
            _runtime: runtime,
        }
    }
}

/// The bytes of a small answer: those of 1,000 points as f32.
pub const SMALL: usize = 8000;

/// Answers every request with the same bytes, by nothing but the HTTP library: the floor of any answer.
async fn answer_alone(listener: TcpListener, body: Bytes) {
    listener.set_nonblocking(true).expect("a socket");
    let listener = tokio::net::TcpListener::from_std(listener).expect("a listener");
    loop {
        let (socket, _) = listener.accept().await.expect("a client");
        socket.set_nodelay(true).expect("a socket");
        let body = body.clone();
        let answer = service_fn(move |_| ready(Ok::<_, Infallible>(octets(body.clone().into()))));
        let connection = http1::Builder::new().serve_connection(TokioIo::new(socket), answer);
        tokio::spawn(async move {
            // Clients hang up in the end.
            let _ = connection.await;
        });
    }
}

/// `/bench/constant/{bytes}`, `/bench/copied/{bytes}`, `/bench/small/{bytes}` and the gRPC method
/// `/bench.Constant/{bytes}`.
fn endpoints(service: &Arc<Service>, block_bytes: usize) -> Vec<Endpoint> {
    let block = Bytes::from(noise(block_bytes));
    let framed = framed(&block);
    let (constant, small) = (block.clone(), block.clone());
    let service = service.clone();
    vec![
        endpoint("/bench/constant/{bytes}", Method::GET, move |bytes| {
            let block = constant.clone();
            let blocks =
                cut(bytes, block.len()).map(move |n| Ok::<_, Infallible>(block.slice(..n)));
            answer(bytes, stream::iter(blocks))
        }),
        endpoint("/bench/copied/{bytes}", Method::GET, move |bytes| {
            let block = block.clone();
            let permit = service.streams().admit().expect("a place");
            let pool = Pool::<u64>::new(block.len() / size_of::<u64>());
            let blocks = cut(bytes, block.len()).map(move |n| {
                let mut buffer = pool.take();
                bytemuck::cast_slice_mut(&mut buffer)[..n].copy_from_slice(&block[..n]);
                pool.lend(buffer, n.div_ceil(size_of::<u64>()))
            });
            answer(bytes, service.stream(permit, blocks))
        }),
        endpoint("/bench/small/{bytes}", Method::GET, move |bytes| {
            octets(Body::from(small.slice(..bytes)))
        }),
        endpoint("/bench.Constant/{bytes}", Method::POST, move |bytes| {
            let (framed, frames) = (framed.clone(), cut(bytes, framed.len()));
            let frames = frames.map(move |_| Ok::<_, Infallible>(framed.clone()));
            let mut response = Response::new(Body::from_stream(stream::iter(frames)));
            let kind = header::HeaderValue::from_static("application/grpc");
            response.headers_mut().insert(header::CONTENT_TYPE, kind);
            response
        }),
    ]
}

/// A path whose parameter is a number of bytes, open to all.
fn endpoint(
    path: &'static str,
    method: Method,
    answer: impl Fn(usize) -> Response + Clone + Send + Sync + 'static,
) -> Endpoint {
    let operation = Operation {
        method,
        ..Operation::new(Tag::Operations, vec![])
    };
    let answer = move |(), context: Context| {
        let [bytes] = context.path();
        let response = answer(bytes.parse().expect("a number of bytes"));
        ready(Ok::<_, Refused>(response))
    };
    Endpoint::only(path, (), operation, answer).open()
}

/// The sizes of the blocks that make `bytes` bytes.
fn cut(bytes: usize, block: usize) -> impl Iterator<Item = usize> + Send + Unpin {
    (0..bytes.div_ceil(block)).map(move |i| block.min(bytes - i * block))
}

fn answer<S, E>(bytes: usize, blocks: S) -> Response
where
    S: futures_util::Stream<Item = Result<Bytes, E>> + Send + 'static,
    E: Into<BoxError> + 'static,
{
    let mut response = octets(Body::from_stream(blocks));
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_LENGTH, bytes.into());
    response
}

fn octets(body: Body) -> Response {
    let mut response = Response::new(body);
    let kind = header::HeaderValue::from_static("application/octet-stream");
    response.headers_mut().insert(header::CONTENT_TYPE, kind);
    response
}

/// A block as a gRPC message with its prefix.
fn framed(block: &Bytes) -> Bytes {
    let message = StreamPointsResponse {
        message: Some(Message::Block(PointBlock {
            data: block.clone(),
            ..PointBlock::default()
        })),
    };
    let mut framed = vec![0];
    let length = u32::try_from(message.encoded_len()).expect("a block");
    framed.extend_from_slice(&length.to_be_bytes());
    message.encode(&mut framed).expect("room");
    framed.into()
}

/// Random bytes, which no layer can compress.
fn noise(bytes: usize) -> Vec<u8> {
    let mut random = SplitMix::new(1);
    (0..bytes).map(|_| random.bits() as u8).collect()
}
