//! The price of a search for neighbors.

use strew_core::Region;
use strew_encode::Place;
use strew_query::Nearest;

use super::{ROW, layers::look};
use crate::{Lane, Placed, single::MOST_WITHIN};

/// A visit to a point that lies near, in nanoseconds.
const VISIT: f64 = 30.0;

/// The price of a search for neighbors, known before it begins.
#[derive(Clone, Copy, Debug)]
pub struct Neighbors {
    /// The most bytes that the points and the answer with them hold.
    pub bytes: usize,
    /// Where to search.
    pub lane: Lane,
    /// The time of a visit to a point, in nanoseconds.
    visit: f64,
}

impl Neighbors {
    /// The price of a search among the points of a set.
    pub fn of(placed: &Placed, nearest: &Nearest) -> Self {
        /// A point without attributes, and a value, in memory and as text.
        const POINT: usize = 384;
        const VALUE: usize = 160;
        /// More points than this take milliseconds.
        const MANY: usize = 500;
        let within = nearest.radius.map_or(1.0, |radius| {
            // The disk or the ball and its rim, generously.
            let density = placed.resolved.density;
            match nearest.at {
                Place::Plane(_) => (radius * density.sqrt() + 2.0).powi(2) * 4.0,
                Place::Space(_) => (radius * density.cbrt() + 2.0).powi(3) * 5.0,
            }
        });
        let most = nearest.k.unwrap_or(MOST_WITHIN).min(MOST_WITHIN);
        let most = match (nearest.k, nearest.radius) {
            (Some(_), None) => most,
            _ => most.min(within.ceil() as usize),
        };
        let values = placed.set.attributes.as_slice().len();
        let specs = placed.set.fields().map(|field| &field.spec);
        let has_ground = placed.set.terrain.is_some();
        Self {
            bytes: most * (POINT + values * VALUE),
            visit: VISIT
                + around(nearest, placed.resolved.density)
                    .map_or(0.0, |within| look(specs, within)),
            // In a field there may be nothing for long.
            lane: match most > MANY || placed.set.fields().next().is_some() || has_ground {
                true => Lane::Long,
                false => Lane::Short,
            },
        }
    }

    /// The most points that a search may visit, where counting may take this many rows.
    pub fn visits(&self, most_rows: u64) -> usize {
        (most_rows as f64 * ROW / self.visit) as usize
    }

    /// The points that a rate is charged: those found and those thinned out among them, or the microseconds of all
    /// visits if they are more.
    pub fn considered(&self, found: f64, visited: usize) -> u128 {
        (visited as f64 * self.visit / ROW).max(found).round() as u128
    }
}

/// The box around a place where its neighbors are, unless it is too far out.
fn around(nearest: &Nearest, density: f64) -> Option<Region> {
    let reach = nearest.radius.unwrap_or(0.0) + density.sqrt().recip();
    let [x, y] = nearest.at.flat();
    let corners = [[x - reach, y - reach], [x + reach, y + reach]];
    Region::new(corners[0], corners[1]).ok()
}
