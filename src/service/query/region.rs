//! Regions: boxes, circles, polygons, chunks, and lists of them.

use serde_json::{Value, json};
use strew_core::{Area, Circle, Polygon, Region};

use super::{BOX, faults::Faults, geojson::GEOJSON, number};
use crate::service::Fault;

/// What a circle must be.
pub(super) const CIRCLE: &str = "three finite numbers x,y,radius with a radius above 0";
/// What a polygon must be.
pub(super) const POLYGON: &str =
    "at least 3 different vertices x,y as x1,y1,x2,y2,…; holes and several polygons: POST a query";
/// The pattern of a polygon's vertices: numbers joined by commas, six or more.
pub(super) const VERTICES: &str = "^[^,]+(,[^,]+){5,}$";
/// What a chunk must be.
pub(super) const CHUNK: &str =
    "a size above 0 and two integers within ±4503599627370496, the chunk's column and row";
/// What a region must be.
pub(super) const REGION: &str =
    "one of bbox, circle, polygon (GeoJSON Polygon or MultiPolygon), chunk, or include and exclude";

/// The rings of a polygon: the outer one, then holes.
pub type Rings = Vec<Vec<[f64; 2]>>;

/// A region as it was asked for, not checked. `path` names it in faults.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionDraft {
    /// The field it came from.
    pub path: String,
    /// What it is.
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
    /// What lies in any region of the first list and in none of the second.
    Combined(Vec<RegionDraft>, Vec<RegionDraft>),
    /// Something that could not be read, as has been said.
    Unread,
}

/// A checked region.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// The field it came from.
    pub path: String,
    /// The area; it has a box around it, which is not empty.
    pub area: Area,
    /// That box.
    pub bounds: Region,
    /// As answers echo it, unless it is just that box.
    pub echo: Option<Value>,
    /// The corner that answers are relative to, for a chunk.
    pub corner: Option<[f64; 2]>,
}

impl Asked {
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

    /// What exists in both regions, as one that is asked for by the first one's name.
    #[must_use]
    pub fn and(&self, own: &Self) -> Area {
        own.area.clone().and(self.area.clone())
    }
}

/// What all regions of a query may have together.
pub(super) struct Budget {
    /// Vertices of polygons.
    pub(super) vertices: usize,
}

impl RegionDraft {
    /// Checks it and everything in it.
    pub(super) fn check(&self, budget: &mut Budget, faults: &mut Faults) -> Option<Asked> {
        let area = self.area(budget, faults)?;
        let bounds = area.bounds()?;
        if bounds.is_empty() {
            let detail = "it is empty: nothing is left of what it includes";
            faults.add(Fault::new(&self.path, self.echo(), detail, REGION));
            return None;
        }
        Some(Asked {
            path: self.path.clone(),
            bounds,
            echo: (!matches!(self.shape, ShapeDraft::Box(_))).then(|| self.echo()),
            corner: matches!(self.shape, ShapeDraft::Chunk(..)).then(|| bounds.min()),
            area,
        })
    }

    fn area(&self, budget: &mut Budget, faults: &mut Faults) -> Option<Area> {
        match &self.shape {
            ShapeDraft::Box(corners) => faults.take(self.region(*corners)).map(Area::from),
            ShapeDraft::Circle(center, radius) => {
                let fault = |error: strew_core::Error| {
                    let value = listed(&[center[0], center[1], *radius]);
                    Fault::new(&self.path, value, error.to_string(), CIRCLE)
                };
                let circle = Circle::new(*center, *radius).map_err(fault);
                let circle = circle.and_then(|circle| {
                    let area = Area::from(circle);
                    let value = || listed(&[center[0], center[1], *radius]);
                    match area.bounds() {
                        Some(_) => Ok(area),
                        None => Err(Fault::new(&self.path, value(), "it is too large", CIRCLE)),
                    }
                });
                faults.take(circle)
            }
            ShapeDraft::Polygons(polygons) => faults.take(self.polygons(polygons, budget)),
            ShapeDraft::Chunk(size, at) => faults.take(self.chunk(*size, *at)).map(Area::from),
            ShapeDraft::Unread => None,
            ShapeDraft::Combined(include, exclude) => {
                if include.is_empty() {
                    let field = format!("{}.include", self.path);
                    faults.add(Fault::missing(&field, "at least one region"));
                }
                let mut areas = |list: &[Self]| -> Vec<Option<Area>> {
                    let areas = list.iter().map(|region| region.area(budget, faults));
                    areas.collect()
                };
                let (include, exclude) = (areas(include), areas(exclude));
                let include: Vec<Area> = include.into_iter().collect::<Option<_>>()?;
                let exclude: Vec<Area> = exclude.into_iter().collect::<Option<_>>()?;
                let some = !include.is_empty();
                some.then(|| Area::any_of(include).without(exclude))
            }
        }
    }

    fn region(&self, corners: [f64; 4]) -> Result<Region, Fault> {
        let [min_x, min_y, max_x, max_y] = corners;
        let fault = |detail: String| Fault::new(&self.path, listed(&corners), detail, BOX);
        let region = Region::new([min_x, min_y], [max_x, max_y]).map_err(|error| {
            let (corner, value) = (error.field(), error.value());
            let is_reversed = corners.iter().all(|v| v.is_finite());
            fault(if is_reversed {
                let lower = if corner == "max_x" { min_x } else { min_y };
                format!("it is reversed: {corner} is {value}, below the lower bound {lower}")
            } else {
                format!("{corner} is {value}")
            })
        })?;
        for (axis, i) in [("x", 0), ("y", 1)] {
            let (min, max) = (region.min()[i], region.max()[i]);
            if min >= max {
                let detail = format!("it is empty: min_{axis} and max_{axis} are both {min}");
                return Err(fault(detail));
            }
        }
        Ok(region)
    }

    fn polygons(&self, polygons: &[Rings], budget: &mut Budget) -> Result<Area, Fault> {
        let vertices: usize = polygons.iter().flatten().map(Vec::len).sum();
        let fault = |detail: String, allowed: String| {
            let value = format!("{} polygons of {vertices} vertices", polygons.len());
            Fault::new(&self.path, value, detail, allowed)
        };
        let Some(left) = budget.vertices.checked_sub(vertices) else {
            let detail = "all regions of the query together have too many vertices".into();
            return Err(fault(detail, format!("{} more at most", budget.vertices)));
        };
        budget.vertices = left;
        let read = |(i, rings): (usize, &Rings)| {
            Polygon::new(rings).map(Area::from).map_err(|error| {
                let which = if polygons.len() > 1 {
                    format!("polygon {i}: ")
                } else {
                    String::new()
                };
                let allowed = match self.path.as_str() {
                    "polygon" => POLYGON,
                    _ => GEOJSON,
                };
                fault(format!("{which}{error}"), allowed.into())
            })
        };
        let areas: Vec<Area> = polygons
            .iter()
            .enumerate()
            .map(read)
            .collect::<Result<_, _>>()?;
        if areas.is_empty() {
            return Err(fault("there is no polygon".into(), REGION.into()));
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
    pub fn echo(&self) -> Value {
        let list = |regions: &[Self]| regions.iter().map(Self::echo).collect::<Vec<_>>();
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
            ShapeDraft::Unread => Value::Null,
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
