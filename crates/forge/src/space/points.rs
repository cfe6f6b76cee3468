//! Points to measure: a cube of an unbounded set, or one period of a twin.

use strew_core::{
    Error, Twin,
    space::{Region, SpaceSet, Table},
};

use crate::measure::Sample;

/// The points of a cube of a set. `at`, its least corner, and `side` are in mean spacings of the whole set, as if none had
/// been left out by [`keep`](SpaceSet::keep).
///
/// # Errors
/// As [`SpaceSet::within`].
pub fn window_set(set: &SpaceSet, at: [f64; 3], side: f64) -> Result<Sample<3>, Error> {
    let placement = set.placement();
    let spacing = placement.spacing.get();
    let min = at.map(|v| v * spacing);
    let plan = set.within(Region::new(min, at.map(|v| (v + side) * spacing))?)?;
    let place = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] / spacing - at[i]);
    let points = plan.iter().map(|point| place(point.at())).collect();
    Ok(Sample::window(side, placement.keep.get(), points))
}

/// One period of a twin of a table's map, or `None` if it is none, or has points on a sublattice only (see
/// [`is_uniform_in_space`]).
///
/// ```
/// use strew_core::{Twin, space::Table};
/// use strew_forge::space::twin_set;
///
/// let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 11, "pattern")?;
/// let twin = |p, q| Twin::new(p, q).expect("coprime");
/// // t = 19 is odd and q = 30 is even: 19³ points.
/// let points = twin_set(&table, twin(49, 30)).expect("a twin");
/// assert_eq!((points.points().len(), points.side()), (6859, 19.0));
/// assert!(twin_set(&table, twin(71, 45)).is_none());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[must_use]
pub fn twin_set(table: &Table, twin: Twin) -> Option<Sample<3>> {
    let (map, n) = (table.map(), table.map().intervals());
    if !is_uniform_in_space(twin) {
        return None;
    }
    // Along each axis a coordinate and the parity of the sum of the others decide the block, as in the plane.
    let mut blocks = [
        vec![None; twin.period() as usize],
        vec![None; twin.period() as usize],
    ];
    for site in twin.sites(map)? {
        blocks[site.y as usize % 2][site.x as usize] = Some(site.block_x as usize);
    }
    let members = |own: usize, others: usize| -> Vec<(usize, usize)> {
        let all = blocks[others].iter().enumerate();
        let own = all.filter(|(v, _)| v % 2 == own);
        own.filter_map(|(v, block)| Some((v, (*block)?))).collect()
    };
    let mut points = Vec::with_capacity(twin.t().pow(3) as usize);
    for class in 0..8usize {
        let parities = [class & 1, class >> 1 & 1, class >> 2];
        let [xs, ys, zs] = [0, 1, 2].map(|axis| {
            let own = parities[axis];
            members(own, (parities.iter().sum::<usize>() - own) % 2)
        });
        for &(z, k) in &zs {
            for &(y, j) in &ys {
                for &(x, i) in &xs {
                    let vector = table.vectors()[(k * n + j) * n + i];
                    let at = [x, y, z];
                    let by = vector.map(|v| f64::from(v) / 4096.0);
                    points.push([0, 1, 2].map(|axis| at[axis] as f64 + by[axis]));
                }
            }
        }
    }
    Some(Sample::torus(twin.period() as f64, points))
}

/// Whether a period of a twin has each triple of indices in space once: t = p − q is odd, and q is even. The points of
/// other twins lie on a sublattice of indices, so they do not show what a table is worth.
///
/// ```
/// use strew_core::Twin;
/// use strew_forge::space::is_uniform_in_space;
///
/// let uniform = |p, q| is_uniform_in_space(Twin::new(p, q).expect("coprime"));
/// assert!(uniform(85, 52) && !uniform(71, 45) && !uniform(153, 97));
/// ```
#[must_use]
pub const fn is_uniform_in_space(twin: Twin) -> bool {
    !twin.t().is_multiple_of(2) && twin.q().is_multiple_of(2)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use strew_core::{Map, table::Provenance};

    use super::*;
    use crate::numeric::SplitMix;

    #[test]
    fn a_twin_has_the_points_that_the_definition_has() {
        let map = Map::new("(5-sqrt(3))/2".parse().expect("valid"), 6).expect("small");
        let n = map.intervals();
        let mut random = SplitMix::new(3);
        let mut next = || (random.next_u64() % 8000) as i16 - 4000;
        let vectors = (0..n.pow(3)).map(|_| [next(), next(), next()]).collect();
        let table = Table::new(map, "mine", vectors, Provenance::default(), None).expect("valid");
        let all = table.map().twins();
        let twin = all
            .into_iter()
            .find(|t| is_uniform_in_space(*t) && t.t() > 6);
        let twin = twin.expect("endless");
        let points = twin_set(&table, twin).expect("a twin");
        assert_eq!(points.points().len() as u64, twin.t().pow(3));
        // {(αv + others)/2}, in units of 1/2q; its block is the rank of the index among all thresholds.
        let (p, q, t) = (twin.p() as i64, twin.q() as i64, twin.t() as i64);
        let index = |v: i64, others: i64| (p * v + q * others).rem_euclid(2 * q);
        let r = i64::from(table.map().radius());
        let mut bounds: Vec<i64> = (-r - 1..=r)
            .flat_map(|k| [0, 1].map(|b| index(-k, b)))
            .filter(|bound| (1..t).contains(bound))
            .collect();
        bounds.sort_unstable();
        bounds.dedup();
        assert_eq!(bounds.len() + 1, n);
        let block = |index: i64| bounds.iter().filter(|bound| **bound <= index).count();
        let mut expected = BTreeMap::new();
        // Off the middles between two keys, where rounding would decide.
        let key = |p: [f64; 3]| p.map(|v| (v * 1e9 + 0.3137) as i64 % 1_000_000_000);
        for z in 0..2 * q {
            for y in 0..2 * q {
                for x in 0..2 * q {
                    let d = [index(x, y + z), index(y, x + z), index(z, x + y)];
                    if d.iter().all(|d| *d < t) {
                        let [i, j, k] = d.map(block);
                        let v = table.vectors()[(k * n + j) * n + i];
                        let at = [0, 1, 2].map(|axis| {
                            let place = [x, y, z][axis] as f64 + f64::from(v[axis]) / 4096.0;
                            (place / (2 * q) as f64).rem_euclid(1.0)
                        });
                        *expected.entry(key(at)).or_insert(0) += 1;
                    }
                }
            }
        }
        let mut found = BTreeMap::new();
        for point in points.points() {
            let turns = point.map(|v| (v / points.side()).rem_euclid(1.0));
            *found.entry(key(turns)).or_insert(0) += 1;
        }
        assert_eq!(found, expected);
    }
}
