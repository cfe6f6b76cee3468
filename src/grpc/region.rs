//! Regions of requests as drafts.

use super::proto::{
    BoundingBox, Chunk, Circle, Combined, Polygon, Polygons, Position, Region, region::Shape,
};
use crate::service::{
    Fault,
    query::{MOST_LEVELS, RegionDraft, Rings, ShapeDraft},
};

/// The draft of a region at a path, `depth` lists deep.
pub(super) fn draft(
    region: &Region,
    path: &str,
    depth: usize,
    faults: &mut Vec<Fault>,
) -> RegionDraft {
    let (name, shape) = match &region.shape {
        Some(Shape::Bbox(b)) => ("bbox", bbox(*b)),
        Some(Shape::Circle(circle)) => ("circle", self::circle(*circle)),
        Some(Shape::Polygons(polygons)) => ("polygons", self::polygons(polygons)),
        Some(Shape::Chunk(Chunk { size, x, y })) => ("chunk", ShapeDraft::Chunk(*size, [*x, *y])),
        Some(Shape::Combined(combined)) => {
            let path = format!("{path}.combined");
            ("combined", self::combined(combined, &path, depth, faults))
        }
        None => {
            let kinds = "one of bbox, circle, polygons, chunk and combined";
            faults.push(Fault::missing(path, kinds));
            return RegionDraft {
                path: path.into(),
                shape: ShapeDraft::Unread,
            };
        }
    };
    RegionDraft {
        path: format!("{path}.{name}"),
        shape,
    }
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
    faults: &mut Vec<Fault>,
) -> ShapeDraft {
    if depth == MOST_LEVELS {
        let allowed = format!("{MOST_LEVELS} levels at most");
        let detail = "lists are nested too deeply";
        faults.push(Fault::new(path, "", detail, allowed));
        return ShapeDraft::Unread;
    }
    let mut list = |name: &str, regions: &[Region]| {
        let regions = regions.iter().enumerate();
        regions
            .map(|(i, region)| draft(region, &format!("{path}.{name}[{i}]"), depth + 1, faults))
            .collect()
    };
    let include = list("include", include);
    ShapeDraft::Combined(include, list("exclude", exclude))
}
