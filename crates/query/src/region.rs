//! Regions of the plane and volumes of space: boxes, circles, polygons, balls, prisms, chunks, and lists of them.

use std::borrow::Cow;

use serde_json::{Value as Json, json};
use strew_catalog::Dimension;
use strew_core::Polygon;
use strew_encode::Crs;
use strew_error::{Checked, Fault};

use super::{
    Values,
    parameter::Group,
    parameters::{BBOX, CIRCLE, POLYGON},
    space::{BALL, BOX},
};

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
    /// Polygons with their holes, and the plane that they state.
    Polygons(Vec<Rings>, Option<Crs>),
    /// A square of the world grid of this size; answers are relative to its lower corner.
    Chunk(f64, [i64; 2]),
    /// min x, min y, min z, max x, max y, max z.
    Cuboid([f64; 6]),
    /// A center and a radius.
    Ball([f64; 3], f64),
    /// Polygons with their holes, between two heights.
    Prism(Vec<Rings>, [f64; 2]),
    /// A cube of the world grid of this size; answers are relative to its lower corner.
    Cube(f64, [i64; 3]),
    /// The points in any region of the first list and in none of the second.
    Combined(Vec<Checked<RegionDraft>>, Vec<Checked<RegionDraft>>),
}

impl RegionDraft {
    /// The region among the parameters of an address or a command line.
    pub fn of(values: &Values) -> Checked<Option<Self>> {
        let (group, allowed) = match values.dimension() {
            Dimension::Plane => (Group::Region, "one of bbox, circle and polygon"),
            Dimension::Space => (Group::Volume, "one of bbox and ball"),
        };
        let (only, second) = match values.two_of(&[group]) {
            [None, _] => return Ok(None),
            [Some(only), second] => (only, second),
        };
        if let Some(second) = second {
            let detail = format!("a query has one region, and {} is given", only.name);
            return Err(Fault::new(second.name, values.text(second), detail, allowed).into());
        }
        // Parameters of the plane and of space have the same names.
        let shape = match values.dimension() {
            Dimension::Plane if *only == BBOX => values.get(&BBOX)?.map(ShapeDraft::Box),
            Dimension::Plane if *only == CIRCLE => {
                let circle: Option<[f64; 3]> = values.get(&CIRCLE)?;
                circle.map(|[x, y, radius]| ShapeDraft::Circle([x, y], radius))
            }
            Dimension::Plane => values.get::<Vec<f64>>(&POLYGON)?.map(|numbers| {
                let (pairs, _) = numbers.as_chunks::<2>();
                ShapeDraft::Polygons(vec![vec![pairs.to_vec()]], None)
            }),
            Dimension::Space if *only == BOX => values.get(&BOX)?.map(ShapeDraft::Cuboid),
            Dimension::Space => {
                let ball: Option<[f64; 4]> = values.get(&BALL)?;
                ball.map(|[x, y, z, radius]| ShapeDraft::Ball([x, y, z], radius))
            }
        };
        Ok(shape.map(|shape| Self {
            path: only.name.into(),
            shape,
        }))
    }

    /// Whether it lies in space: of several regions, whether the first does.
    pub(super) fn is_in_space(&self) -> bool {
        use ShapeDraft::{Ball, Box, Chunk, Circle, Combined, Cube, Cuboid, Polygons, Prism};
        match &self.shape {
            Cuboid(_) | Ball(..) | Prism(..) | Cube(..) => true,
            Combined(include, _) => include.iter().flatten().any(Self::is_in_space),
            Box(_) | Circle(..) | Polygons(..) | Chunk(..) => false,
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

    /// The number of vertices of its polygons.
    pub(super) fn vertices(&self) -> usize {
        match &self.shape {
            ShapeDraft::Polygons(polygons, _) | ShapeDraft::Prism(polygons, _) => {
                polygons.iter().flatten().map(Vec::len).sum()
            }
            ShapeDraft::Combined(include, exclude) => {
                let all = include.iter().chain(exclude);
                all.flatten().map(Self::vertices).sum()
            }
            _ => 0,
        }
    }

    /// As answers echo it, and as a query's body has it.
    pub fn echo(&self) -> Json {
        let list = |regions: &[Checked<Self>]| {
            regions.iter().flatten().map(Self::echo).collect::<Vec<_>>()
        };
        let geojson = |polygons: &[Rings]| match polygons {
            [rings] => json!({ "type": "Polygon", "coordinates": rings }),
            all => json!({ "type": "MultiPolygon", "coordinates": all }),
        };
        match &self.shape {
            ShapeDraft::Box(corners) => json!({ "bbox": corners }),
            ShapeDraft::Cuboid(corners) => json!({ "bbox": corners }),
            ShapeDraft::Circle(center, radius) => {
                json!({ "circle": { "center": center, "radius": radius } })
            }
            ShapeDraft::Ball(center, radius) => {
                json!({ "ball": { "center": center, "radius": radius } })
            }
            ShapeDraft::Polygons(polygons, crs) => {
                let mut polygon = geojson(polygons);
                if let Some(crs) = crs {
                    polygon["crs"] = crs.to_geojson();
                }
                json!({ "polygon": polygon })
            }
            ShapeDraft::Prism(polygons, [bottom, top]) => {
                json!({ "prism": { "polygon": geojson(polygons), "bottom": bottom, "top": top } })
            }
            ShapeDraft::Chunk(size, [x, y]) => {
                json!({ "chunk": { "size": size, "x": x, "y": y } })
            }
            ShapeDraft::Cube(size, [x, y, z]) => {
                json!({ "chunk": { "size": size, "x": x, "y": y, "z": z } })
            }
            ShapeDraft::Combined(include, exclude) => {
                json!({ "include": list(include), "exclude": list(exclude) })
            }
        }
    }
}

/// The rings of a polygon: the outer one, then holes.
pub type Rings = Vec<Vec<[f64; 2]>>;

/// Polygons, each with the polygons of its holes. Those that are empty or lie on one line have no points and are left
/// out.
pub(super) fn surfaces(polygons: &[Rings]) -> Result<Vec<(Polygon, Vec<Polygon>)>, String> {
    // Two different positions in all.
    let is_flat = |ring: &[[f64; 2]]| match ring {
        [] => true,
        [first, .., _] if ring.len() > 2 => {
            let second = ring.iter().find(|p| *p != first).unwrap_or(first);
            ring.iter().all(|p| p == first || p == second)
        }
        _ => false,
    };
    let is_empty = |rings: &Rings| rings.first().is_none_or(Vec::is_empty);
    if polygons.iter().all(is_empty) {
        return Err("there is no polygon, or empty ones alone".into());
    }
    let kept = polygons.iter().enumerate();
    let kept = kept.filter(|(_, rings)| rings.first().is_some_and(|ring| !is_flat(ring)));
    let read = |(i, rings): (usize, &Rings)| {
        let rings: Vec<_> = rings.iter().filter(|ring| !is_flat(ring)).collect();
        Polygon::with_holes(&rings).map_err(|error| match polygons.len() {
            1 => error.to_string(),
            _ => format!("polygon {i}: {error}"),
        })
    };
    kept.map(read).collect()
}
