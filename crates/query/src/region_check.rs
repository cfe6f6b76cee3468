//! Checking regions: shapes become areas of the plane or volumes of space.

use std::borrow::Cow;

use serde_json::Value as Json;
use strew_core::{
    Area, Circle, ErrorKind, Polygon, Region, Spacing,
    space::{self, Ball, Prism, Volume},
};
use strew_encode::Place;
use strew_error::{Checked, Error, Fault, Faults, Together as _, faults::all, number};

use super::{
    lists::listed,
    parameters::{BBOX, CIRCLE, POLYGON},
    region::{RegionDraft, Rings, ShapeDraft, around, surfaces},
    space::{BALL, BOX},
};

const CHUNK: &str =
    "a size above 0 and two integers within ±4503599627370496, the chunk's column and row";
const CUBE: &str = "a size above 0 and three integers within ±4503599627370496, the chunk's place along x, y and z";
pub(super) const PRISM: &str =
    "a polygon (GeoJSON) between two heights, finite numbers with bottom below top";
/// The forms of a region.
pub(super) const REGION: &str =
    "one of bbox, circle, polygon (GeoJSON), chunk, or include with exclude";
pub(super) const VOLUME: &str = "one of bbox, ball, prism, chunk, or include with exclude";

/// A checked region.
#[derive(Clone, Debug, PartialEq)]
pub struct QueryRegion {
    /// The field it came from.
    pub path: Cow<'static, str>,
    /// The area; it has a box around it, which is not empty. Of a volume, the shadow along z.
    pub area: Area,
    /// That box.
    pub bounds: Region,
    /// The volume, for points in space.
    pub volume: Option<QueryVolume>,
    /// As answers echo it, unless it is just that box.
    pub echo: Option<Json>,
    /// The corner that answers are relative to, for a chunk.
    pub corner: Option<Place>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct QueryVolume {
    /// The volume; it has a box around it, which is not empty.
    pub volume: Volume,
    pub bounds: space::Region,
}

impl QueryRegion {
    /// The lower corner of the box around it, and the upper one; in the plane the third coordinates are 0.
    fn ends(&self) -> [[f64; 3]; 2] {
        match &self.volume {
            Some(volume) => [volume.bounds.min(), volume.bounds.max()],
            None => [self.bounds.min(), self.bounds.max()].map(|[x, y]| [x, y, 0.0]),
        }
    }

    /// The coordinates of the box around it: the lower corner, then the upper one.
    pub fn corners(&self) -> Vec<f64> {
        let (axes, [min, max]) = (2 + usize::from(self.volume.is_some()), self.ends());
        [&min[..axes], &max[..axes]].concat()
    }

    fn sides(&self) -> impl Iterator<Item = f64> {
        let (axes, [min, max]) = (2 + usize::from(self.volume.is_some()), self.ends());
        (0..axes).map(move |axis| max[axis] - min[axis])
    }

    /// The area of the box around it, or in space its volume.
    pub fn measure(&self) -> f64 {
        self.sides().product()
    }

    /// min x, min y, max x, max y of the box around it.
    pub fn bbox(&self) -> [f64; 4] {
        let ([min_x, min_y], [max_x, max_y]) = (self.bounds.min(), self.bounds.max());
        [min_x, min_y, max_x, max_y]
    }

    /// The largest absolute coordinate of an answer, which a chunk's are not far from.
    pub fn reach(&self) -> f64 {
        match self.corner {
            Some(_) => self.sides().map(f64::abs).fold(0.0, f64::max),
            None => (self.ends().into_iter().flatten().map(f64::abs)).fold(0.0, f64::max),
        }
    }

    /// The area that lies in both regions.
    pub fn and(&self, own: &Self) -> Area {
        own.area.clone().and(self.area.clone())
    }
}

impl QueryVolume {
    /// The volume of the box around it, in mean spacings cubed.
    pub fn spacings(&self, spacing: f64) -> f64 {
        let ends = self.bounds.min().into_iter().zip(self.bounds.max());
        ends.map(|(min, max)| (max - min) / spacing).product()
    }

    pub fn and(&self, own: Option<&Self>) -> Volume {
        match own {
            Some(own) => own.volume.clone().and(self.volume.clone()),
            None => self.volume.clone(),
        }
    }
}

impl RegionDraft {
    /// Checks it and everything in it.
    pub fn check(&self) -> Checked<QueryRegion> {
        let is_box = matches!(self.shape, ShapeDraft::Box(_) | ShapeDraft::Cuboid(_));
        let is_chunk = matches!(self.shape, ShapeDraft::Chunk(..) | ShapeDraft::Cube(..));
        let empty = |allowed| self.fault("empty: nothing is left of what it includes", allowed);
        let (path, echo) = (self.path.clone(), (!is_box).then(|| self.echo()));
        if self.is_in_space() {
            let volume = self.volume()?;
            let bounds = volume.bounds().filter(|bounds| !bounds.is_empty());
            let bounds = bounds.ok_or_else(|| empty(VOLUME))?;
            return Ok(QueryRegion {
                path,
                area: Area::from(bounds.shadow()),
                bounds: bounds.shadow(),
                volume: Some(QueryVolume { volume, bounds }),
                echo,
                corner: is_chunk.then(|| Place::Space(bounds.min())),
            });
        }
        let area = self.area()?;
        let bounds = area.bounds().filter(|bounds| !bounds.is_empty());
        // Polygons without area have no points, and are no fault.
        let flat =
            || around([self].into_iter()).and_then(|[a, b, c, d]| Region::new([a, b], [c, d]).ok());
        let bounds = bounds.or_else(flat).ok_or_else(|| empty(REGION))?;
        Ok(QueryRegion {
            path,
            bounds,
            echo,
            corner: is_chunk.then(|| Place::Plane(bounds.min())),
            volume: None,
            area,
        })
    }

    /// A fault of all of it.
    fn fault(&self, detail: &'static str, allowed: &str) -> Faults {
        Fault::new(&self.path, self.echo(), detail, allowed).into()
    }

    /// The shapes of the regions in two lists. The first must not be empty.
    fn lists<T>(
        &self,
        include: &[Checked<Self>],
        exclude: &[Checked<Self>],
        of: fn(&Self) -> Checked<T>,
    ) -> Checked<(Vec<T>, Vec<T>)> {
        let listed = |list: &[Checked<Self>]| {
            let all_of = list
                .iter()
                .map(|region| of(region.as_ref().map_err(Clone::clone)?));
            all(all_of)
        };
        let (include, exclude) = (listed(include), listed(exclude)).together()?;
        if include.is_empty() {
            let field = format!("{}.include", self.path);
            return Err(Fault::missing(&field, "at least one region").into());
        }
        Ok((include, exclude))
    }

    fn area(&self) -> Checked<Area> {
        Ok(match &self.shape {
            ShapeDraft::Box(corners) => self.boxed(corners, BBOX.allowed(), Region::new)?.into(),
            ShapeDraft::Circle(center, radius) => {
                let circle = Circle::new(*center, *radius).map(Area::from);
                let numbers = [center.as_slice(), &[*radius]].concat();
                self.round(&numbers, CIRCLE.allowed(), circle, |area| {
                    area.bounds().is_some()
                })?
            }
            ShapeDraft::Polygons(polygons, _) => {
                let fault = |detail| self.of_polygons(polygons, "", detail, POLYGON.allowed());
                let surfaces = surfaces(polygons).map_err(fault)?.into_iter();
                Area::any_of(surfaces.map(|(exterior, holes)| {
                    Area::from(exterior).without(holes.into_iter().map(Area::from))
                }))
            }
            ShapeDraft::Chunk(size, at) => self
                .chunk(*size, at, Region::chunk(*size, *at), CHUNK)?
                .into(),
            ShapeDraft::Combined(include, exclude) => {
                let (include, exclude) = self.lists(include, exclude, Self::area)?;
                Area::any_of(include).without(exclude)
            }
            _ => return Err(self.fault("a volume among regions of the plane", REGION)),
        })
    }

    fn volume(&self) -> Checked<Volume> {
        Ok(match &self.shape {
            ShapeDraft::Cuboid(corners) => self
                .boxed(corners, BOX.allowed(), space::Region::new)?
                .into(),
            ShapeDraft::Ball(center, radius) => {
                let ball = Ball::new(*center, *radius).map(Volume::from);
                let numbers = [center.as_slice(), &[*radius]].concat();
                self.round(&numbers, BALL.allowed(), ball, |volume| {
                    volume.bounds().is_some()
                })?
            }
            ShapeDraft::Prism(polygons, heights) => self.prism(polygons, *heights)?,
            ShapeDraft::Cube(size, at) => self
                .chunk(*size, at, space::Region::chunk(*size, *at), CUBE)?
                .into(),
            ShapeDraft::Combined(include, exclude) => {
                let (include, exclude) = self.lists(include, exclude, Self::volume)?;
                Volume::any_of(include).without(exclude)
            }
            _ => return Err(self.fault("a region of the plane among volumes", VOLUME)),
        })
    }

    /// A box of the plane or of space by its corners, the lower one first.
    fn boxed<const D: usize, T>(
        &self,
        corners: &[f64],
        allowed: String,
        new: fn([f64; D], [f64; D]) -> Result<T, strew_core::Error>,
    ) -> Result<T, Fault> {
        let fault = |detail: String| Fault::new(&self.path, listed(corners), detail, &allowed);
        let end = |from: usize| std::array::from_fn(|axis| corners[from + axis]);
        let (min, max): ([f64; D], [f64; D]) = (end(0), end(D));
        let names = ["x", "y", "z"].into_iter().zip(min.into_iter().zip(max));
        let region = new(min, max).map_err(|error| {
            let (corner, value) = (error.field(), error.value());
            let is_reversed = corners.iter().all(|v| v.is_finite());
            let of_corner = |(axis, _): &(&str, _)| corner.strip_prefix("max_") == Some(*axis);
            fault(
                match names.clone().find(of_corner).filter(|_| is_reversed) {
                    Some((_, (lower, _))) => {
                        let lower = number(lower);
                        format!("reversed: {corner} is {value}, below the lower bound {lower}")
                    }
                    None => format!("{corner} is {value}"),
                },
            )
        })?;
        for (axis, (min, max)) in names.clone() {
            if min >= max {
                let min = number(min);
                return Err(fault(format!(
                    "empty: min_{axis} and max_{axis} are both {min}"
                )));
            }
        }
        Ok(region)
    }

    /// A circle or a ball of some numbers, if it is one and has bounds.
    fn round<T>(
        &self,
        numbers: &[f64],
        allowed: String,
        round: Result<T, strew_core::Error>,
        has_bounds: fn(&T) -> bool,
    ) -> Result<T, Fault> {
        let fault = |detail| Fault::new(&self.path, listed(numbers), detail, &allowed);
        let round = round.map_err(|error| fault(error.to_string()))?;
        match has_bounds(&round) {
            true => Ok(round),
            false => Err(fault("too large".into())),
        }
    }

    fn chunk<T>(
        &self,
        size: f64,
        at: &[i64],
        chunk: Result<T, strew_core::Error>,
        allowed: &str,
    ) -> Result<T, Fault> {
        chunk.map_err(|error| {
            let at: String = at.iter().map(|place| format!("/{place}")).collect();
            let value = format!("{}{at}", number(size));
            Fault::new(&self.path, value, error.problem(), allowed)
        })
    }

    /// A fault of polygons, which are too long to be shown.
    fn of_polygons(
        &self,
        polygons: &[Rings],
        between: &str,
        detail: String,
        allowed: impl Into<String>,
    ) -> Fault {
        let (count, vertices) = (polygons.len(), self.vertices());
        let value = format!("{count} polygons of {vertices} vertices{between}");
        Fault::new(&self.path, value, detail, allowed)
    }

    fn prism(&self, polygons: &[Rings], heights: [f64; 2]) -> Result<Volume, Fault> {
        let [bottom, top] = heights.map(number);
        let between = format!(" from {bottom} to {top}");
        let fault = |detail: String| self.of_polygons(polygons, &between, detail, PRISM);
        if heights[0] == heights[1] {
            return Err(fault(format!("empty: bottom and top are both {bottom}")));
        }
        let prism = |base: Polygon| {
            let prism = Prism::new(base, heights).map(Volume::from);
            prism.map_err(|error| fault(error.to_string()))
        };
        let read = |(base, holes): (Polygon, Vec<Polygon>)| {
            let holes: Vec<_> = holes.into_iter().map(prism).collect::<Result<_, _>>()?;
            Ok(prism(base)?.without(holes))
        };
        let volumes = surfaces(polygons).map_err(fault)?.into_iter().map(read);
        Ok(Volume::any_of(volumes.collect::<Result<Vec<_>, _>>()?))
    }
}

impl QueryRegion {
    /// The error of a region that reaches too far for a spacing.
    pub fn too_far(&self, spacing: Spacing, error: &strew_core::Error) -> Error {
        let listed = || listed(&self.corners());
        let value = self.echo.as_ref().map_or_else(listed, ToString::to_string);
        let fault = match (error.kind(), error.limit()) {
            (ErrorKind::TooFar, Some(limit)) => Fault::new(
                &self.path,
                value,
                match &self.echo {
                    None => {
                        let (field, value) = (error.field(), error.value());
                        format!("{field} is {value}, too far from the origin")
                    }
                    Some(_) => format!("reaches to {}, too far from the origin", error.value()),
                },
                format!(
                    "within ±{} at spacing {}, where f64 still tells neighbors apart",
                    number(limit),
                    number(spacing.get())
                ),
            ),
            _ => {
                let allowed = if self.volume.is_some() {
                    VOLUME
                } else {
                    REGION
                };
                Fault::new(&self.path, value, error.to_string(), allowed)
            }
        };
        fault.into()
    }
}
