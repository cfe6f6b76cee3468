//! Points that stand on a terrain: heights, normals and rotations as columns beside those of attributes.
//!
//! All are functions of the place alone: `z` is low + share × (high − low), with the share of the terrain's field
//! there. The normal follows from the heights half a spacing to the left, the right, below and above, so things
//! feel the ground about as far as their neighbors stand. A rotation is the turn by `angle`, then the shortest one
//! that tilts the vertical the requested part of the way to the normal. Only `libm` is used, so that the bits are the
//! same everywhere.

use std::sync::Arc;

use strew_core::field::Field as _;
use strew_encode as encode;
use strew_encode::{Column, Located, POSE_ROTATION, POSE_Z, Values};
use strew_query::Terrain;

#[derive(Debug)]
pub struct OnTerrain {
    attributes: Option<Arc<dyn encode::Attributes>>,
    angle: Option<usize>,
    ground: Ground,
}

impl OnTerrain {
    pub fn new(
        attributes: Option<Arc<dyn encode::Attributes>>,
        terrain: Terrain,
        spacing: f64,
    ) -> Self {
        let columns = attributes.iter().flat_map(|own| own.columns());
        Self {
            angle: columns
                .zip(0..)
                .find_map(|(column, i)| (column.name == ANGLE).then_some(i)),
            attributes,
            ground: Ground::new(terrain, spacing),
        }
    }
}

#[derive(Clone, Debug)]
pub struct Ground {
    terrain: Terrain,
    /// How far around a point its slope is looked at.
    reach: f64,
}

pub const ANGLE: &str = "angle";

const NORMAL: [&str; 3] = ["nx", "ny", "nz"];

impl Ground {
    pub const fn new(terrain: Terrain, spacing: f64) -> Self {
        Self {
            terrain,
            reach: 0.5 * spacing,
        }
    }

    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        let normal = NORMAL.into_iter().filter(|_| self.terrain.has_normals);
        let rotation = POSE_ROTATION.into_iter();
        let rotation = rotation.filter(|_| self.terrain.align.is_some());
        [POSE_Z].into_iter().chain(normal).chain(rotation)
    }

    /// The values at a point that is turned by an angle, in the order of their names.
    pub fn values(&self, at: [f64; 2], angle: f64) -> impl Iterator<Item = f64> {
        let is_sloped = self.terrain.has_normals || self.terrain.align.is_some();
        let normal = if is_sloped { self.normal(at) } else { [0.0; 3] };
        let rotation = self
            .terrain
            .align
            .map(|align| rotation(normal, align, angle));
        let normal = normal.into_iter().filter(|_| self.terrain.has_normals);
        [self.height(at)]
            .into_iter()
            .chain(normal)
            .chain(rotation.into_iter().flatten())
    }

    fn height(&self, at: [f64; 2]) -> f64 {
        let [low, high] = self.terrain.heights;
        low + self.terrain.field.spec.share(at) * (high - low)
    }

    /// The unit vector that is upright on the ground.
    fn normal(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        let reach = self.reach;
        // The point itself stands for a place without a height.
        let from = |at: [f64; 2]| match self.terrain.field.spec.is_missing(at) {
            true => (self.height([x, y]), 0.0),
            false => (self.height(at), reach),
        };
        let slope = |before: [f64; 2], after: [f64; 2]| {
            let ((low, back), (high, ahead)) = (from(before), from(after));
            match back + ahead {
                0.0 => 0.0,
                run => (high - low) / run,
            }
        };
        let slope_x = slope([x - reach, y], [x + reach, y]);
        let slope_y = slope([x, y - reach], [x, y + reach]);
        let length = libm::sqrt(slope_x * slope_x + slope_y * slope_y + 1.0);
        [-slope_x / length, -slope_y / length, 1.0 / length]
    }
}

/// The turn by an angle, then the tilt a part of the way from the vertical to a normal.
fn rotation([x, y, z]: [f64; 3], align: f64, angle: f64) -> [f64; 4] {
    let (turn_z, turn_w) = libm::sincos(0.5 * angle);
    let across = libm::sqrt(x * x + y * y);
    if across == 0.0 {
        return [0.0, 0.0, turn_z, turn_w];
    }
    let (sine, tilt_w) = libm::sincos(0.5 * align * libm::atan2(across, z));
    // The axis lies flat, a quarter of a turn ahead of the normal.
    let (tilt_x, tilt_y) = (-y / across * sine, x / across * sine);
    [
        tilt_x * turn_w + tilt_y * turn_z,
        tilt_y * turn_w - tilt_x * turn_z,
        tilt_w * turn_z,
        tilt_w * turn_w,
    ]
}

impl encode::Attributes for OnTerrain {
    fn columns(&self) -> Vec<Column> {
        let own = self.attributes.as_ref().map(|own| own.columns());
        let added = self.ground.names().map(|name| match name {
            POSE_Z => Column::number(name).within(self.ground.terrain.heights),
            name => Column::number(name).within([-1.0, 1.0]),
        });
        own.into_iter().flatten().chain(added).collect()
    }

    fn fill(&self, places: Located<'_>, values: &mut [Values]) {
        let added = self.ground.names().count();
        let (own, ground) = values.split_at_mut(values.len() - added);
        if let Some(attributes) = &self.attributes {
            attributes.fill(places, own);
        }
        let angles = self.angle.and_then(|i| own.get(i));
        for (i, point) in places.points.iter().enumerate() {
            let angle = angles.and_then(|angles| angles.number(i)).unwrap_or(0.0);
            let made = self.ground.values([point.x, point.y], angle);
            for (values, number) in ground.iter_mut().zip(made) {
                if let Values::Numbers(values) = values {
                    values.push(number);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned([x, y, z, w]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ]
        };
        let u = [x, y, z];
        let once = cross(u, v).map(|c| 2.0 * c);
        let twice = cross(u, once);
        [0, 1, 2].map(|i| v[i] + w * once[i] + twice[i])
    }

    #[test]
    fn a_rotation_turns_first_and_tilts_a_part_of_the_way() {
        let length = (0.3f64 * 0.3 + 0.4 * 0.4 + 1.0).sqrt();
        let normal = [0.3 / length, -0.4 / length, 1.0 / length];
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 1e-14);
        for angle in [0.0, 1.0, 5.0] {
            let whole = rotation(normal, 1.0, angle);
            assert!(near(turned(whole, [0.0, 0.0, 1.0]), normal), "{angle}");
            let none = rotation(normal, 0.0, angle);
            assert!(near(
                turned(none, [1.0, 0.0, 0.0]),
                [angle.cos(), angle.sin(), 0.0]
            ));
            let half = turned(rotation(normal, 0.5, angle), [0.0, 0.0, 1.0]);
            let expected = (normal[2].acos() / 2.0).cos();
            assert!((half[2] - expected).abs() < 1e-14);
        }
        assert_eq!(rotation([0.0, 0.0, 1.0], 1.0, 0.0), [0.0, 0.0, 0.0, 1.0]);
    }
}
