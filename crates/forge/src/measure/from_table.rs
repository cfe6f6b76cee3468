//! Point sets made with a table: one period of a twin, or a window of the unbounded pattern.

use std::ops::Range;

use strew_core::{
    Map, Pattern, Table, Twin,
    pattern::{Axis, Class, IndexOrigin},
    table::to_grid_units,
};

use super::Sample;
use crate::numeric::SplitMix;

/// Returns one period of a twin, displaced, or `None` if it is no twin of the table's map.
#[must_use]
pub fn twin_set(table: &Table, twin: Twin) -> Option<Sample> {
    let n = table.map().intervals();
    let points = twin
        .sites(table.map())?
        .iter()
        .map(|site| {
            let [dx, dy] = table.displacements()[site.block_y as usize * n + site.block_x as usize];
            [
                f64::from(site.x) + to_grid_units(dx),
                f64::from(site.y) + to_grid_units(dy),
            ]
        })
        .collect();
    Some(Sample::torus(twin.period() as f64, points))
}

/// Returns a window of about `points` points of the unbounded displaced pattern of the table's own
/// α, at a place chosen by `seed`.
#[must_use]
pub fn window_set(table: &Table, points: u64, seed: u64) -> Sample {
    let map = table.map();
    let density = map.alpha().set_side_f64() * map.alpha().set_side_f64();
    let side = (points as f64 / density).sqrt();
    let mut random = SplitMix::new(seed);
    let origin = IndexOrigin {
        x: random.next_u64(),
        y: random.next_u64(),
    };
    let pattern = Pattern::with_origin(map.alpha(), origin);
    let longest = table
        .displacements()
        .iter()
        .flatten()
        .map(|v| v.abs())
        .max();
    let margin = to_grid_units(longest.unwrap_or(0)).ceil() as i64 + 1;
    let range = -margin..side.ceil() as i64 + margin;

    let mut found = Vec::with_capacity(points as usize + points as usize / 8);
    for class in Class::ALL {
        let columns: Vec<(i64, usize)> = members(&pattern, map, Axis::X, class, range.clone());
        for (y, by) in members(&pattern, map, Axis::Y, class, range.clone()) {
            for &(x, bx) in &columns {
                let [dx, dy] = table.displacements()[by * map.intervals() + bx];
                found.push([x as f64 + to_grid_units(dx), y as f64 + to_grid_units(dy)]);
            }
        }
    }
    Sample::window(side, density, found)
}

/// The columns (or rows, along [`Axis::Y`]) of a class in a range, each with its interval.
fn members(
    pattern: &Pattern,
    map: &Map,
    axis: Axis,
    class: Class,
    range: Range<i64>,
) -> Vec<(i64, usize)> {
    let other = match axis {
        Axis::X => class.y,
        Axis::Y => class.x,
    };
    pattern
        .axis_set(axis, class)
        .iter(range)
        .filter_map(|v| Some((v, map.interval_of(pattern.axis_index(axis, v, other))?)))
        .collect()
}

#[cfg(test)]
mod tests {
    use strew_core::{Table, table::Provenance};

    use super::*;
    use crate::numeric::SplitMix;

    /// A table of random vectors of up to ±2 grid units.
    fn table() -> Table {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 20).expect("small");
        let blocks = map.intervals() * map.intervals();
        let mut random = SplitMix::new(9);
        let mut next = || (random.next_u64() % (1 << 22)) as i32 - (1 << 21);
        let vectors = (0..blocks).map(|_| [next(), next()]).collect();
        Table::new(map, "blue", vectors, Provenance::default()).expect("valid")
    }

    #[test]
    fn a_window_is_complete() {
        // The oracle: every lattice point of a wider box, tested one by one.
        let table = table();
        let (map, n) = (table.map(), table.map().intervals());
        let window = window_set(&table, 900, 5);
        let mut random = SplitMix::new(5);
        let (x, y) = (random.next_u64(), random.next_u64());
        let pattern = Pattern::with_origin(map.alpha(), IndexOrigin { x, y });
        let side = window.side() / map.alpha().set_side_f64();
        let mut expected = Vec::new();
        for y in -140..300 {
            for x in -140..300 {
                let (dx, dy) = pattern.index(x, y);
                if let (Some(bx), Some(by)) = (map.interval_of(dx), map.interval_of(dy)) {
                    let [dx, dy] = table.displacements()[by * n + bx].map(to_grid_units);
                    let p = [x as f64 + dx, y as f64 + dy];
                    expected.extend(p.iter().all(|v| (0.0..side).contains(v)).then_some(p));
                }
            }
        }
        let sorted = |points: &[[f64; 2]], scale: f64| {
            let mut all: Vec<_> = points
                .iter()
                .map(|p| p.map(|v| (v * scale * 1e6).round() as i64))
                .collect();
            all.sort_unstable();
            all
        };
        assert!((850..950).contains(&expected.len()));
        let found = sorted(window.points(), 1.0);
        assert_eq!(found, sorted(&expected, map.alpha().set_side_f64()));
    }

    #[test]
    fn a_twin_has_its_points_at_unit_density() {
        let table = table();
        let twin = table.map().twins().next().expect("endless");
        let set = twin_set(&table, twin).expect("a twin");
        assert_eq!(set.points().len() as u64, twin.points());
        assert_eq!(set.side(), twin.t() as f64);
        assert!(twin_set(&table, Twin::new(3, 2).expect("coprime")).is_none());
    }
}
