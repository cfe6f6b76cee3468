//! How a thing stands at a point: its height, rotation and size, for formats that place things.
//!
//! The columns say it: `z` is the height, `angle` a turn around the vertical (counterclockwise, in radians),
//! `qx`, `qy`, `qz` and `qw` a whole rotation, `scale` the size, `variant` or else `layer` which thing it is.

use super::{
    rows::Row,
    schema::{Column, Kind, LAYER, Schema, Z},
};

/// A rotation as a quaternion, which an angle is part of.
pub const ROTATION: [&str; 4] = ["qx", "qy", "qz", "qw"];
const ANGLE: &str = "angle";
const SCALE: &str = "scale";
const VARIANT: &str = "variant";

/// The columns that pose things. A row that lacks a value is at height 0, upright, and of size 1.
#[derive(Clone, Debug)]
pub(super) struct Pose {
    z: Option<usize>,
    rotation: Option<[usize; 4]>,
    angle: Option<usize>,
    scale: Option<usize>,
    /// The index of the column with a point's variant.
    pub(super) variant: Option<usize>,
    /// The index of the column with a point's layer.
    pub(super) layer: Option<usize>,
    /// The columns of numbers that are not part of the pose.
    pub(super) others: Vec<usize>,
}

impl Pose {
    pub(super) fn new(schema: &Schema) -> Self {
        let columns = schema.columns();
        let is_names = |column: &Column| matches!(column.kind, Kind::Dictionary(_));
        let place = |name: &str, of_names: bool| {
            let fits = |column: &Column| column.name == name && is_names(column) == of_names;
            columns.iter().position(fits)
        };
        let number = |name| place(name, false);
        let rotation = match ROTATION.map(number) {
            [Some(x), Some(y), Some(z), Some(w)] => Some([x, y, z, w]),
            _ => None,
        };
        let mut pose = Self {
            z: number(Z),
            rotation,
            angle: number(ANGLE),
            scale: number(SCALE),
            variant: place(VARIANT, true),
            layer: place(LAYER, true),
            others: vec![],
        };
        let is_other = |i: &usize| !pose.uses(*i) && !is_names(&columns[*i]);
        pose.others = (0..columns.len()).filter(is_other).collect();
        pose
    }

    fn uses(&self, column: usize) -> bool {
        let rotation = self.rotation.iter().flatten();
        let all = [self.z, self.angle, self.scale];
        all.iter()
            .flatten()
            .chain(rotation)
            .any(|used| *used == column)
    }

    /// Whether things are turned at all.
    pub(super) const fn is_turned(&self) -> bool {
        self.angle.is_some() || self.rotation.is_some()
    }

    /// Whether they have rotations that are no turns around the vertical.
    pub(super) const fn is_tilted(&self) -> bool {
        self.rotation.is_some()
    }

    /// Whether they have sizes.
    pub(super) const fn is_scaled(&self) -> bool {
        self.scale.is_some()
    }

    /// The range of a column of numbers: that of `z`, of angles, or of sizes.
    pub(super) fn ranges(&self, schema: &Schema) -> [[f64; 2]; 3] {
        let range = |column: Option<usize>, missing: f64| {
            let column = column.and_then(|column| schema.columns().get(column));
            let [low, high] = column.and_then(|c| c.range).unwrap_or([missing; 2]);
            // Where a layer has no such value, its points have the usual one.
            match column {
                Some(column) if column.optional => [low.min(missing), high.max(missing)],
                _ => [low, high],
            }
        };
        [
            range(self.z, 0.0),
            range(self.angle, 0.0),
            range(self.scale, 1.0),
        ]
    }

    /// The height.
    pub(super) fn z(&self, row: Row<'_>) -> f64 {
        number(row, self.z).unwrap_or(0.0)
    }

    /// The turn around the vertical.
    pub(super) fn angle(&self, row: Row<'_>) -> f64 {
        number(row, self.angle).unwrap_or(0.0)
    }

    /// The size.
    pub(super) fn scale(&self, row: Row<'_>) -> f64 {
        number(row, self.scale).unwrap_or(1.0)
    }

    /// The rotation as a quaternion x, y, z, w; z is up.
    pub(super) fn rotation(&self, row: Row<'_>) -> [f64; 4] {
        if let Some(columns) = self.rotation
            && let [Some(x), Some(y), Some(z), Some(w)] =
                columns.map(|column| number(row, Some(column)))
        {
            return [x, y, z, w];
        }
        match number(row, self.angle) {
            Some(angle) => {
                let (sine, cosine) = libm::sincos(0.5 * angle);
                [0.0, 0.0, sine, cosine]
            }
            None => [0.0, 0.0, 0.0, 1.0],
        }
    }
}

fn number(row: Row<'_>, column: Option<usize>) -> Option<f64> {
    row.columns.get(column?)?.number(row.index)
}

/// A quaternion or place whose z is up, where y is to be up instead and z points to the viewer: the frame of
/// glTF and of engines.
pub(super) fn y_up<const N: usize>(mut v: [f64; N]) -> [f64; N] {
    v.swap(1, 2);
    v[2] = -v[2];
    v
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, TAU};

    use super::*;
    use crate::Values;
    use strew_core::Point;

    #[test]
    fn an_angle_turns_around_the_vertical() {
        let schema = Schema::joined(&[(
            None,
            vec![
                Column::number("rank"),
                Column::number("angle").within([0.0, TAU]),
            ],
        )]);
        let pose = Pose::new(&schema);
        assert_eq!(pose.others, [0]);
        assert_eq!(pose.ranges(&schema), [[0.0; 2], [0.0, TAU], [1.0; 2]]);
        let row = |values: &[Values]| {
            let row = Row {
                point: &Point::default(),
                height: None,
                index: 0,
                columns: values,
            };
            (pose.rotation(row), pose.scale(row), pose.z(row))
        };
        let half = 0.5f64.sqrt();
        let (rotation, ..) = row(&[Values::Missing, Values::Numbers(vec![FRAC_PI_2])]);
        assert!((rotation[2] - half).abs() < 1e-15 && (rotation[3] - half).abs() < 1e-15);
        assert_eq!(y_up(rotation)[1], rotation[2]);
        let upright = ([0.0, 0.0, 0.0, 1.0], 1.0, 0.0);
        assert_eq!(row(&[Values::Missing, Values::Missing]), upright);
        assert_eq!(y_up([1.0, 2.0, 3.0]), [1.0, 3.0, -2.0]);
    }
}
