//! Regions of requests as drafts.

use strew_encode::Place;
use strew_error::{Checked, Fault};
use strew_query::{MOST_LEVELS, RegionDraft, Rings, ShapeDraft};

use super::proto::{
    Ball, BoundingBox, Chunk, Circle, Combined, Cube, Cuboid, Polygon, Polygons, Position, Prism,
    Region, region::Shape,
};

/// Whether a region lies in space: of several, whether the first one does.
pub(super) fn is_volume(region: &Region) -> bool {
    match &region.shape {
        Some(Shape::Cuboid(_) | Shape::Ball(_) | Shape::Prism(_) | Shape::Cube(_)) => true,
        Some(Shape::Combined(combined)) => combined.include.first().is_some_and(is_volume),
        _ => false,
    }
}

pub(super) fn position(place: Place) -> Position {
    let [x, y] = place.flat();
    let z = matches!(place, Place::Space(_)).then(|| place.z());
    Position { x, y, z }
}

/// The box of some corners as a message: of the plane, or of space.
pub(super) fn boxed(corners: &[f64]) -> (Option<BoundingBox>, Option<Cuboid>) {
    match *corners {
        [min_x, min_y, max_x, max_y] => {
            let flat = BoundingBox {
                min_x,
                min_y,
                max_x,
                max_y,
            };
            (Some(flat), None)
        }
        [min_x, min_y, min_z, max_x, max_y, max_z] => {
            let cuboid = Cuboid {
                min_x,
                min_y,
                min_z,
                max_x,
                max_y,
                max_z,
            };
            (None, Some(cuboid))
        }
        _ => (None, None),
    }
}

/// The draft of a region at a path, `depth` lists deep.
pub(super) fn draft(region: &Region, path: &str, depth: usize) -> Checked<RegionDraft> {
    let (name, shape) = match &region.shape {
        Some(Shape::Bbox(b)) => {
            let corners = [b.min_x, b.min_y, b.max_x, b.max_y];
            ("bbox", ShapeDraft::Box(corners))
        }
        Some(Shape::Circle(Circle { center, radius })) => {
            let center = center.unwrap_or_default();
            ("circle", ShapeDraft::Circle([center.x, center.y], *radius))
        }
        Some(Shape::Polygons(polygons)) => {
            ("polygons", ShapeDraft::Polygons(rings(polygons), None))
        }
        Some(Shape::Chunk(Chunk { size, x, y })) => ("chunk", ShapeDraft::Chunk(*size, [*x, *y])),
        Some(Shape::Cuboid(b)) => {
            let corners = [b.min_x, b.min_y, b.min_z, b.max_x, b.max_y, b.max_z];
            ("cuboid", ShapeDraft::Cuboid(corners))
        }
        Some(Shape::Ball(Ball { center, radius })) => {
            let Position { x, y, z } = center.unwrap_or_default();
            let center = [x, y, z.unwrap_or_default()];
            ("ball", ShapeDraft::Ball(center, *radius))
        }
        Some(Shape::Prism(Prism { base, bottom, top })) => {
            let base = base.as_ref().map(rings).unwrap_or_default();
            ("prism", ShapeDraft::Prism(base, [*bottom, *top]))
        }
        Some(Shape::Cube(Cube { size, x, y, z })) => {
            ("cube", ShapeDraft::Cube(*size, [*x, *y, *z]))
        }
        Some(Shape::Combined(combined)) => {
            let path = format!("{path}.combined");
            ("combined", self::combined(combined, &path, depth)?)
        }
        None => {
            let kinds = "one of bbox, circle, polygons, chunk and combined, or in space cuboid, ball, prism and cube";
            return Err(Fault::missing(path, kinds).into());
        }
    };
    let path = format!("{path}.{name}");
    Ok(RegionDraft {
        path: path.into(),
        shape,
    })
}

fn rings(polygons: &Polygons) -> Vec<Rings> {
    let position = |p: &Position| [p.x, p.y];
    let of_one = |polygon: &Polygon| -> Rings {
        let rings = polygon.rings.iter().map(|ring| &ring.positions);
        rings
            .map(|ring| ring.iter().map(position).collect())
            .collect()
    };
    polygons.polygons.iter().map(of_one).collect()
}

fn combined(
    Combined { include, exclude }: &Combined,
    path: &str,
    depth: usize,
) -> Checked<ShapeDraft> {
    if depth == MOST_LEVELS {
        let allowed = format!("{MOST_LEVELS} levels at most");
        return Err(Fault::new(path, "", "regions are nested too deeply", allowed).into());
    }
    let list = |name: &str, regions: &[Region]| {
        let regions = regions.iter().enumerate();
        regions
            .map(|(i, region)| draft(region, &format!("{path}.{name}[{i}]"), depth + 1))
            .collect()
    };
    Ok(ShapeDraft::Combined(
        list("include", include),
        list("exclude", exclude),
    ))
}
