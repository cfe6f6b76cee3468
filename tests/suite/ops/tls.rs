//! TLS and mutual TLS: protocols, certificates of clients, and new certificates without a restart.

use rustls::pki_types::ServerName;
use strew::grpc::proto::{ListProfilesRequest, point_service_client::PointServiceClient};
use strew_testkit::{
    certificates::{Authority, Certificate},
    http1::{self, read_to_close},
    wait::until,
};

use crate::support::{
    daemon::{Daemon, strew, tables},
    tls::{client, connect, get, shown},
};

#[test]
fn http_1_and_2_work_over_tls_and_plain_http_does_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let authority = Authority::new();
    authority.issue_server().write_server(folder.path());
    let daemon = Daemon::with_tls(folder.path(), &[]);
    for protocol in [&b"h2"[..], b"http/1.1"] {
        let config = client(&authority, None, &[protocol]);
        let mut connected = connect(&daemon, &config);
        connected
            .conn
            .complete_io(&mut connected.sock)
            .expect("TLS");
        assert_eq!(connected.conn.alpn_protocol(), Some(protocol));
    }
    let config = client(&authority, None, &[b"http/1.1"]);
    let response = get(&mut connect(&daemon, &config), "/livez").expect("an answer");
    assert!(response.starts_with("HTTP/1.1 200"), "{response}");
    // A client that trusts another authority refuses the certificate.
    let other = client(&Authority::new(), None, &[]);
    get(&mut connect(&daemon, &other), "/livez").expect_err("not trusted");
    // Plain HTTP gets no answer.
    let plain = http1::send(daemon.address(), "GET", "/livez", &[], None).expect("sent");
    let response = read_to_close(plain);
    assert!(!response.starts_with("HTTP"), "{response:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn grpc_works_over_tls() {
    let folder = tempfile::tempdir().expect("a folder");
    let authority = Authority::new();
    authority.issue_server().write_server(folder.path());
    let daemon = Daemon::with_tls(folder.path(), &[]);
    let config = client(&authority, None, &[b"h2"]);
    let address = daemon.address();
    let connector = tokio_rustls::TlsConnector::from(config);
    let connect = tower_connector(move || {
        let connector = connector.clone();
        async move {
            let stream = tokio::net::TcpStream::connect(address).await?;
            let name = ServerName::try_from("localhost").expect("a name");
            connector.connect(name, stream).await
        }
    });
    let channel = tonic::transport::Endpoint::from_static("http://localhost")
        .connect_with_connector(connect)
        .await
        .expect("connected");
    let answer = PointServiceClient::new(channel)
        .list_profiles(ListProfilesRequest {})
        .await
        .expect("an answer");
    assert!(!answer.into_inner().profiles.is_empty());
}

/// Makes a connector for tonic from a function that connects.
fn tower_connector<F, T, S>(
    connect: F,
) -> impl tonic::codegen::Service<
    http::Uri,
    Response = hyper_util::rt::TokioIo<S>,
    Error = std::io::Error,
    Future: Send,
> + Send
where
    F: Fn() -> T + Send + Clone + 'static,
    T: Future<Output = std::io::Result<S>> + Send + 'static,
    S: tokio::io::AsyncRead + tokio::io::AsyncWrite + Send + Unpin + 'static,
{
    Connector(connect)
}

struct Connector<F>(F);

impl<F, T, S> tonic::codegen::Service<http::Uri> for Connector<F>
where
    F: Fn() -> T + Send,
    T: Future<Output = std::io::Result<S>> + Send + 'static,
{
    type Response = hyper_util::rt::TokioIo<S>;
    type Error = std::io::Error;
    type Future =
        std::pin::Pin<Box<dyn Future<Output = std::io::Result<hyper_util::rt::TokioIo<S>>> + Send>>;

    fn poll_ready(
        &mut self,
        _: &mut std::task::Context<'_>,
    ) -> std::task::Poll<std::io::Result<()>> {
        std::task::Poll::Ready(Ok(()))
    }

    fn call(&mut self, _: http::Uri) -> Self::Future {
        let connected = (self.0)();
        Box::pin(async move { Ok(hyper_util::rt::TokioIo::new(connected.await?)) })
    }
}

#[test]
fn only_clients_with_a_trusted_certificate_are_admitted() {
    let folder = tempfile::tempdir().expect("a folder");
    let (servers, clients) = (Authority::new(), Authority::new());
    servers.issue_server().write_server(folder.path());
    std::fs::write(folder.path().join("clients.pem"), clients.pem()).expect("writable");
    let daemon = Daemon::with_tls(folder.path(), &[]);
    let known = clients.issue_client();
    let unknown = Authority::new().issue_client();
    let request = |shown: Option<&Certificate>| {
        let config = client(&servers, shown, &[b"http/1.1"]);
        get(&mut connect(&daemon, &config), "/livez")
    };
    let response = request(Some(&known)).expect("admitted");
    assert!(response.starts_with("HTTP/1.1 200"), "{response}");
    request(None).expect_err("no certificate");
    request(Some(&unknown)).expect_err("an untrusted certificate");
    request(Some(&known)).expect("still admitted");
}

#[test]
fn new_certificates_serve_new_connections_and_bad_ones_change_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let authority = Authority::new();
    let first = authority.issue_server();
    first.write_server(folder);
    // Files are read on a signal only, so that a change below is the effect of the signal.
    let daemon = Daemon::with_tls(folder, &["reload.watch_seconds=0"]);
    let config = client(&authority, None, &[b"http/1.1"]);
    let mut open = connect(&daemon, &config);
    get(&mut open, "/livez").expect("an answer");
    assert_eq!(shown(&daemon, &config), first.der);
    let hang_up = || daemon.signal("HUP");

    let second = authority.issue_server();
    second.write_server(folder);
    hang_up();
    until("the new certificate is shown", || {
        shown(&daemon, &config) == second.der
    });
    get(&mut open, "/livez").expect("the old connection goes on");

    // A key that does not match its certificate changes nothing.
    std::fs::write(folder.join("server.key"), &first.key_pem).expect("writable");
    hang_up();
    std::fs::write(folder.join("server.pem"), "no certificate").expect("writable");
    hang_up();
    assert_eq!(shown(&daemon, &config), second.der);
    get(&mut open, "/livez").expect("the old connection goes on");

    // Good files are applied again.
    let third = authority.issue_server();
    third.write_server(folder);
    hang_up();
    until("the third certificate is shown", || {
        let shown = shown(&daemon, &config);
        let is_known = [&second, &third].map(|issued| shown == issued.der);
        assert_ne!(is_known, [false, false], "another certificate is presented");
        is_known[1]
    });
}

#[test]
fn changed_files_are_noticed_without_a_signal() {
    let folder = tempfile::tempdir().expect("a folder");
    let authority = Authority::new();
    authority.issue_server().write_server(folder.path());
    let daemon = Daemon::with_tls(folder.path(), &["reload.watch_seconds=0.05"]);
    let config = client(&authority, None, &[b"http/1.1"]);
    let second = authority.issue_server();
    second.write_server(folder.path());
    until("the new certificate is shown", || {
        shown(&daemon, &config) == second.der
    });
}

#[test]
fn unusable_files_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let authority = Authority::new();
    let [one, other] = [(); 2].map(|()| authority.issue_server());
    let write = |name: &str, text: &str| {
        std::fs::write(folder.join(name), text).expect("writable");
        folder.join(name).display().to_string()
    };
    let good = write("good.pem", &one.pem);
    let key = write("good.key", &one.key_pem);
    let other = write("other.key", &other.key_pem);
    let text = write("text", "nothing of the kind");
    let nowhere = folder.join("nowhere").display().to_string();
    for (certificate, key, clients, words) in [
        (&nowhere, &key, "", ["tls.certificate", "No such file"]),
        (&text, &key, "", ["tls.certificate", "no certificate"]),
        (&good, &text, "", ["tls.key", "no private key"]),
        (&good, &good, "", ["tls.key", "no private key"]),
        (&good, &other, "", ["tls.key", "does not go with"]),
        (&good, &key, &text, ["tls.client_ca", "no certificate"]),
        (
            &String::new(),
            &key,
            "",
            ["tls.certificate", "none of them"],
        ),
        (
            &String::new(),
            &String::new(),
            &good,
            ["tls.client_ca", "none of them"],
        ),
    ] {
        let tables = tables();
        let output = strew()
            .args(["serve", "--listen", "127.0.0.1:0", "--tables"])
            .arg(tables.path())
            .args(["--set", &format!("tls.certificate={certificate}")])
            .args(["--set", &format!("tls.key={key}")])
            .args(["--set", &format!("tls.client_ca={clients}")])
            .output()
            .expect("the program runs");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        for word in words {
            assert!(message.contains(word), "no `{word}`: {message}");
        }
    }
}

/// The messages of a daemon that starts to listen on an address that is taken.
fn warned(listen: &str, settings: &[String]) -> String {
    let tables = tables();
    let mut command = strew();
    command.args(["serve", "--listen", listen, "--tables"]);
    command.arg(tables.path());
    for setting in settings {
        command.args(["--set", setting]);
    }
    // It warns first, then fails to listen.
    let output = command.output().expect("the program runs");
    assert_eq!(output.status.code(), Some(1));
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn listening_on_the_network_without_tls_warns() {
    let taken = std::net::TcpListener::bind("0.0.0.0:0").expect("a port");
    let port = taken.local_addr().expect("an address").port();
    let text = warned(&format!("0.0.0.0:{port}"), &[]);
    assert!(
        text.contains("WARN") && text.contains("without TLS"),
        "{text}"
    );
    let local = warned(&format!("127.0.0.1:{port}"), &[]);
    assert!(!local.contains("without TLS"), "{local}");
    let folder = tempfile::tempdir().expect("a folder");
    Authority::new().issue_server().write_server(folder.path());
    let file =
        |setting: &str, name: &str| format!("{setting}={}", folder.path().join(name).display());
    let tls = [
        file("tls.certificate", "server.pem"),
        file("tls.key", "server.key"),
    ];
    let text = warned(&format!("0.0.0.0:{port}"), &tls);
    assert!(!text.contains("without TLS"), "{text}");
}

#[test]
fn an_expired_certificate_warns() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = taken.local_addr().expect("an address").to_string();
    let folder = tempfile::tempdir().expect("a folder");
    let files = ["certificate=server.pem", "key=server.key"]
        .map(|file| file.replace('=', &format!("={}/", folder.path().display())))
        .map(|file| format!("tls.{file}"));
    let authority = Authority::new();
    for (issued, is_expired) in [
        (authority.issue_expired_server(), true),
        (authority.issue_server(), false),
    ] {
        issued.write_server(folder.path());
        let text = warned(&address, &files);
        let is_warned = text.contains("WARN") && text.contains("the certificate expired");
        assert_eq!(is_warned, is_expired, "{text}");
    }
}
