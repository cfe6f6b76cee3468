//! The cost of a look at a field, counted without a clock.

use super::{FieldSpec, spec::Shape};
use crate::shape::Region;

/// A look at one octave of noise, in nanoseconds.
const OCTAVE: f64 = 20.0;
/// At a pixel and those beside it.
const PIXELS: f64 = 15.0;
/// At a node of a tree of sides, or at a side.
const SIDE: f64 = 3.0;
/// At a shape, whatever it is.
const SHAPE: f64 = 5.0;
/// Places of a region that stand for all of it, along each axis.
const PLACES: u32 = 4;

impl FieldSpec {
    /// About the nanoseconds that a look at a place takes on a processor of some years ago: the mean over a few
    /// places of a region. It depends on nothing else, so it is the same on every machine.
    pub(crate) fn nanoseconds(&self, within: Region) -> f64 {
        let (min, max) = (within.min(), within.max());
        // Off the middles of even parts, where shapes that are symmetric are special.
        let along = |i: usize, k: u32| {
            let t = (f64::from(k) + 0.37) / f64::from(PLACES);
            min[i] + (max[i] - min[i]) * t
        };
        let places = (0..PLACES).flat_map(|x| (0..PLACES).map(move |y| [x, y]));
        let sum: f64 = places
            .map(|[x, y]| self.nanoseconds_at([along(0, x), along(1, y)]))
            .sum();
        sum / f64::from(PLACES * PLACES)
    }

    fn nanoseconds_at(&self, at: [f64; 2]) -> f64 {
        let all = |parts: &[Self]| parts.iter().map(|part| part.nanoseconds_at(at)).sum();
        SHAPE
            + match &*self.shape {
                Shape::Constant(_) | Shape::Ramp { .. } | Shape::Radial { .. } => 0.0,
                Shape::Distance(measure, _) => SIDE * measure.looks(at) as f64,
                Shape::Noise(noise) => OCTAVE * f64::from(noise.octaves),
                Shape::Raster(_) | Shape::Terrain(..) => PIXELS,
                Shape::Multiply(parts) | Shape::Min(parts) | Shape::Max(parts) => all(parts),
                Shape::Invert(part) | Shape::Curve(part, _) => part.nanoseconds_at(at),
            }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;
    use crate::field::{Marks, Noise};

    #[test]
    fn a_look_costs_what_it_looks_at() {
        let view = Region::new([0.0, 0.0], [100.0, 100.0]).expect("a box");
        let noise = |octaves| {
            let noise = Noise {
                seed: 1,
                wavelength: 9.0,
                octaves,
                range: [0.0, 1.0],
            };
            FieldSpec::noise(noise).expect("valid")
        };
        let look = |spec: &FieldSpec| spec.nanoseconds(view);
        assert!(look(&noise(8)) > 6.0 * look(&noise(1)));
        let many = FieldSpec::multiply(vec![noise(8); 63]).expect("valid");
        assert!(look(&many) > 60.0 * look(&noise(8)));
        // Boxes around sides that all cross the view do not show which is near; those of a street do.
        let line = |place: &dyn Fn(u32) -> [u32; 2]| {
            let line = (0..5000).map(|i| place(i).map(f64::from).map(|v| v * 0.02));
            let marks = Marks::Lines(vec![line.collect()]);
            FieldSpec::distance(marks, [0.0, 1.0], [0.0, 1.0]).expect("valid")
        };
        let tangled = look(&line(&|i| [i * 1871 % 5003, i * 3571 % 5009]));
        let street = look(&line(&|i| [i, i % 7]));
        assert!(tangled > 20.0 * street, "{tangled} {street}");
    }
}
