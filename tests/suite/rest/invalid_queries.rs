//! Invalid queries to `/v1/points`: the problem document lists exactly the fields at fault.

use strew_testkit::http1;

use crate::support::daemon::Daemon;

/// A valid region.
const BOX: &str = "bbox=0,0,10,10";

/// (query, the fields at fault, texts in the answer); `!` is a valid region, `~` is one with an amount.
const CASES: &[(&str, &[&str], &[&str])] = &[
    // Missing.
    ("", &["bbox", "spacing"], &["missing"]),
    ("density=1", &["bbox"], &["missing"]),
    (BOX, &["spacing"], &["missing", "spacing"]),
    // Not a number, not finite, too far.
    ("bbox=0,0,NaN,10&density=1", &["bbox"], &["max_x", "NaN"]),
    ("bbox=0,0,10,inf&density=1", &["bbox"], &["max_y", "inf"]),
    ("bbox=-infinity,0,10,10&density=1", &["bbox"], &["min_x"]),
    (
        "bbox=0,0,1e400,10&density=1",
        &["bbox"],
        &["max_x", "1e400"],
    ),
    (
        "bbox=0,0,1e300,10&density=1",
        &["bbox"],
        &["max_x", "1e+300", "too far"],
    ),
    (
        "bbox=-1e300,0,10,10&density=1",
        &["bbox"],
        &["min_x", "too far"],
    ),
    ("bbox=0,zero,10,10&density=1", &["bbox"], &["min_y", "zero"]),
    ("bbox=0,,10,10&density=1", &["bbox"], &["min_y"]),
    ("bbox=&density=1", &["bbox"], &["min_x is missing"]),
    (
        "bbox=0,0,10&density=1",
        &["bbox"],
        &["expected 4 numbers, got 3", "0,0,10"],
    ),
    (
        "bbox=0,0,10,10,10&density=1",
        &["bbox"],
        &["expected 4 numbers, got 5"],
    ),
    // Reversed and empty.
    (
        "bbox=10,0,0,10&density=1",
        &["bbox"],
        &["reversed", "max_x"],
    ),
    (
        "bbox=0,10,10,0&density=1",
        &["bbox"],
        &["reversed", "max_y"],
    ),
    ("bbox=0,0,0,10&density=1", &["bbox"], &["empty", "max_x"]),
    ("bbox=0,5,10,5&density=1", &["bbox"], &["empty", "max_y"]),
    // The amount.
    ("!density=0", &["density"], &["0", "1e-200"]),
    ("!density=-1", &["density"], &["-1"]),
    ("!density=NaN", &["density"], &["NaN"]),
    ("!density=inf", &["density"], &["inf"]),
    ("!density=1e300", &["density"], &["1e300"]),
    ("!density=many", &["density"], &["many"]),
    ("!spacing=0", &["spacing"], &["1e-100"]),
    ("!spacing=-2", &["spacing"], &["-2"]),
    ("!spacing=1e300", &["spacing"], &["1e300"]),
    ("!spacing=", &["spacing"], &["must be a number"]),
    ("~spacing=1", &["spacing"], &["density"]),
    // The table.
    (
        "~profile=mauve",
        &["profile"],
        &["mauve", "test", "sqrt(3)"],
    ),
    ("~profile=", &["profile"], &["test"]),
    ("~alpha=3/2", &["alpha"], &["3/2", "sqrt(3)"]),
    ("~alpha=5", &["alpha"], &["out of range"]),
    ("~alpha=root", &["alpha"], &["root", "decimal"]),
    // Other parameters.
    ("~seed=-1", &["seed"], &["-1", "18446744073709551615"]),
    ("~seed=1.5", &["seed"], &["1.5"]),
    ("~map=xl", &["map"], &["xl"]),
    ("~map=l", &["map"], &["l"]),
    ("~warp=3", &["warp"], &["3"]),
    ("~warp=-0.5", &["warp"], &["-0.5"]),
    ("~warp=maybe", &["warp"], &["maybe"]),
    ("~warp=NaN", &["warp"], &["NaN"]),
    (
        "~seed=18446744073709551616",
        &["seed"],
        &["18446744073709551616"],
    ),
    ("~format=xml", &["format"], &["xml", "ndjson"]),
    ("~format=parquet", &["format"], &["strew sample", "arrow"]),
    ("~format=csv&decimals=18", &["decimals"], &["18", "0 to 17"]),
    ("~decimals=-1", &["decimals"], &["-1"]),
    (
        "~decimals=3&format=f64",
        &["decimals"],
        &["f64", "ndjson", "csv"],
    ),
    ("~size=15&format=png", &["size"], &["15", "16 to 4096"]),
    ("~size=100&decimals=2", &["size"], &["json", "png, svg"]),
    (
        "bbox=0,0,1000,1000&density=1&format=svg",
        &["format"],
        &["100000", "png"],
    ),
    ("~formt=csv", &["formt"], &["csv", "did you mean `format`?"]),
    ("~%66oo=1", &["foo"], &["unknown parameter"]),
    ("~density=2", &["density"], &["given twice", "1"]),
    ("!bbox=0,0,10,10&density=1", &["bbox"], &["given twice"]),
    ("~profile=%ff", &["profile"], &["UTF-8", "%ff"]),
    ("~alpha=%C3%28", &["alpha"], &["UTF-8"]),
    ("~%ff=1", &["\u{fffd}"], &["unknown parameter"]),
    // Several faults at once.
    (
        "bbox=5,5,1,1&density=0&profile=mauve&alpha=x&seed=y&format=z&w=v",
        &["w", "density", "seed", "bbox", "alpha", "profile", "format"],
        &["reversed", "mauve", "unknown format"],
    ),
];

#[test]
fn the_problem_lists_exactly_the_fields_at_fault() {
    let daemon = Daemon::start(&[]);
    for (query, fields, texts) in CASES {
        let default = if query.contains("profile=") {
            ""
        } else {
            "&profile=test"
        };
        // A request line has no spaces; everything else is sent as it is.
        let query = query
            .replace('~', "!density=1&")
            .replace('!', "bbox=0,0,10,10&");
        let path = format!("/v1/points?{query}{default}").replace(' ', "%20");
        let answer = daemon.get(&path);
        assert_eq!(answer.status, 400, "{path}: {}", answer.text());
        assert_eq!(answer.header("content-type"), "application/problem+json");
        let problem = answer.json();
        assert_eq!(problem["type"], "urn:strew:problem:invalid-query");
        assert_eq!(problem["status"], 400);
        let errors = problem["errors"].as_array().expect("a list");
        let named: Vec<&str> = errors.iter().filter_map(|e| e["field"].as_str()).collect();
        assert_eq!(&named, fields, "{path}");
        for error in errors {
            let missing = error["detail"] == "missing";
            assert_eq!(error["value"].is_null(), missing, "{path}: {error}");
            assert!(
                error["allowed"].as_str().is_some_and(|a| !a.is_empty()),
                "{path}"
            );
            let field = error["field"].as_str().expect("a text");
            assert!(problem["detail"].as_str().expect("a text").contains(field));
        }
        for text in *texts {
            assert!(
                answer.text().contains(text),
                "{path}: no `{text}`: {}",
                answer.text()
            );
        }
    }
}

#[test]
fn long_values_are_not_echoed_whole() {
    let daemon = Daemon::start(&[]);
    let long = "x".repeat(5000);
    let answer = daemon.get(&format!(
        "/v1/points?{BOX}&density=1&profile={long}&{long}=1"
    ));
    assert_eq!(answer.status, 400);
    assert!(answer.body.len() < 2500, "{}", answer.body.len());
}

#[test]
fn an_unacceptable_accept_header_gets_the_list_of_formats() {
    let daemon = Daemon::start(&[]);
    let path = format!("/v1/points?{BOX}&density=1&profile=test");
    for accept in [
        "text/html",
        "application/xml",
        "nonsense",
        "application/json;q=0",
    ] {
        let answer = http1::get(daemon.address(), &path, &[("accept", accept)]);
        assert_eq!(answer.status, 406, "{accept}");
        assert_eq!(answer.header("content-type"), "application/problem+json");
        for text in [accept, "application/vnd.strew.f32", "text/csv"] {
            assert!(answer.text().contains(text), "{accept}: {}", answer.text());
        }
    }
}
