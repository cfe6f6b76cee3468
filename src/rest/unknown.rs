//! The answers to unknown paths, and to methods that a path does not take.

use http::{HeaderValue, Method, Uri, header};
use strew_error::Error;

use super::problem::Problem;
use crate::body::Response;

/// The most paths that an answer names.
const MOST: usize = 3;
/// The least likeness to a path that is worth naming.
const LIKE: f64 = 0.5;
/// The length to which a longer path is cut before it is compared.
const COMPARED: usize = 80;

/// The answer to an unknown path: the paths that are most like it.
pub(super) fn not_found(path: &str, paths: &str) -> Response {
    let error = Error::NoSuchPath {
        path: path.into(),
        available: available(path, paths),
    };
    Problem::response(&error)
}

fn available(path: &str, paths: &str) -> String {
    // The usual mistake is a trailing slash.
    let without = path.trim_end_matches('/');
    let is_known = |wanted: &str| paths.split(", ").any(|known| known == wanted);
    if !without.is_empty() && without != path && is_known(without) {
        return format!("{without} (without the slash at the end)");
    }
    let start: String = path.chars().take(COMPARED).collect();
    let likeness = |known| strsim::normalized_damerau_levenshtein(&start, known);
    let scored = paths.split(", ").map(|known| (likeness(known), known));
    let mut like: Vec<(f64, &str)> = scored.filter(|(likeness, _)| *likeness > LIKE).collect();
    like.sort_by(|a, b| b.0.total_cmp(&a.0));
    let nearest = like.iter().take(MOST).map(|(_, known)| *known);
    let all = is_known("/openapi.json").then_some("all that /openapi.json lists");
    nearest.chain(all).collect::<Vec<_>>().join(", ")
}

/// The answer to a method that a path does not take.
pub(super) fn wrong_method(method: &Method, uri: &Uri, allowed: &str) -> Response {
    let path = uri.path();
    let is_query = path == "/v1/points" && method == Method::POST;
    let elsewhere = if is_query {
        "; POST is for /v1/points:query"
    } else {
        ""
    };
    let error = Error::NoSuchMethod {
        path: path.into(),
        method: method.to_string(),
        allowed: format!("{allowed}{elsewhere}"),
    };
    let mut response = Problem::response(&error);
    if let Ok(allow) = HeaderValue::from_str(allowed) {
        response.headers_mut().insert(header::ALLOW, allow);
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paths_most_like_an_unknown_one_are_named() {
        const PATHS: &str = "/v1/points, /v1/points/{id}, /v1/count, /docs, /openapi.json";
        for (path, expected) in [
            ("/v1/points/", "/v1/points (without the slash at the end)"),
            (
                "/v1/point",
                "/v1/points, /v1/count, /v1/points/{id}, all that /openapi.json lists",
            ),
            ("/doc", "/docs, all that /openapi.json lists"),
            ("/wp-login.php", "all that /openapi.json lists"),
        ] {
            assert_eq!(available(path, PATHS), expected, "{path}");
        }
    }
}
