//! Fields that are described, and so can be kept, compared and named by a digest.

use alloc::{format, sync::Arc, vec::Vec};
use core::array::from_fn;

use super::{
    definition::Canon,
    marks::{Marks, Measure},
    noise::Noise,
    raster::{Raster, Terrain},
    scale::{Slide, check_numbers, check_share},
};
use crate::{
    error::{Error, ErrorKind, number},
    stop::Stop,
    table::Digest,
};

/// The description of a field: a shape, or shapes joined.
///
/// Descriptions are checked when they are made, are cheap to clone, and equal if they have the same
/// [digest](Self::digest). They have the same shares, to the bit, on every machine.
///
/// ```
/// use strew_core::{Field, PointSet, Region, Table, field::{FieldSpec, Marks, Noise}};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let road = Marks::Lines(vec![vec![[0.0, 20.0], [40.0, 25.0]]]);
/// let off_the_road = FieldSpec::distance(road, [3.0, 8.0], [0.0, 1.0])?;
/// let patches = FieldSpec::noise(Noise { seed: 7, wavelength: 20.0, octaves: 3, range: [0.0, 1.0] })?;
/// let forest = FieldSpec::multiply(vec![off_the_road, patches])?;
/// assert_eq!(forest.share([0.0, 21.0]), 0.0);
/// let trees = PointSet::new(table).seed(7).in_field(forest);
/// assert!(trees.count(Region::new([0.0, 0.0], [40.0, 40.0])?)? > 100);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone)]
pub struct FieldSpec {
    pub(super) shape: Arc<Shape>,
    pub(super) digest: Digest,
    pub(super) depth: usize,
    pub(super) parts: usize,
    pub(super) vertices: usize,
    /// Whether pixels of it are missing.
    pub(super) is_partial: bool,
    /// Whether it has places of three numbers.
    pub(super) is_in_space: bool,
}

/// The checked parts of a description.
pub(super) enum Shape {
    Constant(f64),
    Ramp {
        from: [f64; 3],
        /// To the second place, divided by its squared length.
        per: [f64; 3],
        shares: [f64; 2],
    },
    Radial {
        center: [f64; 3],
        /// Whether heights do not matter.
        is_flat: bool,
        slide: Slide,
    },
    Distance(Measure, Slide),
    Noise(Noise),
    Raster(Raster),
    Terrain(Terrain, Slide),
    Multiply(Vec<FieldSpec>),
    Min(Vec<FieldSpec>),
    Max(Vec<FieldSpec>),
    Invert(FieldSpec),
    Curve(FieldSpec, Vec<[f64; 2]>),
}

impl FieldSpec {
    /// The largest number of vertices of a description.
    pub const MAX_VERTICES: usize = 10_000;
    /// The largest number of shapes of a description, those that join others included.
    pub const MAX_PARTS: usize = 64;
    /// The depth to which shapes may lie within others.
    pub const MAX_DEPTH: usize = 16;
    /// The largest number of points of a [curve](Self::curve).
    pub const MAX_CURVE: usize = 256;

    fn new(shape: Shape, canon: Canon, vertices: usize) -> Result<Self, Error> {
        let parts: &[Self] = match &shape {
            Shape::Multiply(parts) | Shape::Min(parts) | Shape::Max(parts) => parts,
            Shape::Invert(part) | Shape::Curve(part, _) => core::slice::from_ref(part),
            _ => &[],
        };
        let is_partial = match &shape {
            Shape::Raster(raster) => raster.grid.is_partial,
            Shape::Terrain(terrain, _) => terrain.grid.is_partial,
            _ => parts.iter().any(|part| part.is_partial),
        };
        let sum = |of: fn(&Self) -> usize| parts.iter().map(of).sum::<usize>();
        let spec = Self {
            digest: canon.finish(),
            depth: 1 + parts.iter().map(|part| part.depth).max().unwrap_or(0),
            parts: 1 + sum(|part| part.parts),
            vertices: vertices + sum(|part| part.vertices),
            is_partial,
            is_in_space: parts.iter().any(|part| part.is_in_space),
            shape: Arc::new(shape),
        };
        for (name, value, most) in [
            ("vertices", spec.vertices, Self::MAX_VERTICES),
            ("parts", spec.parts, Self::MAX_PARTS),
            ("depth", spec.depth, Self::MAX_DEPTH),
        ] {
            if value > most {
                let error = Error::new(ErrorKind::Field, name, value, format!("at most {most}"));
                return Err(error.with_limit(most as f64));
            }
        }
        Ok(spec)
    }

    /// This field of places of some numbers: two or three.
    fn of<const D: usize>(self) -> Self {
        const { assert!(D == 2 || D == 3, "places have two or three numbers") };
        Self {
            is_in_space: D == 3,
            ..self
        }
    }

    /// A field with one share everywhere.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless the share is from 0 to 1.
    pub fn constant(share: f64) -> Result<Self, Error> {
        check_share("share", share)?;
        let mut canon = Canon::new("constant");
        canon.numbers(&[share]);
        Self::new(Shape::Constant(share), canon, 0)
    }

    /// `shares[0]` at one place, `shares[1]` at another, linear between them, constant before and beyond. Places of the
    /// plane make a ramp that is the same at all heights of space.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless the shares are from 0 to 1, the coordinates finite, and the places
    /// apart.
    ///
    /// ```
    /// use strew_core::{Field, field::FieldSpec};
    ///
    /// let ramp = FieldSpec::ramp([0.0, 0.0], [10.0, 0.0], [0.0, 1.0])?;
    /// assert_eq!([-5.0, 2.5, 10.0].map(|x| ramp.share([x, 77.0])), [0.0, 0.25, 1.0]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn ramp<const D: usize>(
        from: [f64; D],
        to: [f64; D],
        shares: [f64; 2],
    ) -> Result<Self, Error> {
        check_numbers("from", &from)?;
        check_numbers("to", &to)?;
        check_share("shares", shares[0])?;
        check_share("shares", shares[1])?;
        let [start, end] = [from, to].map(in_space);
        let way: [f64; 3] = from_fn(|axis| end[axis] - start[axis]);
        let square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
        let per = way.map(|v| v / square);
        if !square.is_normal() || per.iter().any(|v| !v.is_finite()) {
            let value = format!("[{}]", to.map(number).join(", "));
            return Err(Error::new(
                ErrorKind::Field,
                "to",
                value,
                "a place apart from the first",
            ));
        }
        let mut canon = Canon::new("ramp");
        canon.places(&[from, to]);
        canon.numbers(&shares);
        let shape = Shape::Ramp {
            from: start,
            per,
            shares,
        };
        Ok(Self::new(shape, canon, 0)?.of::<D>())
    }

    /// `shares[0]` up to the first radius around a place, `shares[1]` from the second on, linear between. Around a place
    /// of the plane heights of space do not matter.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless the shares are from 0 to 1, the numbers finite, and the radii, from 0 on,
    /// in ascending order.
    ///
    /// ```
    /// use strew_core::{Field, field::FieldSpec};
    ///
    /// let glade = FieldSpec::radial([0.0, 0.0], [5.0, 10.0], [0.0, 1.0])?;
    /// assert_eq!([3.0, 7.5, 20.0].map(|x| glade.share([x, 0.0])), [0.0, 0.5, 1.0]);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn radial<const D: usize>(
        center: [f64; D],
        radii: [f64; 2],
        shares: [f64; 2],
    ) -> Result<Self, Error> {
        check_numbers("center", &center)?;
        let slide = Slide::new("radii", radii, shares)?;
        if radii[0] < 0.0 {
            let (value, allowed) = (number(radii[0]), "numbers from 0 on");
            return Err(Error::new(ErrorKind::Field, "radii", value, allowed));
        }
        let mut canon = Canon::new("radial");
        canon.number(3);
        canon.numbers(&center);
        canon.numbers(&radii);
        canon.numbers(&shares);
        let shape = Shape::Radial {
            center: in_space(center),
            is_flat: D == 2,
            slide,
        };
        Ok(Self::new(shape, canon, 0)?.of::<D>())
    }

    /// A share by the distance to marks: `shares[0]` up to `distances[0]`, `shares[1]` from `distances[1]` on,
    /// linear between. Distances inside of polygons are below 0.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless the shares are from 0 to 1, the numbers finite, the distances in
    /// ascending order, and there are enough vertices and at most [`MAX_VERTICES`](Self::MAX_VERTICES).
    pub fn distance(marks: Marks, distances: [f64; 2], shares: [f64; 2]) -> Result<Self, Error> {
        let vertices = marks.vertices();
        if vertices > Self::MAX_VERTICES {
            let most = Self::MAX_VERTICES;
            let error = Error::new(
                ErrorKind::Field,
                "vertices",
                vertices,
                format!("at most {most}"),
            );
            return Err(error.with_limit(most as f64));
        }
        marks.check()?;
        let slide = Slide::new("distances", distances, shares)?;
        let mut canon = Canon::new("distance");
        marks.describe(&mut canon);
        canon.places(&[distances, shares]);
        Self::new(
            Shape::Distance(Measure::new(&marks), slide),
            canon,
            vertices,
        )
    }

    /// Natural patches.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless the wavelength is from 10⁻¹⁰⁰ to 10¹⁰⁰, the octaves from 1 to 8, and the
    /// ends of the range from 0 to 1.
    pub fn noise(noise: Noise) -> Result<Self, Error> {
        noise.check()?;
        let mut canon = Canon::new("noise");
        noise.describe(&mut canon);
        Self::new(Shape::Noise(noise), canon, 0)
    }

    /// The shares of pixels.
    ///
    /// # Errors
    /// None yet.
    pub fn raster(raster: Raster) -> Result<Self, Error> {
        let mut canon = Canon::new("field of a raster");
        canon.digest(raster.digest());
        Self::new(Shape::Raster(raster), canon, 0)
    }

    /// A share by height: `shares[0]` up to `heights[0]`, `shares[1]` from `heights[1]` on, linear between.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless the shares are from 0 to 1 and the heights in ascending order.
    pub fn height(terrain: Terrain, heights: [f64; 2], shares: [f64; 2]) -> Result<Self, Error> {
        let slide = Slide::new("heights", heights, shares)?;
        let mut canon = Canon::new("height");
        canon.digest(terrain.digest());
        canon.places(&[heights, shares]);
        Self::new(Shape::Terrain(terrain, slide), canon, 0)
    }

    /// A share by slope, rise over run: `shares[0]` up to `slopes[0]`, `shares[1]` from `slopes[1]` on, linear
    /// between. Takes 4 bytes and some time a pixel, so keep the description.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless the shares are from 0 to 1 and the slopes in ascending order.
    pub fn slope(terrain: Terrain, slopes: [f64; 2], shares: [f64; 2]) -> Result<Self, Error> {
        Self::slope_unless(terrain, [slopes, shares], &Stop::default())
    }

    /// As [`slope`](Self::slope), unless stopped.
    pub(crate) fn slope_unless(
        terrain: Terrain,
        [slopes, shares]: [[f64; 2]; 2],
        stop: &Stop,
    ) -> Result<Self, Error> {
        let slide = Slide::new("slopes", slopes, shares)?;
        let mut canon = Canon::new("slope");
        canon.digest(terrain.digest());
        canon.places(&[slopes, shares]);
        Self::new(Shape::Terrain(terrain.steepness(stop)?, slide), canon, 0)
    }

    /// The product of fields.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] without a field, and beyond [`MAX_PARTS`](Self::MAX_PARTS),
    /// [`MAX_DEPTH`](Self::MAX_DEPTH) and [`MAX_VERTICES`](Self::MAX_VERTICES).
    pub fn multiply(parts: Vec<Self>) -> Result<Self, Error> {
        let canon = joined("multiply", &parts)?;
        Self::new(Shape::Multiply(parts), canon, 0)
    }

    /// The least of fields.
    ///
    /// # Errors
    /// As [`multiply`](Self::multiply).
    pub fn min(parts: Vec<Self>) -> Result<Self, Error> {
        let canon = joined("min", &parts)?;
        Self::new(Shape::Min(parts), canon, 0)
    }

    /// The greatest of fields.
    ///
    /// # Errors
    /// As [`multiply`](Self::multiply).
    pub fn max(parts: Vec<Self>) -> Result<Self, Error> {
        let canon = joined("max", &parts)?;
        Self::new(Shape::Max(parts), canon, 0)
    }

    /// The complement of a field: 1 − its share.
    ///
    /// # Errors
    /// As [`multiply`](Self::multiply).
    pub fn invert(self) -> Result<Self, Error> {
        let canon = joined("invert", core::slice::from_ref(&self))?;
        Self::new(Shape::Invert(self), canon, 0)
    }

    /// The share of a field, mapped by a curve: linear between points [share, share then], constant before
    /// the first and beyond the last.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless there are 2 to [`MAX_CURVE`](Self::MAX_CURVE) points of numbers from 0 to
    /// 1, in ascending order of the first; and as [`multiply`](Self::multiply).
    ///
    /// ```
    /// use strew_core::{Field, field::FieldSpec};
    ///
    /// let peak = vec![[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]];
    /// assert_eq!(FieldSpec::constant(0.25)?.curve(peak)?.share([0.0, 0.0]), 0.5);
    /// let error = FieldSpec::constant(0.25)?.curve(vec![[0.5, 0.0], [0.5, 1.0]]).unwrap_err();
    /// assert_eq!(error.field(), "curve");
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn curve(self, points: Vec<[f64; 2]>) -> Result<Self, Error> {
        let refused = |value, allowed| Err(Error::new(ErrorKind::Field, "curve", value, allowed));
        if !(2..=Self::MAX_CURVE).contains(&points.len()) {
            let allowed = format!("2 to {} points", Self::MAX_CURVE);
            return refused(format!("{} points", points.len()), allowed);
        }
        for v in points.as_flattened() {
            check_share("curve", *v)?;
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[0][0] >= pair[1][0]) {
            let value = format!("{} before {}", number(pair[0][0]), number(pair[1][0]));
            return refused(value, "in ascending order".into());
        }
        let mut canon = joined("curve", core::slice::from_ref(&self))?;
        canon.places(&points);
        Self::new(Shape::Curve(self, points), canon, 0)
    }
}

/// A place of the plane at height 0, or one of space.
pub(super) fn in_space<const D: usize>(at: [f64; D]) -> [f64; 3] {
    from_fn(|axis| at.get(axis).copied().unwrap_or(0.0))
}

/// The encoding of a field made of others.
fn joined(kind: &'static str, parts: &[FieldSpec]) -> Result<Canon, Error> {
    if parts.is_empty() {
        return Err(Error::new(
            ErrorKind::Field,
            kind,
            "empty",
            "at least one field",
        ));
    }
    let mut canon = Canon::new(kind);
    canon.number(parts.len() as u64);
    parts.iter().for_each(|part| canon.digest(part.digest));
    Ok(canon)
}
