//! Invalid parameters of every path: the problem names the parameter, its value, and what is
//! allowed.

use crate::support::{daemon::Daemon, problem::assert_fault};

/// (path with parameters, the field at fault, texts in its fault).
const PATHS: &[(&str, &str, &[&str])] = &[
    (
        "points?circle=0,0&spacing=1",
        "circle",
        &["0,0", "radius", "expected 3 numbers, got 2"],
    ),
    (
        "points?circle=0,0,0&spacing=1",
        "circle",
        &["0.0", "above 0"],
    ),
    ("points?circle=0,0,-1&spacing=1", "circle", &["-1"]),
    ("points?circle=0,0,1e308&spacing=1", "circle", &["1e+308"]),
    ("points?circle=0,NaN,1&spacing=1", "circle", &["0,NaN,1"]),
    ("points?circle=1e200,0,1&spacing=1", "circle", &["1e+200"]),
    ("points?polygon=0,0,1,1&spacing=1", "polygon", &["3"]),
    (
        "points?polygon=0,0,1,1,2&spacing=1",
        "polygon",
        &["0,0,1,1,2"],
    ),
    (
        "points?polygon=0,0,1,1,inf,2&spacing=1",
        "polygon",
        &["inf"],
    ),
    (
        "points?bbox=0,0,1,1&circle=0,0,1&spacing=1",
        "circle",
        &["bbox is given"],
    ),
    ("points?bbox=0,0,9,9&count=0", "count", &["0", "from 1"]),
    ("points?bbox=0,0,9,9&count=1.5", "count", &["1.5"]),
    ("points?bbox=0,0,9,9&count=-3", "count", &["-3"]),
    (
        "points?bbox=0,0,9,9&count=3&spacing=1",
        "count",
        &["spacing is given"],
    ),
    (
        "points?bbox=0,0,9,9&min_distance=0",
        "min_distance",
        &["1e-100"],
    ),
    ("points?bbox=0,0,9,9&min_distance=x", "min_distance", &["x"]),
    (
        "points?bbox=0,0,9,9&min_distance=1&profile=pink",
        "min_distance",
        &["pink", "1"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&keep=0",
        "keep",
        &["0", "1e-6 to 1"],
    ),
    ("points?bbox=0,0,9,9&spacing=1&keep=1.1", "keep", &["1.1"]),
    (
        "points?bbox=0,0,9,9&spacing=1&attributes=size",
        "attributes",
        &["size", "angle"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&attributes=u17",
        "attributes",
        &["u17", "u16"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&attributes=u1,u1",
        "attributes",
        &["u1,u1"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&attributes=",
        "attributes",
        &["angle"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&attributes=variant",
        "variants",
        &["missing", "oak:3"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&scale_range=1,2",
        "scale_range",
        &["1.0,2.0", "scale"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&attributes=scale&scale_range=2,1",
        "scale_range",
        &["2.0,1.0", "min <= max"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&variants=a,b",
        "variants",
        &["a:1.0,b:1.0", "variant"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&attributes=variant&variants=a:0",
        "variants",
        &["a:0", "1e-9"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&attributes=variant&variants=a,a",
        "variants",
        &["a:1.0,a:1.0"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&offset=-1",
        "offset",
        &["-1", "from 0"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&offset=18446744073709551616",
        "offset",
        &["18446744073709551616"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&limit=0",
        "limit",
        &["0", "from 1"],
    ),
    ("points?bbox=0,0,9,9&spacing=1&limit=all", "limit", &["all"]),
    (
        "points?bbox=0,0,9,9&spacing=1&cursor=x",
        "cursor",
        &["x", "earlier answer"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&layers=2",
        "layers",
        &["unknown parameter"],
    ),
    (
        "points?bbox=0,0,9,9&spacing=1&at=0,0",
        "at",
        &["not allowed here"],
    ),
    (
        "count?bbox=0,0,9,9&spacing=1&format=csv",
        "format",
        &["csv"],
    ),
    (
        "count?bbox=0,0,9,9&spacing=1&k=3",
        "k",
        &["not allowed here"],
    ),
    ("chunks/0/1/1?spacing=1", "size", &["0", "above 0"]),
    ("chunks/nan/1/1?spacing=1", "size", &["nan", "above 0"]),
    ("chunks/-4/1/1?spacing=1", "size", &["-4"]),
    ("chunks/wide/1/1?spacing=1", "size", &["wide"]),
    ("chunks/4/1.5/1?spacing=1", "cx", &["1.5", "integer"]),
    ("chunks/4/1/y?spacing=1", "cy", &["y", "integer"]),
    (
        "chunks/4/4503599627370497/1?spacing=1",
        "cx",
        &["4503599627370497"],
    ),
    (
        "chunks/1e300/4503599627370496/1?spacing=1",
        "chunk",
        &["not finite"],
    ),
    (
        "chunks/1e-9/4503599627370496/1?spacing=1e-9",
        "chunk",
        &["far"],
    ),
    (
        "chunks/4/1/1?spacing=1&bbox=0,0,1,1",
        "bbox",
        &["not allowed here"],
    ),
    ("points/7?spacing=1", "id", &["7", "-31:52"]),
    ("points/1:2:3?spacing=1", "id", &["1:2:3"]),
    ("points/a:b?spacing=1", "id", &["a:b"]),
    (
        "points/0:0",
        "spacing",
        &["missing", "density, spacing, min_distance"],
    ),
    ("points/0:0?count=5", "count", &["not allowed here"]),
    (
        "points/0:0?spacing=1&bbox=0,0,1,1",
        "bbox",
        &["not allowed here"],
    ),
    ("nearest?spacing=1", "at", &["missing"]),
    ("nearest?at=1&spacing=1", "at", &["1", "x,y"]),
    ("nearest?at=1,inf&spacing=1", "at", &["1,inf"]),
    (
        "nearest?at=1e300,0&spacing=1",
        "at",
        &["1e+300", "too far from the origin"],
    ),
    ("nearest?at=0,0&k=0&spacing=1", "k", &["0", "1 to 10000"]),
    ("nearest?at=0,0&k=10001&spacing=1", "k", &["10001"]),
    ("nearest?at=0,0&radius=-1&spacing=1", "radius", &["-1"]),
    ("nearest?at=0,0&radius=1e4&spacing=1", "radius", &["10000"]),
    (
        "nearest?at=0,0&k=10&spacing=1&keep=1e-6",
        "k",
        &["10", "share"],
    ),
    ("nearest?at=0,0&count=4", "count", &["not allowed here"]),
];

#[test]
fn faults_name_the_wrong_parameter() {
    let daemon = Daemon::start(&[]);
    for (rest, field, texts) in PATHS {
        let path = format!("/v1/{rest}");
        assert_fault(&daemon.get(&path), &path, field, texts);
    }
}
