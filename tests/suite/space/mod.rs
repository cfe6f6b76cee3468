//! Points in space: REST and the command line have the library's points, in every format. `agree` asks gRPC, too.

mod command;
mod engines;
mod formats;
mod paths;
mod tables;
mod varied;

use strew_core::space::{Plan, Point, SpaceSet, Volume};
use strew_testkit::http1;

/// The points of the library's own table.
pub fn set(spacing: f64, seed: u64) -> SpaceSet {
    let set = SpaceSet::blue().seed(seed);
    set.spacing(spacing).expect("in range")
}

/// The planned points of a volume.
pub fn within(set: &SpaceSet, volume: impl Into<Volume>) -> Plan {
    set.within(volume).expect("near")
}

/// The lines of an answer as csv: an id and three numbers each.
pub fn lines(answer: &http1::Answer) -> Vec<(String, [f64; 3])> {
    assert_eq!(answer.status, 200, "{}", answer.text());
    let mut lines = answer.text().lines();
    assert_eq!(lines.next(), Some("id,x,y,z"));
    let read = |line: &str| {
        let mut fields = line.split(',');
        let id = fields.next().expect("an id").to_owned();
        let mut number = || fields.next().expect("a field").parse().expect("a number");
        (id, [number(), number(), number()])
    };
    lines.map(read).collect()
}

/// Points as such lines.
pub fn told(points: &[Point]) -> Vec<(String, [f64; 3])> {
    let told = points.iter();
    told.map(|point| (point.id.to_string(), point.at()))
        .collect()
}
