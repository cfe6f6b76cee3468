//! The attributes of points as columns of an answer.

use std::f64::consts::TAU;

use strew_core::{Attribute, Attributes, Column, space};
use strew_encode as encode;
use strew_encode::{Bound, Located, POSE_ROTATION, Values};

#[derive(Clone, Debug)]
pub struct PointAttributes {
    columns: Vec<encode::Column>,
    bound: Bound,
}

impl PointAttributes {
    /// The columns of `list`, of which `bound` was made.
    pub fn new(list: &Attributes, bound: Bound) -> Self {
        let number = |name: &str, attribute: &Attribute| encode::Column {
            range: range(attribute),
            ..encode::Column::number(name)
        };
        let columns = |attribute: &Attribute| match (attribute, attribute.variants()) {
            (Attribute::Rotation, _) => POSE_ROTATION.map(|name| number(name, attribute)).into(),
            (_, Some(variants)) => {
                let names: Vec<String> = variants.names().map(Into::into).collect();
                vec![encode::Column::dictionary(attribute.name(), names)]
            }
            (_, None) => vec![number(attribute.name(), attribute)],
        };
        Self {
            columns: list.as_slice().iter().flat_map(columns).collect(),
            bound,
        }
    }
}

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
        Attribute::Rotation => Some([-1.0, 1.0]),
        _ => None,
    }
}

impl encode::Attributes for PointAttributes {
    fn columns(&self) -> Vec<encode::Column> {
        self.columns.clone()
    }

    fn fill(&self, places: Located<'_>, values: &mut [Values]) {
        let mut made: Vec<Column> = vec![];
        match &self.bound {
            Bound::Plane(bound) => bound.write_points(places.points, &mut made),
            Bound::Space(bound) => {
                let points: Vec<space::Point> = places.in_space().collect();
                bound.write_points(&points, &mut made);
            }
        }
        for (values, column) in values.iter_mut().zip(made) {
            *values = match column {
                Column::Numbers(numbers) => Values::Numbers(numbers),
                Column::Variants(indices) => Values::Indices(indices),
            };
        }
    }
}
