//! What addresses are refused for: the problem lists exactly the fields at fault, their values, and what is allowed.

use strew_testkit::http1;

use super::invalid_bodies::daemon;
use crate::support::{daemon::Daemon, problem::assert_faults, table::rows};

/// Addresses below `/v1/`, the fields at fault, and words of the problem. `~` is a query that lacks nothing.
const ADDRESSES: &str = r"
# Missing
points? | bbox, spacing | missing
points?density=1 | bbox | missing
points?bbox=0,0,10,10 | spacing | missing | spacing
points?bbox=0,0,NaN,10&density=1 | bbox | max_x | NaN
points?bbox=0,0,10,inf&density=1 | bbox | max_y | inf
points?bbox=-infinity,0,10,10&density=1 | bbox | min_x
points?bbox=0,0,1e400,10&density=1 | bbox | max_x | 1e400
points?bbox=0,0,1e300,10&density=1 | bbox | max_x | 1e+300 | too far
points?bbox=-1e300,0,10,10&density=1 | bbox | min_x | too far
points?bbox=0,zero,10,10&density=1 | bbox | min_y | zero
points?bbox=0,,10,10&density=1 | bbox | min_y
points?bbox=&density=1 | bbox | min_x is missing
points?bbox=0,0,10&density=1 | bbox | expected 4 numbers, got 3 | 0,0,10
points?bbox=0,0,10,10,10&density=1 | bbox | expected 4 numbers, got 5
points?bbox=10,0,0,10&density=1 | bbox | reversed | max_x
points?bbox=0,10,10,0&density=1 | bbox | reversed | max_y
points?bbox=0,0,0,10&density=1 | bbox | empty | max_x
points?bbox=0,5,10,5&density=1 | bbox | empty | max_y
# Amounts
points?bbox=0,0,10,10&density=0 | density | 0 | 1e-200
points?bbox=0,0,10,10&density=-1 | density | -1
points?bbox=0,0,10,10&density=NaN | density | NaN
points?bbox=0,0,10,10&density=inf | density | inf
points?bbox=0,0,10,10&density=1e300 | density | 1e300
points?bbox=0,0,10,10&density=many | density | many
points?bbox=0,0,10,10&spacing=0 | spacing | 1e-100
points?bbox=0,0,10,10&spacing=-2 | spacing | -2
points?bbox=0,0,10,10&spacing=1e300 | spacing | 1e300
points?bbox=0,0,10,10&spacing= | spacing | must be a number
# Tables and other members
points?bbox=0,0,9,9&density=1&spacing=1 | spacing | density
~&profile=mauve | profile | mauve | test | sqrt(3)
~&profile= | profile | test
~&alpha=3/2 | alpha | 3/2 | sqrt(3)
~&alpha=5 | alpha | out of range
~&alpha=root | alpha | root | decimal
~&seed=-1 | seed | -1 | 18446744073709551615
~&seed=1.5 | seed | 1.5
~&map=xl | map | xl
~&profile=test&map=l | map | l
~&warp=3 | warp | 3
~&warp=-0.5 | warp | -0.5
~&warp=maybe | warp | maybe
~&warp=NaN | warp | NaN
~&seed=18446744073709551616 | seed | 18446744073709551616
~&format=xml | format | xml | ndjson
~&format=csv&decimals=18 | decimals | 18 | 0 to 17
~&decimals=-1 | decimals | -1
~&decimals=3&format=f64 | decimals | f64 | ndjson | csv
~&size=15&format=png | size | 15 | 16 to 4096
~&size=100&decimals=2 | size | json | png, svg
points?bbox=0,0,1000,1000&density=1&format=svg | format | 100000 | png
~&formt=csv | formt | csv | did you mean `format`?
~&%66oo=1 | foo | unknown parameter
points?bbox=0,0,10,10&density=1&density=2 | density | given twice | 1
points?bbox=0,0,10,10&bbox=0,0,10,10&density=1 | bbox | given twice
~&profile=%ff | profile | UTF-8 | %ff
~&alpha=%C3%28 | alpha | UTF-8
~&%ff=1 | � | unknown parameter
points?bbox=5,5,1,1&density=0&profile=mauve&alpha=x&seed=y&format=z&w=v | w, density, seed, bbox, alpha, profile, format | reversed | mauve | unknown format
# Circles, polygons, counts, attributes, pages
points?circle=0,0&spacing=1 | circle | 0,0 | radius | expected 3 numbers, got 2
points?circle=0,0,0&spacing=1 | circle | 0.0 | above 0
points?circle=0,0,-1&spacing=1 | circle | -1
points?circle=0,0,1e308&spacing=1 | circle | 1e+308
points?circle=0,NaN,1&spacing=1 | circle | 0,NaN,1
points?circle=1e200,0,1&spacing=1 | circle | 1e+200
points?polygon=0,0,1,1&spacing=1 | polygon | 3
points?polygon=0,0,1,1,2&spacing=1 | polygon | 0,0,1,1,2
points?polygon=0,0,1,1,inf,2&spacing=1 | polygon | inf
points?bbox=0,0,1,1&circle=0,0,1&spacing=1 | circle | bbox is given
points?bbox=0,0,9,9&count=0 | count | 0 | from 1
points?bbox=0,0,9,9&count=1.5 | count | 1.5
points?bbox=0,0,9,9&count=-3 | count | -3
points?bbox=0,0,9,9&count=3&spacing=1 | count | spacing is given
points?bbox=0,0,9,9&min_distance=0 | min_distance | 1e-100
points?bbox=0,0,9,9&min_distance=x | min_distance | x
points?bbox=0,0,9,9&min_distance=1&profile=pink | min_distance | pink | 1
~&keep=0 | keep | 0 | 1e-6 to 1
~&keep=1.1 | keep | 1.1
~&attributes=size | attributes | size | angle
~&attributes=u17 | attributes | u17 | u16
~&attributes=u1,u1 | attributes | u1,u1
~&attributes= | attributes | angle
~&attributes=variant | variants | missing | oak:3
~&scale_range=1,2 | scale_range | 1.0,2.0 | scale
~&attributes=scale&scale_range=2,1 | scale_range | 2.0,1.0 | min <= max
~&variants=a,b | variants | a:1.0,b:1.0 | variant
~&attributes=variant&variants=a:0 | variants | a:0 | 1e-9
~&attributes=variant&variants=a,a | variants | a:1.0,a:1.0
~&offset=-1 | offset | -1 | from 0
~&offset=18446744073709551616 | offset | 18446744073709551616
~&limit=0 | limit | 0 | from 1
~&limit=all | limit | all
~&cursor=x | cursor | x | earlier answer
~&layers=2 | layers | unknown parameter
~&at=0,0 | at | not allowed here
# Other paths
count?bbox=0,0,9,9&spacing=1&format=csv | format | csv
count?bbox=0,0,9,9&spacing=1&k=3 | k | not allowed here
chunks/0/1/1?spacing=1 | size | 0 | above 0
chunks/nan/1/1?spacing=1 | size | nan | above 0
chunks/-4/1/1?spacing=1 | size | -4
chunks/wide/1/1?spacing=1 | size | wide
chunks/4/1.5/1?spacing=1 | cx | 1.5 | integer
chunks/4/1/y?spacing=1 | cy | y | integer
chunks/4/4503599627370497/1?spacing=1 | cx | 4503599627370497
chunks/1e300/4503599627370496/1?spacing=1 | chunk | not finite
chunks/1e-9/4503599627370496/1?spacing=1e-9 | chunk | far
chunks/4/1/1?spacing=1&bbox=0,0,1,1 | bbox | not allowed here
points/7?spacing=1 | id | 7 | -31:52
points/1:2:3?spacing=1 | id | 1:2:3
points/a:b?spacing=1 | id | a:b
points/0:0 | spacing | missing | density, spacing, min_distance
points/0:0?count=5 | count, spacing | not allowed here
points/0:0?spacing=1&bbox=0,0,1,1 | bbox | not allowed here
nearest?spacing=1 | at | missing
nearest?at=1&spacing=1 | at | 1 | x,y
nearest?at=1,inf&spacing=1 | at | 1,inf
nearest?at=1e300,0&spacing=1 | at | 1e+300 | too far from the origin
nearest?at=0,0&k=0&spacing=1 | k | 0 | 1 to 10000
nearest?at=0,0&k=10001&spacing=1 | k | 10001
nearest?at=0,0&radius=-1&spacing=1 | radius | -1
nearest?at=0,0&radius=1e4&spacing=1 | radius | 10000
nearest?at=0,0&k=10&spacing=1&keep=1e-6 | k | 10 | share
nearest?at=0,0&count=4 | count, spacing | not allowed here
# Patterns
pattern/arrangements?offsets=2,1&alpha=1 | alpha | between 1 and 2
pattern/arrangements?offsets=2,1&alpha=2 | alpha | between 1 and 2
pattern/arrangements?alpha=1.6 | offsets | missing
pattern/arrangements?offsets= | offsets | has no offsets
pattern/arrangements?offsets=1.5,2 | offsets | 1.5 must be an integer
pattern/arrangements?offsets=2 | offsets | two integers joined by a comma
pattern/arrangements?offsets=0,9007199254740994 | offsets | out of range
pattern/arrangements?offsets=2,1&grid=0,0,-1,5 | grid | max is below min
pattern/arrangements?offsets=2,1&grid=0,0,1.5,5 | grid | 1.5 must be an integer
pattern/arrangements?offsets=2,1&list=csv | list | beside grid
pattern/arrangements?offsets=2,1&grid=0,0,9,9&limit=5 | limit | beside list
pattern/arrangements?offsets=2,1&profile=blue | profile | beside density
pattern/arrangements?offsets=2,1&spacing=1&density=1 | spacing | too
pattern/arrangements?offsets=2,1&spacing=1&alpha=1.61 | alpha | not loaded for this alpha
pattern/map?radius=1000000 | radius | from 0 to 1024
pattern/map?radius=9&refined=8 | refined | below radius
pattern/map?radius=9&block=0,900 | block | no such block
pattern/clusters?distance=0.5 | distance | from 1 to 16
pattern/clusters?distance=2&most=65 | most | from 1 to 64
pattern/figures/map.svg?radius=1000000 | radius | from 0 to 1024
pattern/figures/map.svg?radius=400 | radius | from 1 to 200
pattern/figures/index.png?size=9 | size | 64 to 2048
pattern/figures/index.svg?size=200 | size | alpha, window
pattern/figures/index.svg?window=5000 | window | from 8 to 200
# Alphas, with and without tables
count?bbox=0,0,9,9&spacing=1&profile=pattern&alpha=1 | alpha | out of range | between 1 and 2
count?bbox=0,0,9,9&spacing=1&profile=pattern&alpha=2 | alpha | out of range | between 1 and 2
count?bbox=0,0,9,9&spacing=1&profile=pattern&alpha=0.5 | alpha | 0.5 | between 1 and 2
count?bbox=0,0,9,9&spacing=1&profile=pattern&alpha=sqrt(5) | alpha | sqrt(5) | between 1 and 2
count?bbox=0,0,9,9&spacing=1&profile=pattern&alpha=half | alpha | half | between 1 and 2
count?bbox=0,0,9,9&spacing=1&profile=pattern&alpha=3/2&map=r257 | map | r257 | 0 to 256
count?bbox=0,0,9,9&spacing=1&profile=pattern&alpha=3/2&map=huge | map | huge | 0 to 256
~&profile=blue&alpha=1.7123 | alpha | not loaded for this alpha | strew forge --profile blue
~&profile=blue&alpha=3/2 | alpha | no table of it can be good | repeats every 4
# Kinds
~&map=s&variants=oak:0,birch:1&spread=even | variants | 1e-9
~&map=s&variants=oak:-1,birch:1&spread=even | variants | 1e-9
~&map=s&variants=oak:1,birch:1000000&spread=even | variants | 1/1024
~&map=s&variants=oak:1&spread=even | variants | 2 to 32
~&map=s&variants=oak:1,oak:2&spread=even | variants | listed
~&map=s&variants=oak:1,birch:2&spread=smooth | spread | chance, even, joint
~&map=s&variants=oak:1,birch:2&spread=even&only=elm | only | birch, oak
~&map=s&variants=oak:1,birch:2&attributes=variant&only=oak | only | even or joint
~&map=s&variants=oak:7,birch:9&spread=joint | spread | spread even
~&map=s&spread=even | variants | name:weight
# Kinds that vary
~&map=s&variants=oak:1,birch:1&spread=even&variant_fields=elm:ramp | variant_fields.elm | birch, oak
~&map=s&variants=oak:1,birch:1&spread=even&variant_fields=birch:rump | variant_fields.birch | rump
~&map=s&variants=oak:1,birch:1&spread=even&variant_fields=birch | variant_fields | name:field
~&map=s&variants=oak:1,birch:1&spread=even&variant_fields=birch:ramp,birch:left | variant_fields | given twice
~&map=s&variants=oak:1,birch:1&spread=even&variant_fields=birch:ramp,oak:left,birch:left | variant_fields | given twice
~&map=s&variants=oak:1,birch:1&variant_fields=birch:ramp | variants, variant_fields | needs spread even
count?periodic=5000&spacing=1&variants=oak:1,birch:1&spread=even&variant_fields=birch:ramp | variant_fields | not with periodic
# Periods
points?periodic=5000&spacing=1&bbox=0,0,9,9 | bbox | not with periodic
points?periodic=5000&spacing=1&circle=0,0,9 | circle | not with periodic
points?periodic=5000&count=70 | count | not with periodic
points?periodic=5000&min_distance=1 | min_distance | not with periodic
points?periodic=5000 | spacing
points?periodic=0&spacing=1 | periodic | out of range
points?periodic=4294967297&spacing=1 | periodic | out of range | 4294967296
points?periodic=4294967296&spacing=1 | periodic | no period
chunks/8/0/0?periodic=5000&spacing=1 | periodic | not allowed here
nearest?at=0,0&periodic=5000&spacing=1 | periodic
mask.png?size=8 | size | 16 to 512
mask.png?size=2000 | size | 16 to 512
mask.png?bits=12 | bits | 8 or 16
mask.png?periodic=9 | periodic | size, seed, bits
mask.png?alpha=1.3 | alpha
# Fields and terrains
~&field=right | field | no such field | forest, left, portrait, ramp
~&heights=0,5 | heights | 0,5
~&normals=on | normals | on
~&align=0.5 | align | 0.5
~&terrain=alps | terrain | alps
~&terrain=ramp&heights=5,5 | heights | out of order
~&terrain=ramp&heights=0,1e10 | heights | low < high
~&terrain=ramp&heights=7 | heights | 7
~&terrain=ramp&align=1.5 | align | 1.5
~&terrain=ramp&normals=maybe | normals | maybe
~&terrain=ramp&align=1&format=instances | format | whole rotation
# Points taken away
~&except=1:0 | except[0] | this set has no such point
~&except=fell | except[0] | unknown list; did you mean `felled`?
~&except=1:x | except[0] | not an id
~&except=felled | except[0] | the list has ids of layers only
~&except=oak/1:2 | except[0] | there are no layers here
~&except=dug,dug | except[1] | given twice
points?bbox=0,0,9,9&count=9&except=dug | count | not with except
# Formats
~&format=instances&attributes=angle,rank | format | no room for rank
~&format=multimesh&attributes=rank,u1,u2 | format | no room for rank, u1, u2
chunks/64/100000000/2?spacing=1&format=glb | format | more than 32 bits
chunks/64/100000000/2?spacing=1&format=usda | format | more than 32 bits
points?bbox=0,0,5000,5000&spacing=1&format=glb | format | at most 16777216 points
~&format=glb&decimals=3 | decimals | has no effect in the format glb
points?bbox=0.31,0,0.39,9&spacing=0.1&decimals=1&format=csv | decimals | 2 or more
# Space
space/points?spacing=1 | bbox | missing | one of bbox and ball
space/points?bbox=0,0,2,2&spacing=1 | bbox | expected 6 numbers, got 4
space/points?bbox=0,0,0,2,2,0&spacing=1 | bbox | empty: min_z and max_z are both 0.0
space/points?bbox=0,0,5,2,2,1&spacing=1 | bbox | reversed: max_z is 1, below the lower bound 5
space/points?bbox=0,0,0,2,nan,1&spacing=1 | bbox | max_y is `nan`
space/points?bbox=0,0,0,1,1,1&ball=0,0,0,1&spacing=1 | ball | bbox is given
space/points?ball=0,0,0,-1&spacing=1 | ball | radius
space/points?bbox=0,0,0,1,1,1&spacing=0 | spacing | out of range
space/points?bbox=0,0,0,1,1,1&count=0 | count | an integer from 1
space/points?bbox=0,0,0,1,1,1&spacing=1&periodic=9 | periodic | not for points in space
space/points?bbox=0,0,0,1,1,1&spacing=1&field=jungle | field | no such field is loaded
space/points?bbox=0,0,0,9,9,9&spacing=1&except=8:8 | except[0] | no such point
space/points?bbox=0,0,0,9,9,9&spacing=1&except=8:8:8 | except[0] | no such point
space/points?bbox=0,0,0,9,9,9&count=5&except=8:8:-1 | count | not with except
space/points?bbox=0,0,0,1,1,1&spacing=1&profile=pink | profile | no such profile | blue (alpha | spaced (alpha
space/points?bbox=0,0,0,1,1,1&spacing=1&map=m | map | r16
space/points?bbox=0,0,0,1,1,1&spacing=1&attributes=angle | attributes | rotation
space/points?bbox=2e12,0,0,2.1e12,1,1&spacing=1 | bbox | min_x | too far from the origin | within ±
space/points?bbox=0,0,0,1,1,1&spacing=1&cursor=00 | cursor | not a cursor
space/chunks/0/0/0/0?spacing=1 | size | a finite number above 0
space/chunks/4/0/0/x?spacing=1 | cz | integer
space/chunks/4/0/0/0?spacing=1&bbox=0,0,0,1,1,1 | bbox | not allowed here
space/points/0:0?spacing=1 | id | three integers joined by colons
space/nearest?at=0,0&spacing=1 | at | expected 3 numbers, got 2
space/nearest?at=0,0,0&k=10001&spacing=1 | k | 10000
space/nearest?at=0,0,0&radius=50&spacing=1 | radius | about 523599 points lie within
space/points?bbox=1e6,0,0,1000002,2,2&spacing=1&format=usda | format | 21 bits
points?bbox=0,0,0,1,1,1&spacing=1 | bbox | expected 4 numbers, got 6
points?bbox=0,0,1,1&spacing=1&attributes=rotation | attributes | in the plane points have an angle
";

#[test]
fn problems_of_addresses_list_exactly_the_fields_at_fault() {
    let (_fields, daemon) = daemon();
    for row in rows(ADDRESSES) {
        let path = row[0].replace('~', "points?bbox=0,0,9,9&spacing=1");
        let answer = daemon.get(&format!("/v1/{path}"));
        assert_faults(&answer, &path, row[1], &row[2..]);
    }
    // Values are not echoed whole.
    let long = "x".repeat(5000);
    let path = format!("/v1/points?bbox=0,0,9,9&spacing=1&profile={long}&{long}=1");
    let answer = daemon.get(&path);
    assert_eq!(answer.status, 400);
    assert!(answer.body.len() < 2500, "{}", answer.body.len());
}

#[test]
fn an_unacceptable_accept_header_gets_the_list_of_formats() {
    let daemon = Daemon::start(&[]);
    for accept in [
        "text/html",
        "application/xml",
        "nonsense",
        "application/json;q=0",
    ] {
        let path = "/v1/points?bbox=0,0,10,10&density=1";
        let answer = http1::get(daemon.address(), path, &[("accept", accept)]);
        assert_eq!(answer.status, 406, "{accept}");
        assert_eq!(answer.header("content-type"), "application/problem+json");
        for text in [accept, "application/vnd.strew.f32", "text/csv"] {
            assert!(answer.text().contains(text), "{accept}: {}", answer.text());
        }
    }
}
