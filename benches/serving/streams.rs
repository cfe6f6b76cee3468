//! Long streams: points as they are made, next to a block that is copied and one that is sent as
//! is.

use std::net::SocketAddr;

use super::{
    download,
    h2c::{self, Windows},
    host::Host,
    timing::{Effort, Way, print, rates},
};

/// The bytes of a point as two `f32`.
const POINT: u64 = 8;

/// The path of a square with about `points` points.
fn square(points: u64, rest: &str) -> String {
    let side = (points as f64).sqrt();
    format!("/v1/points?bbox=0,0,{side},{side}&spacing=1&{rest}")
}

/// HTTP/1.1, next to another server that sends a file of the same size, if one is given.
pub fn http(host: &Host, effort: Effort, other: Option<(SocketAddr, String)>) {
    let address = host.address;
    let bytes = effort.points * POINT;
    let paths = [
        ("f32 points", square(effort.points, "format=f32")),
        ("a block copied", format!("/bench/copied/{bytes}")),
        ("the same block again", format!("/bench/constant/{bytes}")),
        (
            "warped f32 points",
            square(effort.points, "format=f32&seed=1"),
        ),
        ("f64 points", square(effort.points / 2, "format=f64")),
    ];
    let mut ways: Vec<Way<'_>> = paths
        .iter()
        .map(|(name, path)| Way::new(name, move || download::whole(address, path) as f64))
        .collect();
    if let Some((address, path)) = &other {
        let work = move || download::whole(*address, path) as f64;
        ways.push(Way::new("the other server", work));
    }
    let rates = rates(effort.rounds, &mut ways);
    let title = format!("HTTP/1.1, {} points a stream, one reader", effort.points);
    print(&title, "GB/s", 1e-9, &ways, &rates);
}

/// gRPC with packed blocks.
pub fn grpc(host: &Host, effort: Effort) {
    let bytes = effort.points * POINT;
    let request = h2c::request(effort.points);
    for (title, windows) in [
        ("gRPC, a client with default settings", Windows::DEFAULT),
        (
            "gRPC, frames of 256 KiB, windows of 8/16 MiB",
            Windows::WIDE,
        ),
    ] {
        let address = host.address;
        let constant = format!("/bench.Constant/{bytes}");
        let points = "/strew.v1.PointService/StreamPoints";
        let mut ways = [
            Way::new("packed f32 points", || {
                h2c::call(address, points, request.clone(), windows)
            }),
            Way::new("a framed block again", || {
                h2c::call(address, &constant, request.clone(), windows)
            }),
        ];
        let rates = rates(effort.rounds, &mut ways);
        print(title, "GB/s", 1e-9, &ways, &rates);
    }
}
