//! The price of counting a volume of space.
//!
//! Most of a large volume is counted as whole cells; what lies along its surface is counted point by point.

use strew_core::{
    Warp,
    space::{SpaceSet, Volume},
};
use strew_query::Query;

use super::is_counted;
use crate::amount_in_space::placed;

/// The nanoseconds that counting takes for each square of a spacing's side on the surface, without and with warp.
const SURFACE: f64 = 350.0;
const WARPED: f64 = 800.0;
/// Those of a point that is made to test whether it is clear of others.
const MADE: f64 = 100.0;
/// Those of counting a box without warp, whatever it holds.
const BOX: f64 = 4e5;

/// Those of a test against the points around a patch, and of each of these.
const TESTED: f64 = 300.0;
const LISTED: f64 = 250.0;
/// With more of them for each point tested, each test makes those near it alone: so long it takes, and for each of them.
const DENSE: f64 = 1.5;
const SEARCH: f64 = 8000.0;
const FOUND: f64 = 100.0;

/// The nanoseconds that counting the sets of a query in space takes.
pub(super) fn counting(query: &Query) -> f64 {
    let Some(whole) = &query.region.volume else {
        return 0.0;
    };
    let mut layers: Vec<Option<SpaceSet>> = vec![];
    let mut all = 0.0;
    for (i, set) in query.sets.iter().enumerate() {
        // Planning refuses what cannot be planned.
        let placed = set.space().and_then(|table| placed(set, table).ok());
        let points = placed.map(|(points, _)| points);
        if let Some(points) = &points {
            let others = set.clear_of.iter();
            let others = others.filter_map(|&(place, distance)| {
                Some(cleared(points, layers.get(place)?.as_ref()?, distance))
            });
            let own = set.region.as_ref().and_then(|own| own.volume.as_ref());
            if is_counted(query, i, set) {
                all += counting_set(points, &whole.and(own), others.sum());
            }
        }
        layers.push(points);
    }
    all
}

/// The nanoseconds to test whether a point of a set is as far from those of another as a distance.
pub(crate) fn cleared(points: &SpaceSet, other: &SpaceSet, distance: f64) -> f64 {
    let spacing = |set: &SpaceSet| {
        let placement = set.placement();
        placement.spacing.get() / placement.keep.get().cbrt()
    };
    let (own, other) = (spacing(points), spacing(other));
    let ratio = (own / other).powi(3);
    TESTED
        + match ratio <= DENSE {
            true => ratio * LISTED,
            false => SEARCH + (2.0 * distance / other + 1.0).powi(3) * FOUND,
        }
}

/// The nanoseconds that counting the points of a set in a volume takes, where testing one against others takes `test`.
pub(super) fn counting_set(points: &SpaceSet, volume: &Volume, test: f64) -> f64 {
    let spacing = points.placement().spacing.get();
    let is_box = matches!(volume, Volume::Region(_));
    match (test > 0.0, points.placement().warp) {
        (true, _) => {
            let sides = volume.bounds().map_or([0.0; 3], |bounds| {
                [0, 1, 2].map(|axis| (bounds.max()[axis] - bounds.min()[axis]) / spacing)
            });
            let all: f64 = sides.into_iter().product();
            all * (MADE + test)
        }
        (false, Warp::OFF) if is_box => BOX,
        (false, Warp::OFF) => BOX + surface(volume) / (spacing * spacing) * SURFACE,
        (false, _) => BOX + surface(volume) / (spacing * spacing) * WARPED,
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
