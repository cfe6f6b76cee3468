//! Regions: boxes, circles, polygons, chunks, and lists of them.

use std::borrow::Cow;

use serde_json::{Value as Json, json};
use strew_core::{Area, Circle, ErrorKind, Polygon, Region, Spacing};
use strew_error::{Checked, Error, Fault, Faults, Together as _, faults::all, number};

use super::{
    Values,
    parameter::Group,
    parameters::{BBOX, CIRCLE, POLYGON},
};

/// The form of a chunk, as faults describe it.
const CHUNK: &str =
    "a size above 0 and two integers within ±4503599627370496, the chunk's column and row";
/// The forms of a region.
pub(super) const REGION: &str =
    "one of bbox, circle, polygon (GeoJSON), chunk, or include with exclude";

/// The rings of a polygon: the outer one, then holes.
pub type Rings = Vec<Vec<[f64; 2]>>;

/// A region as it was given, not checked. `path` names it in faults.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionDraft {
    /// The field it came from.
    pub path: Cow<'static, str>,
    /// The shape as it was read.
    pub shape: ShapeDraft,
}

/// The shape of a region.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeDraft {
    /// min x, min y, max x, max y.
    Box([f64; 4]),
    /// A center and a radius.
    Circle([f64; 2], f64),
    /// Polygons with their holes.
    Polygons(Vec<Rings>),
    /// A square of the world grid of this size; answers are relative to its lower corner.
    Chunk(f64, [i64; 2]),
    /// The points in any region of the first list and in none of the second.
    Combined(Vec<Checked<RegionDraft>>, Vec<Checked<RegionDraft>>),
}

/// A checked region.
#[derive(Clone, Debug, PartialEq)]
pub struct QueryRegion {
    /// The field it came from.
    pub path: Cow<'static, str>,
    /// The area; it has a box around it, which is not empty.
    pub area: Area,
    /// That box.
    pub bounds: Region,
    /// As answers echo it, unless it is just that box.
    pub echo: Option<Json>,
    /// The corner that answers are relative to, for a chunk.
    pub corner: Option<[f64; 2]>,
}

impl QueryRegion {
    /// min x, min y, max x, max y of the box around it.
    #[must_use]
    pub fn bbox(&self) -> [f64; 4] {
        let ([min_x, min_y], [max_x, max_y]) = (self.bounds.min(), self.bounds.max());
        [min_x, min_y, max_x, max_y]
    }

    /// The largest absolute coordinate of an answer, which a chunk's are not far from.
    #[must_use]
    pub fn reach(&self) -> f64 {
        let [min_x, min_y, max_x, max_y] = self.bbox();
        match self.corner {
            Some(_) => (max_x - min_x).max(max_y - min_y),
            None => [min_x, min_y, max_x, max_y]
                .map(f64::abs)
                .into_iter()
                .fold(0.0, f64::max),
        }
    }

    /// The area that lies in both regions.
    #[must_use]
    pub fn and(&self, own: &Self) -> Area {
        own.area.clone().and(self.area.clone())
    }
}

impl RegionDraft {
    /// The region among the parameters of an address or a command line.
    ///
    /// # Errors
    /// Faults if there are several, or one that cannot be read.
    pub fn of(values: &Values) -> Checked<Option<Self>> {
        let (only, second) = match values.two_of(&[Group::Region]) {
            [None, _] => return Ok(None),
            [Some(only), second] => (only, second),
        };
        let shape = match second {
            Some(second) => {
                let detail = format!("a query has one region, and {} is given", only.name);
                let allowed = "one of bbox, circle and polygon";
                return Err(Fault::new(second.name, values.text(second), detail, allowed).into());
            }
            None if *only == BBOX => values.get(&BBOX)?.map(ShapeDraft::Box),
            None if *only == CIRCLE => {
                let circle: Option<[f64; 3]> = values.get(&CIRCLE)?;
                circle.map(|[x, y, radius]| ShapeDraft::Circle([x, y], radius))
            }
            None => values.get::<Vec<f64>>(&POLYGON)?.map(|numbers| {
                let (pairs, _) = numbers.as_chunks::<2>();
                ShapeDraft::Polygons(vec![vec![pairs.to_vec()]])
            }),
        };
        Ok(shape.map(|shape| Self {
            path: only.name.into(),
            shape,
        }))
    }

    /// Checks it and everything in it.
    ///
    /// # Errors
    /// Every fault.
    pub fn check(&self) -> Checked<QueryRegion> {
        let area = self.area()?;
        let bounds = area.bounds().filter(|bounds| !bounds.is_empty());
        let bounds = bounds.ok_or_else(|| {
            let detail = "empty: nothing is left of what it includes";
            Faults::from(Fault::new(&self.path, self.echo(), detail, REGION))
        })?;
        Ok(QueryRegion {
            path: self.path.clone(),
            bounds,
            echo: (!matches!(self.shape, ShapeDraft::Box(_))).then(|| self.echo()),
            corner: matches!(self.shape, ShapeDraft::Chunk(..)).then(|| bounds.min()),
            area,
        })
    }

    /// The number of vertices of its polygons.
    pub(super) fn vertices(&self) -> usize {
        match &self.shape {
            ShapeDraft::Polygons(polygons) => polygons.iter().flatten().map(Vec::len).sum(),
            ShapeDraft::Combined(include, exclude) => {
                let all = include.iter().chain(exclude);
                all.flatten().map(Self::vertices).sum()
            }
            _ => 0,
        }
    }

    fn area(&self) -> Checked<Area> {
        match &self.shape {
            ShapeDraft::Box(corners) => Ok(self.region(*corners)?.into()),
            ShapeDraft::Circle(center, radius) => {
                let value = || listed(&[center[0], center[1], *radius]);
                let fault = |detail| Fault::new(&self.path, value(), detail, CIRCLE.allowed());
                let circle =
                    Circle::new(*center, *radius).map_err(|error| fault(error.to_string()))?;
                let area = Area::from(circle);
                match area.bounds() {
                    Some(_) => Ok(area),
                    None => Err(fault("too large".into()).into()),
                }
            }
            ShapeDraft::Polygons(polygons) => Ok(self.polygons(polygons)?),
            ShapeDraft::Chunk(size, at) => Ok(self.chunk(*size, *at)?.into()),
            ShapeDraft::Combined(include, exclude) => {
                let areas = |list: &[Checked<Self>]| {
                    all(list
                        .iter()
                        .map(|region| region.as_ref().map_err(Clone::clone)?.area()))
                };
                let (include, exclude) = (areas(include), areas(exclude)).together()?;
                if include.is_empty() {
                    let field = format!("{}.include", self.path);
                    return Err(Fault::missing(&field, "at least one region").into());
                }
                Ok(Area::any_of(include).without(exclude))
            }
        }
    }

    fn region(&self, corners: [f64; 4]) -> Result<Region, Fault> {
        let [min_x, min_y, max_x, max_y] = corners;
        let fault =
            |detail: String| Fault::new(&self.path, listed(&corners), detail, BBOX.allowed());
        let region = Region::new([min_x, min_y], [max_x, max_y]).map_err(|error| {
            let (corner, value) = (error.field(), error.value());
            let is_reversed = corners.iter().all(|v| v.is_finite());
            fault(if is_reversed {
                let lower = if corner == "max_x" { min_x } else { min_y };
                format!("reversed: {corner} is {value}, below the lower bound {lower}")
            } else {
                format!("{corner} is {value}")
            })
        })?;
        for (axis, i) in [("x", 0), ("y", 1)] {
            let (min, max) = (region.min()[i], region.max()[i]);
            if min >= max {
                return Err(fault(format!(
                    "empty: min_{axis} and max_{axis} are both {min}"
                )));
            }
        }
        Ok(region)
    }

    fn polygons(&self, polygons: &[Rings]) -> Result<Area, Fault> {
        let fault = |detail: String| {
            let value = format!(
                "{} polygons of {} vertices",
                polygons.len(),
                self.vertices()
            );
            Fault::new(&self.path, value, detail, POLYGON.allowed())
        };
        let read = |(i, rings): (usize, &Rings)| {
            Polygon::new(rings)
                .map(Area::from)
                .map_err(|error| match polygons.len() {
                    1 => fault(error.to_string()),
                    _ => fault(format!("polygon {i}: {error}")),
                })
        };
        let areas: Vec<Area> = (polygons.iter().enumerate())
            .map(read)
            .collect::<Result<_, _>>()?;
        if areas.is_empty() {
            return Err(fault("there is no polygon".into()));
        }
        Ok(Area::any_of(areas))
    }

    fn chunk(&self, size: f64, at: [i64; 2]) -> Result<Region, Fault> {
        Region::chunk(size, at).map_err(|error| {
            let value = format!("{}/{}/{}", number(size), at[0], at[1]);
            Fault::new(&self.path, value, error.problem(), CHUNK)
        })
    }

    /// As answers echo it, and as a query's body has it.
    #[must_use]
    pub fn echo(&self) -> Json {
        let list = |regions: &[Checked<Self>]| {
            regions.iter().flatten().map(Self::echo).collect::<Vec<_>>()
        };
        match &self.shape {
            ShapeDraft::Box(corners) => json!({ "bbox": corners }),
            ShapeDraft::Circle(center, radius) => {
                json!({ "circle": { "center": center, "radius": radius } })
            }
            ShapeDraft::Polygons(polygons) => match polygons.as_slice() {
                [rings] => json!({ "polygon": { "type": "Polygon", "coordinates": rings } }),
                all => json!({ "polygon": { "type": "MultiPolygon", "coordinates": all } }),
            },
            ShapeDraft::Chunk(size, [x, y]) => {
                json!({ "chunk": { "size": size, "x": x, "y": y } })
            }
            ShapeDraft::Combined(include, exclude) => {
                json!({ "include": list(include), "exclude": list(exclude) })
            }
        }
    }
}

pub(super) fn listed(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().copied().map(number).collect();
    values.join(",")
}

impl QueryRegion {
    /// The error of a region that reaches too far for a spacing.
    pub fn too_far(&self, spacing: Spacing, error: &strew_core::Error) -> Error {
        let listed = || listed(&self.bbox());
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
            _ => Fault::new(&self.path, value, error.to_string(), REGION),
        };
        fault.into()
    }
}
