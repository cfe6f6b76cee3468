//! A request by HTTP/1.1 and its answer.

use std::{convert::Infallible, io, sync::Arc, time::Duration};

use anyhow::anyhow;
use bytes::Bytes;
use futures_util::stream;
use http::{Response, header, request, response};
use http_body::Frame;
use http_body_util::{BodyExt as _, Full, StreamBody, combinators::UnsyncBoxBody};
use hyper::{body::Incoming, client::conn::http1::handshake, ext::on_informational};
use hyper_util::rt::TokioIo;
use rustls::AlertDescription;
use tokio::{
    io::{AsyncRead, AsyncWrite},
    net::TcpStream,
    runtime::{self, Runtime},
    sync::Notify,
    time::timeout,
};
use tokio_rustls::TlsConnector;

use super::{address::Address, trust::Tls};

type Request = http::Request<UnsyncBoxBody<Bytes, Infallible>>;

/// Larger bodies are sent once the daemon wants them. One that is refused before it is read closes the connection,
/// which would break while the body is being written, and the refusal would be lost.
const LARGE: usize = 16 << 10;
/// A body is sent after this time to a proxy that does not answer "100 Continue".
const UNASKED: Duration = Duration::from_secs(1);

/// An answer, whose body is read as it comes. A body that ends early is an error.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) head: response::Parts,
    body: Incoming,
    patience: Duration,
    /// Drives the connection while the body is read.
    runtime: Runtime,
}

/// Sends a request, over TLS if there is `tls`. The answer must begin within `patience`, and may pause as long.
pub(crate) fn send(
    address: &Address,
    tls: Option<Tls>,
    request: request::Builder,
    body: Vec<u8>,
    patience: Duration,
) -> anyhow::Result<Answer> {
    let request = request
        .header(header::HOST, address.authority())
        .header(header::CONNECTION, "close");
    let request = with_body(request, body)?;
    let mut runtime = runtime::Builder::new_current_thread();
    let runtime = runtime.enable_all().build()?;
    match runtime.block_on(within(patience, exchange(address, tls, request))) {
        Ok(response) => {
            let (head, body) = response.into_parts();
            Ok(Answer {
                head,
                body,
                patience,
                runtime,
            })
        }
        Err(error) => {
            // The look-up of a name cannot be stopped: leave it behind.
            runtime.shutdown_background();
            Err(error)
        }
    }
}

/// A request with a body, which waits for "100 Continue" if it is large.
fn with_body(request: request::Builder, body: Vec<u8>) -> http::Result<Request> {
    if body.len() <= LARGE {
        return request.body(Full::from(body).boxed_unsync());
    }
    let request = request
        .header(header::CONTENT_LENGTH, body.len())
        .header(header::EXPECT, "100-continue");
    let wanted = Arc::new(Notify::new());
    let informed = wanted.clone();
    let sent = async move {
        let _ = timeout(UNASKED, wanted.notified()).await;
        Ok(Frame::data(body.into()))
    };
    let mut request = request.body(StreamBody::new(stream::once(sent)).boxed_unsync())?;
    on_informational(&mut request, move |_| informed.notify_one());
    Ok(request)
}

impl Answer {
    /// The next part of the body; none at its end.
    pub(crate) fn next(&mut self) -> anyhow::Result<Option<Bytes>> {
        loop {
            let frame = async { Ok(self.body.frame().await.transpose()?) };
            let Some(frame) = self.runtime.block_on(within(self.patience, frame))? else {
                return Ok(None);
            };
            // Trailers are no part of the body.
            if let Ok(part) = frame.into_data() {
                return Ok(Some(part));
            }
        }
    }

    /// The rest of the body. Stops reading after `most` bytes.
    pub(crate) fn rest(&mut self, most: usize) -> anyhow::Result<Vec<u8>> {
        let mut text = vec![];
        while let Some(part) = self.next()? {
            text.extend_from_slice(&part);
            if text.len() > most {
                break;
            }
        }
        Ok(text)
    }
}

async fn exchange(
    address: &Address,
    tls: Option<Tls>,
    request: Request,
) -> anyhow::Result<Response<Incoming>> {
    let stream = TcpStream::connect((&*address.host, address.port)).await?;
    match tls {
        None => ask(stream, request).await,
        Some(Tls { config, name }) => {
            let stream = TlsConnector::from(config).connect(name, stream).await?;
            ask(stream, request).await
        }
    }
}

async fn ask(
    stream: impl AsyncRead + AsyncWrite + Send + Unpin + 'static,
    request: Request,
) -> anyhow::Result<Response<Incoming>> {
    let (mut sender, connection) = handshake(TokioIo::new(stream)).await?;
    tokio::spawn(connection);
    Ok(sender.send_request(request).await?)
}

/// The result of some work, unless it takes too long.
async fn within<T>(
    patience: Duration,
    work: impl Future<Output = anyhow::Result<T>>,
) -> anyhow::Result<T> {
    match timeout(patience, work).await {
        Ok(done) => done.map_err(explained),
        Err(_) => Err(anyhow!("no answer within {patience:?}")),
    }
}

/// An error of a connection in words that say what to do.
fn explained(error: anyhow::Error) -> anyhow::Error {
    // TLS 1.3 has an alert for a missing certificate, TLS 1.2 has none.
    let is_alert = |error: &io::Error| {
        let cause = error.get_ref().and_then(|cause| cause.downcast_ref());
        let wanted = AlertDescription::CertificateRequired;
        cause == Some(&rustls::Error::AlertReceived(wanted))
    };
    let mut causes = error.chain().filter_map(|cause| cause.downcast_ref());
    if causes.any(is_alert) {
        return error
            .context("the daemon requires a client certificate: use --certificate and --key");
    }
    match error.downcast_ref::<hyper::Error>() {
        Some(error) if error.is_parse() => {
            anyhow!("the answer is not HTTP (a daemon with TLS needs https)")
        }
        Some(error) if error.is_incomplete_message() => {
            anyhow!("the connection ended before the answer was complete")
        }
        _ => error,
    }
}

#[cfg(test)]
mod tests {
    use std::{
        io::{Read as _, Write as _},
        net::TcpListener,
    };

    use super::*;

    /// The body that a server sends, and whether it ends well.
    fn body(answer: String) -> (String, bool) {
        let server = TcpListener::bind("127.0.0.1:0").expect("a port");
        let listen = server.local_addr().expect("bound");
        let served = std::thread::spawn(move || {
            let (mut stream, _) = server.accept().expect("a client");
            let _ = stream.read(&mut [0; 4096]);
            stream.write_all(answer.as_bytes()).expect("writable");
        });
        let address = Address::of_listener(listen, false).expect("a port");
        let patience = Duration::from_secs(20);
        let request = http::Request::get("/");
        let mut answer = send(&address, None, request, vec![], patience).expect("a head");
        served.join().expect("served");
        assert_eq!(answer.head.headers["a"], "b");
        let mut text = String::new();
        loop {
            match answer.next() {
                Ok(Some(part)) => text += &String::from_utf8_lossy(&part),
                end => return (text, end.is_ok()),
            }
        }
    }

    #[test]
    fn a_body_that_is_cut_is_no_whole_one() {
        let length = "HTTP/1.1 200 OK\r\nA: b\r\ncontent-length: 5\r\n\r\n";
        let chunked = "HTTP/1.1 200 OK\r\nA: b\r\nTransfer-Encoding: chunked\r\n\r\n";
        for (head, rest, expected) in [
            (length, "12345", ("12345", true)),
            (length, "1234", ("1234", false)),
            (chunked, "4\r\n1234\r\n1\r\n5\r\n0\r\n\r\n", ("12345", true)),
            (chunked, "4\r\n1234\r\n1\r\n5\r\n", ("12345", false)),
            (chunked, "4\r\n12", ("12", false)),
            (chunked, "x\r\n12", ("", false)),
        ] {
            let (text, is_whole) = body(format!("{head}{rest}"));
            assert_eq!((text.as_str(), is_whole), expected, "{rest:?}");
        }
    }
}
