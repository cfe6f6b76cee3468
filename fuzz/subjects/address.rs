//! Addresses of REST: a path with its parameters. Portraits of tables are left out: each
//! takes its time once, and there is hardly a parameter to them.

use http::Request;
use strew::body::Body;

use super::protocols;

pub fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    // What is no address never comes this far.
    if let Ok(request) = Request::get(text.trim_end()).body(Body::empty())
        && request.uri().path().starts_with('/')
        && !request.uri().path().starts_with("/v1/profiles/")
    {
        protocols::ask(request);
    }
}
