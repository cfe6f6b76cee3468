//! Rows for tests: two layers with attributes of every kind, and their answers.

use std::sync::{Arc, LazyLock};

use bytes::Bytes;
use strew_core::Point;

use super::{
    Answer, Attributes, Output, Part,
    schema::{Column, Values},
};
use crate::service::{
    Catalog, Draft, Limits, Planned,
    query::{self, RegionDraft, ShapeDraft, Value, groups, parameters},
};

/// An angle for every point and a name out of a list; the angle is half the id's column.
#[derive(Debug)]
struct Marks {
    names: &'static [&'static str],
    has_angle: bool,
}

impl Attributes for Marks {
    fn columns(&self) -> Vec<Column> {
        let names: Vec<String> = self.names.iter().map(|name| (*name).into()).collect();
        let mut columns = vec![Column::dictionary("variant", names)];
        if self.has_angle {
            columns.insert(0, Column::number("angle"));
        }
        columns
    }

    fn fill(&self, points: &[Point], values: &mut [Values]) {
        for values in values {
            match values {
                Values::Numbers(angles) => {
                    angles.extend(points.iter().map(|point| point.id.x as f64 / 2.0));
                }
                Values::Indices(indices) => {
                    let names = self.names.len() as i64;
                    let index = |point: &Point| point.id.y.rem_euclid(names) as u32;
                    indices.extend(points.iter().map(index));
                }
                Values::Missing => {}
            }
        }
    }
}

/// A planned query of the embedded tables.
pub(super) fn planned(bbox: [f64; 4], spacing: f64, seed: u64) -> Planned {
    static CATALOG: LazyLock<Catalog> =
        LazyLock::new(|| Catalog::load(true, None).expect("embedded tables"));
    let mut values = query::Values::new(groups::QUERY, "");
    values.add_value(&parameters::SPACING, Value::Number(spacing));
    values.add_value(&parameters::SEED, Value::Integer(seed));
    let draft = Draft::new(values).within(Ok(RegionDraft {
        path: "bbox".into(),
        shape: ShapeDraft::Box(bbox),
    }));
    let (query, _) = draft.check(&CATALOG, 100).expect("a query");
    let limits = Limits {
        max_points: 1_000_000,
        max_rows: 1_000_000,
        max_vertices: 100,
        max_body_bytes: 1 << 20,
        max_requests: 1,
        max_bytes_in_flight: 1 << 30,
        max_streams: 1,
        block_bytes: 4096,
        cache_bytes: 0,
    };
    Planned::at_once(query, &limits).expect("a plan")
}

/// The whole answer of both layers, and its size as said before.
pub(super) fn answer(output: &Output, block_bytes: usize) -> (Vec<u8>, Option<u64>) {
    let planned = planned([-10.0, 5.0, 30.0, 40.5], 1.0, 1);
    let answer = Answer::of_parts(&planned, parts(), output, block_bytes).expect("an answer");
    let size = answer.size();
    let blocks: Result<Vec<Bytes>, _> = answer.collect();
    (blocks.expect("whole").concat(), size)
}

/// Trees with an angle and a variant, rocks with a variant only, of which one name is a tree's and
/// one needs quotes.
pub(super) fn parts() -> Vec<Part> {
    let part = |layer: &str, plan, marks| Part {
        plan,
        layer: Some(layer.into()),
        attributes: Some(Arc::new(marks)),
    };
    let bbox = [-10.0, 5.0, 30.0, 40.5];
    vec![
        part(
            "trees",
            planned(bbox, 1.0, 1).sets[0].plan.clone(),
            Marks {
                names: &["oak", "birch"],
                has_angle: true,
            },
        ),
        part(
            "rocks",
            planned([-10.0, 7.0, 30.0, 40.5], 2.0, 2).sets[0]
                .plan
                .clone(),
            Marks {
                names: &["grey, \"old\"", "oak", "flint"],
                has_angle: false,
            },
        ),
    ]
}
