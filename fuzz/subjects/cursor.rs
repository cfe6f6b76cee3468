//! Cursors: a true one goes on where it says; any other is refused.
//!
//! Bytes: the query, how many points are taken before, then pairs of a place in the token and what
//! is put there.

use http::{Request, StatusCode};
use strew::body::Body;

use super::protocols::{self, Answered};

const QUERIES: [&str; 4] = [
    "bbox=0,0,20,20&spacing=1",
    "bbox=-1e9,5,-999999990,15&spacing=0.5&seed=9&profile=spaced",
    "circle=3,4,9&count=200&seed=1",
    "bbox=0,0,9,9&spacing=1&keep=0.5&warp=on",
];

fn points(query: &str, more: &str) -> Answered {
    let request = Request::get(format!("/v1/points?{query}&format=csv{more}"));
    protocols::ask(request.body(Body::empty()).expect("a request"))
}

/// The points of an answer, without the names of their columns.
fn lines(answered: Answered) -> Vec<String> {
    let text = String::from_utf8(answered.body).expect("UTF-8");
    text.lines().skip(1).map(Into::into).collect()
}

pub fn run(data: &[u8]) {
    let &[query, taken, ref edits @ ..] = data else {
        return;
    };
    let query = QUERIES[usize::from(query) % QUERIES.len()];
    let first = points(query, &format!("&limit={}", u32::from(taken) + 1));
    assert_eq!(first.head.status, StatusCode::OK, "{query}");
    let Some(token) = first.header("strew-next") else {
        return;
    };
    let mut edited = token.to_owned().into_bytes();
    for edit in edits.chunks_exact(2) {
        let at = usize::from(edit[0]) % edited.len();
        edited[at] = match edit[1] {
            byte if byte.is_ascii_alphanumeric() => byte,
            byte => b"0123456789abcdef"[usize::from(byte % 16)],
        };
    }
    let edited = String::from_utf8(edited).expect("ASCII");
    let rest = points(query, &format!("&cursor={edited}"));
    if edited.eq_ignore_ascii_case(token) {
        assert_eq!(rest.head.status, StatusCode::OK, "{query}: {edited}");
        let [first, rest, whole] = [first, rest, points(query, "")].map(lines);
        assert_eq!([first, rest].concat(), whole, "{query}: {edited}");
    } else {
        assert_eq!(
            rest.head.status,
            StatusCode::BAD_REQUEST,
            "{query}: {edited}"
        );
    }
}
