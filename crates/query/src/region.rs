//! Regions: boxes, circles, polygons, chunks, and lists of them.

use std::borrow::Cow;

use serde_json::{Value as Json, json};
use strew_catalog::Dimension;
use strew_core::{Area, Circle, ErrorKind, Region, Spacing, space::Volume};
use strew_encode::{Crs, Place};
use strew_error::{Checked, Error, Fault, Faults, Together as _, faults::all, number};

use super::{
    Values,
    lists::listed,
    parameter::Group,
    parameters::{BBOX, CIRCLE, POLYGON},
    rings::{Rings, surfaces},
    volume::{QueryVolume, VOLUME, VolumeDraft},
};

const CHUNK: &str =
    "a size above 0 and two integers within ±4503599627370496, the chunk's column and row";
pub(super) const REGION: &str =
    "one of bbox, circle, polygon (GeoJSON), chunk, or include with exclude";

/// A box around the polygons of some regions, whose upper sides belong to none of them.
pub(super) fn around<'a>(regions: impl Iterator<Item = &'a RegionDraft>) -> Option<[f64; 4]> {
    let rings = regions.flat_map(|region| match &region.shape {
        ShapeDraft::Polygons(polygons, _) => polygons.iter().flatten().flatten(),
        _ => [].iter().flatten().flatten(),
    });
    let [low, high] = [f64::INFINITY, f64::NEG_INFINITY];
    let all = rings.fold([low, low, high, high], |[a, b, c, d], &[x, y]| {
        [a.min(x), b.min(y), c.max(x.next_up()), d.max(y.next_up())]
    });
    all.iter().all(|v| v.is_finite()).then_some(all)
}

/// A region as it was given, not checked. `path` names it in faults.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionDraft {
    pub path: Cow<'static, str>,
    pub shape: ShapeDraft,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ShapeDraft {
    /// min x, min y, max x, max y.
    Box([f64; 4]),
    Circle([f64; 2], f64),
    Polygons(Vec<Rings>, Option<Crs>),
    /// A square of the world grid of this size; answers are relative to its lower corner.
    Chunk(f64, [i64; 2]),
    /// The points in any region of the first list and in none of the second.
    Combined(Vec<Checked<RegionDraft>>, Vec<Checked<RegionDraft>>),
    Volume(VolumeDraft),
}

#[derive(Clone, Debug, PartialEq)]
pub struct QueryRegion {
    pub path: Cow<'static, str>,
    /// The area; it has a box around it, which is not empty. Of a volume, the shadow along z.
    pub area: Area,
    pub bounds: Region,
    pub volume: Option<QueryVolume>,
    /// As answers echo it, unless it is just that box.
    pub echo: Option<Json>,
    /// The corner that answers are relative to, for a chunk.
    pub corner: Option<Place>,
}

impl QueryRegion {
    /// The coordinates of the box around it: the lower corner, then the upper one.
    pub fn corners(&self) -> Vec<f64> {
        match &self.volume {
            Some(volume) => volume.bbox().into(),
            None => self.bbox().into(),
        }
    }

    /// The area of the box around it, or in space its volume.
    pub fn measure(&self) -> f64 {
        match &self.volume {
            Some(volume) => sides(&volume.bounds.min(), &volume.bounds.max()).product(),
            None => sides(&self.bounds.min(), &self.bounds.max()).product(),
        }
    }

    /// min x, min y, max x, max y of the box around it.
    pub fn bbox(&self) -> [f64; 4] {
        let ([min_x, min_y], [max_x, max_y]) = (self.bounds.min(), self.bounds.max());
        [min_x, min_y, max_x, max_y]
    }

    /// The largest absolute coordinate of an answer, which a chunk's are not far from.
    pub fn reach(&self) -> f64 {
        let reach = |min: &[f64], max: &[f64]| match self.corner {
            Some(_) => sides(min, max).fold(0.0, f64::max),
            None => (min.iter().chain(max).copied())
                .map(f64::abs)
                .fold(0.0, f64::max),
        };
        match &self.volume {
            Some(volume) => reach(&volume.bounds.min(), &volume.bounds.max()),
            None => reach(&self.bounds.min(), &self.bounds.max()),
        }
    }

    pub fn and(&self, own: &Self) -> Area {
        own.area.clone().and(self.area.clone())
    }
}

fn sides(min: &[f64], max: &[f64]) -> impl Iterator<Item = f64> {
    max.iter().zip(min).map(|(max, min)| max - min)
}

impl RegionDraft {
    /// The region among the parameters of an address or a command line.
    pub fn of(values: &Values) -> Checked<Option<Self>> {
        if values.dimension() == Dimension::Space {
            let volume = VolumeDraft::of(values)?;
            return Ok(volume.map(|(name, shape)| Self {
                path: name.into(),
                shape: ShapeDraft::Volume(shape),
            }));
        }
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
                ShapeDraft::Polygons(vec![vec![pairs.to_vec()]], None)
            }),
        };
        Ok(shape.map(|shape| Self {
            path: only.name.into(),
            shape,
        }))
    }

    pub fn check(&self) -> Checked<QueryRegion> {
        if self.is_in_space() {
            return self.check_volume();
        }
        let area = self.area()?;
        let bounds = area.bounds().filter(|bounds| !bounds.is_empty());
        // Polygons without area have no points, and are no fault.
        let flat =
            || around([self].into_iter()).and_then(|[a, b, c, d]| Region::new([a, b], [c, d]).ok());
        let bounds = bounds.or_else(flat);
        let bounds = bounds.ok_or_else(|| {
            let detail = "empty: nothing is left of what it includes";
            Faults::from(Fault::new(&self.path, self.echo(), detail, REGION))
        })?;
        Ok(QueryRegion {
            path: self.path.clone(),
            bounds,
            echo: (!matches!(self.shape, ShapeDraft::Box(_))).then(|| self.echo()),
            corner: matches!(self.shape, ShapeDraft::Chunk(..)).then(|| Place::Plane(bounds.min())),
            volume: None,
            area,
        })
    }

    /// Whether it lies in space: of several regions, whether the first does.
    pub(super) fn is_in_space(&self) -> bool {
        match &self.shape {
            ShapeDraft::Volume(_) => true,
            ShapeDraft::Combined(include, _) => include.iter().flatten().any(Self::is_in_space),
            _ => false,
        }
    }

    /// Visits the planes that its polygons state, each with the field that it came from.
    pub(super) fn each_plane(&self, visit: &mut impl FnMut(&str, &Crs)) {
        match &self.shape {
            ShapeDraft::Polygons(_, Some(crs)) => visit(&self.path, crs),
            ShapeDraft::Combined(include, exclude) => {
                for region in include.iter().chain(exclude).flatten() {
                    region.each_plane(visit);
                }
            }
            _ => {}
        }
    }

    /// The field of the first polygons that state no plane and may be degrees of longitude and latitude.
    pub(super) fn in_degrees(&self) -> Option<&str> {
        match &self.shape {
            ShapeDraft::Polygons(polygons, None) => {
                let mut all = polygons.iter().flatten().flatten();
                let is_degrees = |[x, y]: &[f64; 2]| x.abs() <= 180.0 && y.abs() <= 90.0;
                all.all(is_degrees).then_some(&*self.path)
            }
            ShapeDraft::Combined(include, _) => include.iter().flatten().find_map(Self::in_degrees),
            _ => None,
        }
    }

    fn check_volume(&self) -> Checked<QueryRegion> {
        let volume = self.volume()?;
        let bounds = volume.bounds().filter(|bounds| !bounds.is_empty());
        let bounds = bounds.ok_or_else(|| {
            let detail = "empty: nothing is left of what it includes";
            Faults::from(Fault::new(&self.path, self.echo(), detail, VOLUME))
        })?;
        let shadow = bounds.shadow();
        let of = |wanted: fn(&VolumeDraft) -> bool| matches!(&self.shape, ShapeDraft::Volume(own) if wanted(own));
        let is_chunk = of(|own| matches!(own, VolumeDraft::Chunk(..)));
        Ok(QueryRegion {
            path: self.path.clone(),
            area: Area::from(shadow),
            bounds: shadow,
            volume: Some(QueryVolume { volume, bounds }),
            echo: (!of(|own| matches!(own, VolumeDraft::Box(_)))).then(|| self.echo()),
            corner: is_chunk.then(|| Place::Space(bounds.min())),
        })
    }

    fn volume(&self) -> Checked<Volume> {
        match &self.shape {
            ShapeDraft::Volume(own) => Ok(own.check(&self.path)?),
            ShapeDraft::Combined(include, exclude) => {
                let (include, exclude) = self.lists(include, exclude, Self::volume)?;
                Ok(Volume::any_of(include).without(exclude))
            }
            _ => {
                let detail = "a region of the plane among volumes";
                Err(Fault::new(&self.path, self.echo(), detail, VOLUME).into())
            }
        }
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

    pub(super) fn vertices(&self) -> usize {
        match &self.shape {
            ShapeDraft::Polygons(polygons, _) => polygons.iter().flatten().map(Vec::len).sum(),
            ShapeDraft::Combined(include, exclude) => {
                let all = include.iter().chain(exclude);
                all.flatten().map(Self::vertices).sum()
            }
            ShapeDraft::Volume(volume) => volume.vertices(),
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
            ShapeDraft::Polygons(polygons, _) => Ok(self.polygons(polygons)?),
            ShapeDraft::Chunk(size, at) => Ok(self.chunk(*size, *at)?.into()),
            ShapeDraft::Combined(include, exclude) => {
                let (include, exclude) = self.lists(include, exclude, Self::area)?;
                Ok(Area::any_of(include).without(exclude))
            }
            ShapeDraft::Volume(_) => {
                let detail = "a volume among regions of the plane";
                Err(Fault::new(&self.path, self.echo(), detail, REGION).into())
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
        let surfaces = surfaces(polygons).map_err(fault)?.into_iter();
        Ok(Area::any_of(surfaces.map(|(exterior, holes)| {
            Area::from(exterior).without(holes.into_iter().map(Area::from))
        })))
    }

    fn chunk(&self, size: f64, at: [i64; 2]) -> Result<Region, Fault> {
        Region::chunk(size, at).map_err(|error| {
            let value = format!("{}/{}/{}", number(size), at[0], at[1]);
            Fault::new(&self.path, value, error.problem(), CHUNK)
        })
    }

    pub fn echo(&self) -> Json {
        let list = |regions: &[Checked<Self>]| {
            regions.iter().flatten().map(Self::echo).collect::<Vec<_>>()
        };
        match &self.shape {
            ShapeDraft::Box(corners) => json!({ "bbox": corners }),
            ShapeDraft::Circle(center, radius) => {
                json!({ "circle": { "center": center, "radius": radius } })
            }
            ShapeDraft::Polygons(polygons, crs) => {
                let mut polygon = match polygons.as_slice() {
                    [rings] => json!({ "type": "Polygon", "coordinates": rings }),
                    all => json!({ "type": "MultiPolygon", "coordinates": all }),
                };
                if let Some(crs) = crs {
                    polygon["crs"] = crs.to_geojson();
                }
                json!({ "polygon": polygon })
            }
            ShapeDraft::Chunk(size, [x, y]) => {
                json!({ "chunk": { "size": size, "x": x, "y": y } })
            }
            ShapeDraft::Combined(include, exclude) => {
                json!({ "include": list(include), "exclude": list(exclude) })
            }
            ShapeDraft::Volume(volume) => volume.echo(),
        }
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
