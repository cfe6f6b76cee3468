//! Regions of requests as drafts.

use strew_error::{Checked, Fault};
use strew_query::{MOST_LEVELS, RegionDraft, Rings, ShapeDraft};

use super::proto::{
    BoundingBox, Chunk, Circle, Combined, Polygon, Polygons, Position, Region, region::Shape,
};

/// The draft of a region at a path, `depth` lists deep.
pub(super) fn draft(region: &Region, path: &str, depth: usize) -> Checked<RegionDraft> {
    let (name, shape) = match &region.shape {
        Some(Shape::Bbox(b)) => ("bbox", bbox(*b)),
        Some(Shape::Circle(circle)) => ("circle", self::circle(*circle)),
        Some(Shape::Polygons(polygons)) => ("polygons", self::polygons(polygons)),
        Some(Shape::Chunk(Chunk { size, x, y })) => ("chunk", ShapeDraft::Chunk(*size, [*x, *y])),
        Some(Shape::Combined(combined)) => {
            let path = format!("{path}.combined");
            ("combined", self::combined(combined, &path, depth)?)
        }
        None => {
            let kinds = "one of bbox, circle, polygons, chunk and combined";
            return Err(Fault::missing(path, kinds).into());
        }
    };
    let path = format!("{path}.{name}");
    Ok(RegionDraft {
        path: path.into(),
        shape,
    })
}

fn bbox(b: BoundingBox) -> ShapeDraft {
    ShapeDraft::Box([b.min_x, b.min_y, b.max_x, b.max_y])
}

fn circle(circle: Circle) -> ShapeDraft {
    let center = circle.center.unwrap_or_default();
    ShapeDraft::Circle([center.x, center.y], circle.radius)
}

fn polygons(polygons: &Polygons) -> ShapeDraft {
    let position = |p: &Position| [p.x, p.y];
    let rings = |polygon: &Polygon| -> Rings {
        let rings = polygon.rings.iter();
        rings
            .map(|ring| ring.positions.iter().map(position).collect())
            .collect()
    };
    ShapeDraft::Polygons(polygons.polygons.iter().map(rings).collect())
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
