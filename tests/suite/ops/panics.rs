//! Panics: they fail one request, which gets an internal error without details of the source.

use std::net::TcpListener;

use http::Method;
use strew::{
    body::Response,
    ops::App,
    rest::{
        Context, Refused,
        api::{Endpoint, Operation, Tag},
    },
};
use strew_config::Layers;
use strew_testkit::http1;

#[tokio::test(flavor = "multi_thread")]
async fn a_panic_fails_one_request_only() {
    let mut layers = Layers::new().expect("the defaults");
    for setting in ["server.listen=127.0.0.1:0", "shutdown.drain_seconds=1"] {
        layers = layers.assignment(setting).expect("a setting");
    }
    async fn panics(_: Context) -> Result<Response, Refused> {
        panic!("a secret of the source")
    }
    let operation = |method| Operation {
        method,
        ..Operation::new(Tag::Operations, vec![])
    };
    let endpoint = Endpoint::only("/panics", (), operation(Method::GET), panics)
        .with((), operation(Method::POST), panics)
        .open();
    let mut app = App::new(layers.finish().expect("settings")).expect("tables");
    app.more = vec![endpoint];
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address");
    let (stop, stopped) = tokio::sync::oneshot::channel::<()>();
    let running = tokio::spawn(app.run(listener, async move {
        let _ = stopped.await;
    }));
    let requests = tokio::task::spawn_blocking(move || {
        for _ in 0..3 {
            let answer = http1::get(address, "/panics", &[]);
            assert_eq!(answer.status, 500, "{}", answer.text());
            assert_eq!(answer.header("content-type"), "application/problem+json");
            assert_eq!(answer.json()["type"], "urn:strew:problem:internal");
            assert!(!answer.text().contains("secret"), "{}", answer.text());
        }
        let call = [("content-type", "application/grpc-web")];
        let answer = http1::post(address, "/panics", &call, b"");
        assert_eq!(answer.header("grpc-status"), "13", "INTERNAL");
        assert_eq!(http1::get(address, "/livez", &[]).status, 200);
    });
    requests.await.expect("no panic");
    let _ = stop.send(());
    running.await.expect("no panic").expect("stopped");
}
