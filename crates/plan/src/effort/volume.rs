//! The price of counting a volume of space.
//!
//! Most of a large volume is counted as whole cells; what lies along its surface is counted point by point.

use strew_core::{
    Warp,
    space::{SpaceSet, Volume},
};
use strew_query::{Query, Set};

use crate::amount_in_space::placed;

/// The nanoseconds that counting takes for each square of a spacing's side on the surface.
const SURFACE: f64 = 150.0;
/// Those of a point that is made to test whether it is clear of others.
const MADE: f64 = 100.0;
/// Those of counting a box without warp, whatever it holds.
const BOX: f64 = 4e5;
/// Those to test whether a point is clear of a layer.
pub(crate) const CLEARED: f64 = 500.0;

/// The nanoseconds that counting the sets of a query in space takes.
pub(super) fn counting(query: &Query) -> f64 {
    let Some(whole) = &query.region.volume else {
        return 0.0;
    };
    let of = |set: &Set| {
        let (points, _) = placed(set, set.space()?).ok()?;
        let own = set.region.as_ref().and_then(|own| own.volume.as_ref());
        Some(counting_set(set, &points, &whole.and(own)))
    };
    // Planning refuses what cannot be planned.
    query.sets.iter().filter_map(of).sum()
}

/// The nanoseconds that counting the points of a set in a volume takes.
pub(super) fn counting_set(set: &Set, points: &SpaceSet, volume: &Volume) -> f64 {
    let spacing = points.placement().spacing.get();
    let is_box = matches!(volume, Volume::Region(_));
    match (set.clear_of.len(), points.placement().warp) {
        (0, Warp::OFF) if is_box => BOX,
        (0, _) => BOX + surface(volume) / (spacing * spacing) * SURFACE,
        (layers, _) => {
            let sides = volume.bounds().map_or([0.0; 3], |bounds| {
                [0, 1, 2].map(|axis| (bounds.max()[axis] - bounds.min()[axis]) / spacing)
            });
            let all: f64 = sides.into_iter().product();
            all * (MADE + CLEARED * layers as f64)
        }
    }
}

/// The surface of the parts of a volume together.
fn surface(volume: &Volume) -> f64 {
    let of_box = |volume: &Volume| {
        volume.bounds().map_or(0.0, |bounds| {
            let [a, b, c] = [0, 1, 2].map(|axis| bounds.max()[axis] - bounds.min()[axis]);
            2.0 * (a * b + b * c + c * a)
        })
    };
    match volume {
        Volume::AllOf(parts) | Volume::AnyOf(parts) => parts.iter().map(surface).sum(),
        Volume::Outside(part) => surface(part),
        Volume::Prism(prism) => of_box(volume) * (1.0 + prism.vertices() as f64 / 64.0),
        other => of_box(other),
    }
}
