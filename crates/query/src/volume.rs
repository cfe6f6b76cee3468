//! Volumes: the regions of points in space.

use serde_json::{Value as Json, json};
use strew_core::{
    Polygon,
    space::{Ball, Prism, Region, Volume},
};
use strew_error::{Checked, Fault, number};

use crate::{
    lists::listed,
    parameter::Group,
    rings::{Rings, surfaces},
    space::{BALL, BOX},
    values::Values,
};

const CHUNK: &str = "a size above 0 and three integers within ±4503599627370496, the chunk's place along x, y and z";
pub(super) const PRISM: &str =
    "a polygon (GeoJSON) between two heights, finite numbers with bottom below top";
pub(super) const VOLUME: &str = "one of bbox, ball, prism, chunk, or include with exclude";

#[derive(Clone, Debug, PartialEq)]
pub enum VolumeDraft {
    /// min x, min y, min z, max x, max y, max z.
    Box([f64; 6]),
    Ball([f64; 3], f64),
    /// Polygons with their holes, between two heights.
    Prism(Vec<Rings>, [f64; 2]),
    /// A cube of the world grid of this size; answers are relative to its lower corner.
    Chunk(f64, [i64; 3]),
}

#[derive(Clone, Debug, PartialEq)]
pub struct QueryVolume {
    /// The volume; it has a box around it, which is not empty.
    pub volume: Volume,
    pub bounds: Region,
}

impl VolumeDraft {
    /// The volume among the parameters of an address or a command line, with its parameter's name.
    pub(super) fn of(values: &Values) -> Checked<Option<(&'static str, Self)>> {
        let (only, second) = match values.two_of(&[Group::Volume]) {
            [None, _] => return Ok(None),
            [Some(only), second] => (only, second),
        };
        if let Some(second) = second {
            let detail = format!("a query has one region, and {} is given", only.name);
            let allowed = "one of bbox and ball";
            return Err(Fault::new(second.name, values.text(second), detail, allowed).into());
        }
        let shape = if *only == BOX {
            values.get(&BOX)?.map(Self::Box)
        } else {
            let ball: Option<[f64; 4]> = values.get(&BALL)?;
            ball.map(|[x, y, z, radius]| Self::Ball([x, y, z], radius))
        };
        Ok(shape.map(|shape| (only.name, shape)))
    }

    pub(super) fn vertices(&self) -> usize {
        match self {
            Self::Prism(polygons, _) => polygons.iter().flatten().map(Vec::len).sum(),
            _ => 0,
        }
    }

    /// The volume, whose field is `path`.
    pub(super) fn check(&self, path: &str) -> Result<Volume, Fault> {
        match self {
            Self::Box(corners) => Ok(region(path, *corners)?.into()),
            Self::Ball(center, radius) => {
                let value = || listed(&[center[0], center[1], center[2], *radius]);
                let fault = |detail| Fault::new(path, value(), detail, BALL.allowed());
                let ball = Ball::new(*center, *radius).map_err(|error| fault(error.to_string()))?;
                let volume = Volume::from(ball);
                match volume.bounds() {
                    Some(_) => Ok(volume),
                    None => Err(fault("too large".into())),
                }
            }
            Self::Prism(polygons, heights) => self.prism(path, polygons, *heights),
            Self::Chunk(size, at) => {
                let region = Region::chunk(*size, *at).map_err(|error| {
                    let value = format!("{}/{}/{}/{}", number(*size), at[0], at[1], at[2]);
                    Fault::new(path, value, error.problem(), CHUNK)
                });
                Ok(region?.into())
            }
        }
    }

    fn prism(&self, path: &str, polygons: &[Rings], heights: [f64; 2]) -> Result<Volume, Fault> {
        let [bottom, top] = heights.map(number);
        let fault = |detail: String| {
            let value = format!(
                "{} polygons of {} vertices from {bottom} to {top}",
                polygons.len(),
                self.vertices()
            );
            Fault::new(path, value, detail, PRISM)
        };
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

    pub(super) fn echo(&self) -> Json {
        match self {
            Self::Box(corners) => json!({ "bbox": corners }),
            Self::Ball(center, radius) => {
                json!({ "ball": { "center": center, "radius": radius } })
            }
            Self::Prism(polygons, [bottom, top]) => {
                let polygon = match polygons.as_slice() {
                    [rings] => json!({ "type": "Polygon", "coordinates": rings }),
                    all => json!({ "type": "MultiPolygon", "coordinates": all }),
                };
                json!({ "prism": { "polygon": polygon, "bottom": bottom, "top": top } })
            }
            Self::Chunk(size, [x, y, z]) => {
                json!({ "chunk": { "size": size, "x": x, "y": y, "z": z } })
            }
        }
    }
}

fn region(path: &str, corners: [f64; 6]) -> Result<Region, Fault> {
    let [x, y, z, max_x, max_y, max_z] = corners;
    let fault = |detail: String| Fault::new(path, listed(&corners), detail, BOX.allowed());
    let region = Region::new([x, y, z], [max_x, max_y, max_z]).map_err(|error| {
        let (corner, value) = (error.field(), error.value());
        let axis = ["max_x", "max_y", "max_z"]
            .iter()
            .position(|name| *name == corner);
        match axis.filter(|_| corners.iter().all(|v| v.is_finite())) {
            Some(axis) => {
                let lower = number(corners[axis]);
                fault(format!(
                    "reversed: {corner} is {value}, below the lower bound {lower}"
                ))
            }
            None => fault(format!("{corner} is {value}")),
        }
    })?;
    for (axis, i) in [("x", 0), ("y", 1), ("z", 2)] {
        let (min, max) = (region.min()[i], region.max()[i]);
        if min >= max {
            let min = number(min);
            return Err(fault(format!(
                "empty: min_{axis} and max_{axis} are both {min}"
            )));
        }
    }
    Ok(region)
}

impl QueryVolume {
    /// min x, min y, min z, max x, max y, max z of the box around it.
    pub fn bbox(&self) -> [f64; 6] {
        let ([x, y, z], [max_x, max_y, max_z]) = (self.bounds.min(), self.bounds.max());
        [x, y, z, max_x, max_y, max_z]
    }

    /// The volume of the box around it, in mean spacings cubed.
    pub fn spacings(&self, spacing: f64) -> f64 {
        let ([x, y, z], [max_x, max_y, max_z]) = (self.bounds.min(), self.bounds.max());
        [max_x - x, max_y - y, max_z - z]
            .map(|side| side / spacing)
            .into_iter()
            .product()
    }

    pub fn and(&self, own: Option<&Self>) -> Volume {
        match own {
            Some(own) => own.volume.clone().and(self.volume.clone()),
            None => self.volume.clone(),
        }
    }
}
