//! The attributes of points as columns of an answer.

use std::f64::consts::TAU;

use strew_core::{Attribute, Attributes, BoundAttributes, Column, Point};
use strew_encode as encode;
use strew_encode::Values;

/// Attributes bound to the points of one set.
#[derive(Clone, Debug)]
pub struct PointAttributes {
    columns: Vec<encode::Column>,
    bound: BoundAttributes,
}

impl PointAttributes {
    /// The columns of `list`, of which `bound` was made.
    #[must_use]
    pub fn new(list: &Attributes, bound: BoundAttributes) -> Self {
        let column = |attribute: &Attribute| match attribute.variants() {
            Some(variants) => {
                let names: Vec<String> = variants.names().map(Into::into).collect();
                encode::Column::dictionary(attribute.name(), names)
            }
            None => encode::Column {
                range: range(attribute),
                ..encode::Column::number(attribute.name())
            },
        };
        Self {
            columns: list.as_slice().iter().map(column).collect(),
            bound,
        }
    }
}

/// The bounds of an attribute's numbers, where they are known.
fn range(attribute: &Attribute) -> Option<[f64; 2]> {
    match attribute {
        Attribute::Angle => Some([0.0, TAU]),
        Attribute::Scale(range) => Some([range.min(), range.max()]),
        Attribute::VariantScale(scales) => {
            let ranges = scales.ranges().iter();
            let ranges = ranges.map(|range| [range.min(), range.max()]);
            ranges.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
        }
        Attribute::Rank | Attribute::Uniform(_) => Some([0.0, 1.0]),
        _ => None,
    }
}

impl encode::Attributes for PointAttributes {
    fn columns(&self) -> Vec<encode::Column> {
        self.columns.clone()
    }

    fn fill(&self, points: &[Point], values: &mut [Values]) {
        let mut made: Vec<Column> = vec![];
        self.bound.write_points(points, &mut made);
        for (values, column) in values.iter_mut().zip(made) {
            *values = match column {
                Column::Numbers(numbers) => Values::Numbers(numbers),
                Column::Variants(indices) => Values::Indices(indices),
            };
        }
    }
}
