//! A client that reads chunks by both protocols at a steady rate, and counts answers that fail or differ.

use std::{
    collections::BTreeMap,
    net::SocketAddr,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use strew::grpc::proto::{
    Chunk, Encoding, PointSet, Region, StreamPointsRequest,
    point_service_client::PointServiceClient, point_set::Amount, region::Shape,
    stream_points_response::Message,
};
use strew_testkit::http1;
use tonic::transport::{Channel, Endpoint};

/// The readers of each protocol, and how many chunks each reads a second: 200 by REST, 50 by gRPC.
const REST: (usize, f64) = (8, 25.0);
const GRPC: (usize, f64) = (4, 12.5);
/// The number of different chunks that are read in turn.
const CHUNKS: u64 = 97;
const SIZE: f64 = 32.0;

/// A client at work.
pub struct Load {
    readers: Vec<JoinHandle<()>>,
    shared: Arc<Shared>,
}

/// Why a chunk did not come.
enum Fault {
    /// There was no answer, or an error.
    Refused(String),
    /// The answer began and broke off.
    Broken(String),
}

#[derive(Default)]
struct Shared {
    is_over: AtomicBool,
    counts: Mutex<Counts>,
}

/// The answers of a client so far.
#[derive(Debug, Default)]
pub struct Counts {
    pub rest: u64,
    pub grpc: u64,
    /// The answers that broke off visibly in the middle, and were requested again.
    pub broken: u64,
    /// The longest time of a request.
    pub longest: Duration,
    /// Failures, each with its time in seconds since the first request.
    pub failed: Vec<(f64, String)>,
    /// The first answer to each chunk, which all others equal.
    known: BTreeMap<u64, Vec<u8>>,
}

impl Load {
    /// Starts reading.
    pub fn start(address: SocketAddr) -> Self {
        let shared = Arc::new(Shared::default());
        let rest = (0..REST.0).map(|i| {
            let shared = shared.clone();
            thread::spawn(move || {
                shared.read(i, REST, |chunk| rest(address, chunk));
            })
        });
        let grpc = (0..GRPC.0).map(|i| {
            let shared = shared.clone();
            thread::spawn(move || {
                let mut runtime = tokio::runtime::Builder::new_current_thread();
                let runtime = runtime.enable_all().build().expect("a runtime");
                let _inside = runtime.enter();
                let endpoint = Endpoint::from_shared(format!("http://{address}"));
                let channel = endpoint.expect("an address").connect_lazy();
                let mut client = PointServiceClient::new(channel);
                shared.read(i, GRPC, |chunk| runtime.block_on(grpc(&mut client, chunk)));
            })
        });
        Self {
            readers: rest.chain(grpc).collect(),
            shared,
        }
    }

    /// Ends reading; every request must have been answered at once, and every chunk by the same points.
    pub fn finish(self, what: &str) {
        assert_eq!(self.finish_after_kills(what), 0, "answers broke off");
    }

    /// Ends reading. A killed replica breaks off the answers that it has begun, which no proxy can repair: clients
    /// request them again. Every other request must have been answered at once, and every chunk by the same points.
    /// Returns the number of answers that broke off.
    pub fn finish_after_kills(self, what: &str) -> u64 {
        self.shared.is_over.store(true, Ordering::Release);
        for reader in self.readers {
            reader.join().expect("no panic");
        }
        let counts = self.shared.counts.lock().expect("no panic");
        let Counts {
            rest,
            grpc,
            failed,
            longest,
            broken,
            ..
        } = &*counts;
        let wrong = failed.len();
        println!(
            "{what}: {wrong} failed of {rest} by REST and {grpc} by gRPC, {broken} broke off and were requested again; \
             the longest took {longest:?}"
        );
        assert_eq!(failed, &[]);
        *broken
    }
}

impl Shared {
    /// Reads chunks at a rate until the end.
    fn read(
        &self,
        reader: usize,
        (readers, rate): (usize, f64),
        mut get: impl FnMut(u64) -> Result<Vec<u8>, Fault>,
    ) {
        let begun = Instant::now();
        let period = Duration::from_secs_f64(1.0 / rate);
        let mut next = begun + period.mul_f64(reader as f64 / readers as f64);
        for chunk in (reader as u64..).step_by(readers) {
            if self.is_over.load(Ordering::Acquire) {
                return;
            }
            let now = Instant::now();
            if let Some(early) = next.checked_duration_since(now) {
                thread::park_timeout(early);
            }
            next += period;
            let start = Instant::now();
            let first = get(chunk % CHUNKS);
            let is_broken = matches!(first, Err(Fault::Broken(_)));
            let answer = if is_broken {
                get(chunk % CHUNKS)
            } else {
                first
            };
            let mut counts = self.counts.lock().expect("no panic");
            counts.broken += u64::from(is_broken);
            counts.longest = counts.longest.max(start.elapsed());
            let count = if rate == REST.1 {
                &mut counts.rest
            } else {
                &mut counts.grpc
            };
            *count += 1;
            let fault = match answer {
                Err(Fault::Refused(fault) | Fault::Broken(fault)) => Some(fault),
                Ok(points) => {
                    let known = counts.known.entry(chunk % CHUNKS);
                    let differs = known.or_insert_with(|| points.clone()) != &points;
                    differs.then(|| format!("chunk {chunk} has other points"))
                }
            };
            counts
                .failed
                .extend(fault.map(|fault| (begun.elapsed().as_secs_f64(), fault)));
        }
    }
}

fn rest(address: SocketAddr, chunk: u64) -> Result<Vec<u8>, Fault> {
    let path = format!("/v1/chunks/{SIZE}/{chunk}/-3?spacing=1&seed=7&format=f32");
    let answer = http1::try_open(address, "GET", &path, &[], None);
    let answer = answer.map_err(|error| Fault::Refused(format!("REST: {error}")))?;
    let status = answer.status;
    let body = answer.body();
    let body = body.map_err(|error| Fault::Broken(format!("REST: {error}")))?;
    if status != 200 {
        let text = String::from_utf8_lossy(&body);
        return Err(Fault::Refused(format!("REST: {status} {text}")));
    }
    Ok(body)
}

async fn grpc(client: &mut PointServiceClient<Channel>, chunk: u64) -> Result<Vec<u8>, Fault> {
    let request = StreamPointsRequest {
        region: Some(Region {
            shape: Some(Shape::Chunk(Chunk {
                size: SIZE,
                x: chunk.cast_signed(),
                y: -3,
            })),
        }),
        set: Some(PointSet {
            amount: Some(Amount::Spacing(1.0)),
            seed: Some(7),
            ..PointSet::default()
        }),
        encoding: Encoding::F32Le.into(),
        ..StreamPointsRequest::default()
    };
    let words = |status: tonic::Status| format!("gRPC: {status}");
    let answer = client.stream_points(request).await;
    let mut stream = answer
        .map_err(|status| Fault::Refused(words(status)))?
        .into_inner();
    let (mut points, mut is_whole) = (vec![], false);
    loop {
        let message = stream.message().await;
        let message = message.map_err(|status| Fault::Broken(words(status)))?;
        let Some(response) = message else {
            break;
        };
        match response.message {
            Some(Message::Block(block)) => points.extend_from_slice(&block.data),
            Some(Message::Summary(_)) => is_whole = true,
            _ => {}
        }
    }
    if is_whole {
        Ok(points)
    } else {
        Err(Fault::Refused("gRPC: no summary".into()))
    }
}
