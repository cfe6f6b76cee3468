//! curl, where it is installed.

use std::process::Command;

use strew_encode::Encoding;

use crate::support::{clients, daemon::Daemon};

const QUERY: &str = "/v1/points?bbox=0,0,50,50&density=2&profile=test&format=";

#[test]
fn curl_gets_the_same_bytes_over_http_1_and_2() {
    let Some(curl) = clients::find("curl") else {
        return;
    };
    let daemon = Daemon::start(&[]);
    for format in Encoding::ALL.iter().map(|format| format.name()) {
        let url = daemon.url(&format!("{QUERY}{format}"));
        let expected = daemon.get(&format!("{QUERY}{format}")).body;
        for version in ["--http1.1", "--http2-prior-knowledge"] {
            let output = Command::new(&curl)
                .args(["-sS", "--fail", version, &url])
                .output()
                .expect("curl runs");
            assert!(output.status.success(), "{version} {format}");
            assert_eq!(output.stdout, expected, "{version} {format}");
        }
    }
}
