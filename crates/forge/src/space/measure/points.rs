//! Points to measure: a cube of an unbounded set, or one period of a twin.

use strew_core::{
    Error, Twin,
    space::{Region, SpaceSet, Table},
};

/// Points in a cube: a window of an unbounded set, or one period of a periodic one.
#[derive(Clone, Debug, PartialEq)]
pub struct SpacePoints {
    /// The points, in units of the cube's side.
    points: Vec<[f64; 3]>,
    side: f64,
    is_torus: bool,
}

impl SpacePoints {
    /// The points of a cube of a set. `at`, its least corner, and `side` are in mean spacings of the whole set, as if none
    /// had been left out by [`keep`](SpaceSet::keep).
    ///
    /// # Errors
    /// As [`SpaceSet::within`].
    pub fn of_window(set: &SpaceSet, at: [f64; 3], side: f64) -> Result<Self, Error> {
        let placement = set.placement();
        let spacing = placement.spacing.get();
        let min = at.map(|v| v * spacing);
        let max = at.map(|v| (v + side) * spacing);
        let plan = set.within(Region::new(min, max)?)?;
        let size = side * spacing;
        let place = |p: [f64; 3]| [0, 1, 2].map(|i| (p[i] - min[i]) / size);
        Ok(Self {
            points: plan.iter().map(|point| place(point.at())).collect(),
            side: side * libm::cbrt(placement.keep.get()),
            is_torus: false,
        })
    }

    /// One period of a twin of a table's map, or `None` if it is none, or has points on a sublattice only (see
    /// [`is_uniform_in_space`]).
    ///
    /// ```
    /// use strew_core::{Twin, space::Table};
    /// use strew_forge::space::SpacePoints;
    ///
    /// let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 11, "pattern")?;
    /// let twin = |p, q| Twin::new(p, q).expect("coprime");
    /// // t = 19 is odd and q = 30 is even: 19³ points.
    /// let points = SpacePoints::of_twin(&table, twin(49, 30)).expect("a twin");
    /// assert_eq!((points.points().len(), points.side()), (6859, 19.0));
    /// assert!(SpacePoints::of_twin(&table, twin(71, 45)).is_none());
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn of_twin(table: &Table, twin: Twin) -> Option<Self> {
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
        let period = twin.period() as f64;
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
                        points.push([0, 1, 2].map(|axis| {
                            let place = at[axis] as f64 + f64::from(vector[axis]) / 4096.0;
                            let turns = place / period;
                            // Below 1 even if it rounds.
                            (turns - turns.floor()).min(1.0 - f64::EPSILON)
                        }));
                    }
                }
            }
        }
        Some(Self {
            points,
            side: twin.t() as f64,
            is_torus: true,
        })
    }

    /// Any points in [0, 1)³, of a periodic set if `is_torus`, at their own density.
    #[must_use]
    pub fn new(points: Vec<[f64; 3]>, is_torus: bool) -> Self {
        Self {
            side: libm::cbrt(points.len() as f64),
            points,
            is_torus,
        }
    }

    /// The points, in units of the cube's side.
    #[must_use]
    pub fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// The side of the cube, in mean spacings of these points.
    #[must_use]
    pub const fn side(&self) -> f64 {
        self.side
    }

    /// Whether the points repeat beyond the cube.
    #[must_use]
    pub const fn is_torus(&self) -> bool {
        self.is_torus
    }

    /// The weights of a taper, unless the points repeat: the Hann window of their places.
    pub(super) fn taper(&self) -> Option<Vec<f64>> {
        let turn = 2.0 * std::f64::consts::PI;
        let weight = |p: &[f64; 3]| p.map(|v| 1.0 - libm::cos(turn * v)).iter().product();
        (!self.is_torus).then(|| self.points.iter().map(weight).collect())
    }
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
        let points = SpacePoints::of_twin(&table, twin).expect("a twin");
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
        let key = |p: [f64; 3]| p.map(|v| (v * 1e9).round() as i64 % 1_000_000_000);
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
            assert!(point.iter().all(|v| (0.0..1.0).contains(v)));
            *found.entry(key(*point)).or_insert(0) += 1;
        }
        assert_eq!(found, expected);
    }
}
