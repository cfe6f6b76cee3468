//! Rows for tests: two layers with attributes of every kind, and their answers.

use std::sync::Arc;

use bytes::Bytes;
use strew_core::{Point, PointSet, Region};
use strew_error::integer::Long;

use crate::{
    Answer, Attributes, Column, Head, Json, Located, Output, Part, Source, Tables, Values,
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

    fn fill(&self, places: Located<'_>, values: &mut [Values]) {
        let points = places.points;
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

/// The planned points of a box.
pub(super) fn plan(
    [min_x, min_y, max_x, max_y]: [f64; 4],
    spacing: f64,
    seed: u64,
) -> Arc<dyn Source> {
    let region = Region::new([min_x, min_y], [max_x, max_y]).expect("a box");
    let points = PointSet::blue().spacing(spacing).expect("in range");
    Arc::new(points.seed(seed).within(region).expect("near"))
}

/// The points of a box as the one part of an answer.
pub(super) fn part(bbox: [f64; 4], spacing: f64, seed: u64) -> Vec<Part> {
    vec![Part {
        plan: plan(bbox, spacing, seed),
        layer: None,
        attributes: None,
    }]
}

/// The head of an answer with this number of points.
pub(super) fn head(count: u128) -> Head {
    Head {
        query: Json::of(&serde_json::json!({ "bbox": [-10.0, 5.0, 30.0, 40.5] })),
        tables: Tables::Table(Json::of(&serde_json::json!({ "profile": "blue" }))),
        count: Long(count),
        next: None,
        crs: None,
    }
}

/// The whole answer of both layers, and its announced size.
pub(super) fn answer(output: &Output, block_bytes: usize) -> (Vec<u8>, Option<u64>) {
    let answer = Answer::new(parts(), head, output, block_bytes).expect("an answer");
    let size = answer.size();
    let blocks: Result<Vec<Bytes>, _> = answer.collect();
    (blocks.expect("whole").concat(), size)
}

/// Trees with an angle and a variant, rocks with a variant only, of which one name is a tree's and
/// one needs quotes.
pub(super) fn parts() -> Vec<Part> {
    let layer = |name: &str, plan, marks| Part {
        plan,
        layer: Some(name.into()),
        attributes: Some(Arc::new(marks)),
    };
    let bbox = [-10.0, 5.0, 30.0, 40.5];
    vec![
        layer(
            "trees",
            plan(bbox, 1.0, 1),
            Marks {
                names: &["oak", "birch"],
                has_angle: true,
            },
        ),
        layer(
            "rocks",
            plan([-10.0, 7.0, 30.0, 40.5], 2.0, 2),
            Marks {
                names: &["grey, \"old\"", "oak", "flint"],
                has_angle: false,
            },
        ),
    ]
}
