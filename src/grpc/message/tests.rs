//! Every limit of the contract, from its descriptors.

use strew_config::Limits;
use strew_error::Error;

use super::{
    most::Most,
    walk::{Cost, Kind, REQUESTS, SHAPES, cost},
};

/// The shape of StreamPointsRequest.
const STREAM: usize = 0;

/// A field of bytes.
fn field(number: u32, bytes: &[u8]) -> Vec<u8> {
    let mut all = vec![];
    prost::encoding::encode_key(number, prost::encoding::WireType::LengthDelimited, &mut all);
    prost::encoding::encode_varint(bytes.len() as u64, &mut all);
    all.extend(bytes);
    all
}

/// The numbers of the fields that lead from a request to each field of the contract, and its limit.
fn paths() -> Vec<(usize, Vec<u32>, Kind, Most)> {
    let mut paths = vec![];
    let mut seen = vec![];
    for request in 0..REQUESTS {
        let mut open = vec![(request, vec![])];
        while let Some((shape, path)) = open.pop() {
            if seen.contains(&shape) {
                continue;
            }
            seen.push(shape);
            for field in SHAPES[shape].fields {
                let path = [&path[..], &[field.number]].concat();
                if let Kind::Message(inner) = field.kind {
                    open.push((inner, path.clone()));
                }
                paths.push((request, path, field.kind, field.most));
            }
        }
    }
    paths
}

fn limits() -> Limits {
    Limits {
        max_vertices: 500,
        ..Limits::default()
    }
}

#[test]
fn every_field_that_is_repeated_and_every_message_that_decoders_join_has_a_limit() {
    let limits = limits();
    for (shape, path, kind, most) in paths() {
        if most.is_once() && !matches!(kind, Kind::Message(_)) {
            continue;
        }
        let (last, outer) = path.split_last().expect("a field");
        let message = |count: usize| {
            let inner = field(*last, b"").repeat(count);
            let wrap = |inner: Vec<u8>, number: &u32| field(*number, &inner);
            outer.iter().rev().fold(inner, wrap)
        };
        let most = most.limit.of(&limits);
        let allowed = cost(shape, &message(most), &limits);
        assert!(allowed.is_ok(), "{path:?}: {allowed:?}");
        let refused = cost(shape, &message(most + 3), &limits);
        let Err(Error::Invalid(faults)) = refused else {
            panic!("{path:?}: {refused:?}");
        };
        let fault = &faults.as_slice()[0];
        let value = fault.value.as_deref().unwrap_or_default();
        assert!(
            value.starts_with(&format!("{} ", most + 3)),
            "{path:?}: {value}"
        );
        assert!(fault.allowed.starts_with("at most"), "{fault}");
    }
}

#[test]
fn lists_of_a_request_are_counted_together_and_parts_by_field() {
    let limits = limits();
    // 64 parts in each of two fields, and 100 in one, in two lists.
    let parts = |count| field(10, &field(1, b"").repeat(count));
    let nested = field(10, &[field(1, &parts(50)), field(1, &parts(50))].concat());
    let set = |fields: &[Vec<u8>]| field(2, &fields.concat());
    let both = set(&[field(15, &parts(64)), field(21, &parts(64))]);
    assert!(cost(STREAM, &both, &limits).is_ok());
    let refused = cost(STREAM, &set(&[field(15, &nested)]), &limits);
    let refused = refused.expect_err("too many").to_string();
    assert!(
        refused.contains("`set.field.multiply.fields[1].multiply.fields`"),
        "{refused}"
    );
    assert!(
        refused.contains("102 parts") && refused.contains("at most 64"),
        "{refused}"
    );
    // Regions in regions.
    let regions = |count| field(5, &field(1, b"").repeat(count));
    let two = field(
        5,
        &[field(1, &regions(600)), field(2, &regions(600))].concat(),
    );
    let refused = cost(STREAM, &field(1, &two), &limits);
    let refused = refused.expect_err("too many").to_string();
    assert!(
        refused.contains("1202 regions") && refused.contains("at most 1000"),
        "{refused}"
    );
    assert!(
        refused.contains("`region.combined.exclude[0].combined.include`"),
        "{refused}"
    );
}

#[test]
fn what_is_no_message_is_refused_and_what_is_unknown_is_skipped() {
    let limits = limits();
    let deep = |levels| {
        let regions = (0..levels).fold(vec![], |inner, _| field(5, &field(1, &inner)));
        field(1, &regions)
    };
    for bytes in [
        &[0xff; 30][..],
        &[0x0a, 5, 0],
        &[0x0d, 0],
        &[0x0e],
        &[0xff; 3],
        &deep(60),
    ] {
        let refused = cost(STREAM, bytes, &limits);
        assert!(
            matches!(refused, Err(Error::Invalid(_))),
            "{bytes:x?}: {refused:?}"
        );
    }
    let unknown = [field(9999, &[0xff; 100]), vec![0x80, 0x7d, 1]].concat();
    let plain = cost(STREAM, b"", &limits).expect("in order");
    assert_eq!(cost(STREAM, &unknown, &limits), Ok(plain));
}

#[test]
fn memory_and_pixels_are_known_beforehand() {
    let limits = limits();
    let layers = cost(STREAM, &field(3, b"").repeat(16), &limits).expect("in order");
    let layer = size_of::<super::super::proto::Layer>();
    assert!(layers.memory >= 16 * layer, "{layers:?}");
    let raster = field(2, &field(15, &field(7, &field(1, &[0; 1000]))));
    let Cost { pixels, .. } = cost(STREAM, &raster, &limits).expect("in order");
    assert_eq!(pixels, 1000);
}
