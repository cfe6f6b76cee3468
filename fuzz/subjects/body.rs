//! Queries as JSON: a line with the path, then the body.

use http::Request;
use strew::body::Body;

use super::protocols;

pub fn run(data: &[u8]) {
    let mut lines = data.splitn(2, |&b| b == b'\n');
    let (Some(path), Some(body)) = (lines.next(), lines.next()) else {
        return;
    };
    let Ok(path) = std::str::from_utf8(path) else {
        return;
    };
    let request = Request::post(path)
        .header("content-type", "application/json")
        .body(Body::from(body.to_vec()));
    if let Ok(request) = request
        && request.uri().path().starts_with('/')
    {
        protocols::ask(request);
    }
}
