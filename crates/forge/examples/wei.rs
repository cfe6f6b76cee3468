//! Multi-class dart throwing after Wei (2010), as other work describes it, beside the kinds of a table.
//!
//! `cargo run --release -p strew-forge --example wei -- [POINTS] [1:1 1:3 …]`. Prints low power and δ_min of each kind
//! and of all points, each in the units of its own density, and the time a point takes.
//!
//! Disks of two points of kinds i and j must be r_ij apart. r_ii follows from the density of the kind; between kinds it
//! is that of all kinds up to the denser of the two. The kind that is most behind throws next. A dart that meets only
//! denser kinds which are not behind removes the points in its way.

use std::{env, error::Error, time::Instant};

use strew_core::table::Shares;
use strew_forge::measure::{Distances, Spectrum, Torus};

/// The radius of a kind over that of the hexagonal lattice of its density: about as dense as darts get.
const RADIUS: f64 = 0.67;
/// The darts for each point after which a run has failed.
const MOST_DARTS: u64 = 20_000;

/// The distance in the hexagonal lattice of a density.
fn hexagonal(density: f64) -> f64 {
    (2.0 / (3f64.sqrt() * density)).sqrt()
}

/// The least distances between kinds, the rarest kind first.
fn distances(densities: &[f64]) -> Vec<Vec<f64>> {
    let kinds = densities.len();
    // Between two kinds it is that of all kinds up to the denser one.
    let up_to = |kind: usize| {
        let group = densities.iter().filter(|&&d| d <= densities[kind]);
        RADIUS * hexagonal(group.sum())
    };
    let apart = |i: usize, j: usize| match i == j {
        true => RADIUS * hexagonal(densities[i]),
        false => up_to(i.max(j)),
    };
    let row = |i: usize| (0..kinds).map(|j| apart(i, j)).collect();
    (0..kinds).map(row).collect()
}

/// Points on the unit torus in cells.
struct Darts {
    cells: Vec<Vec<([f64; 2], usize)>>,
    side: usize,
    distances: Vec<Vec<f64>>,
    counts: Vec<u64>,
    state: u64,
}

impl Darts {
    /// A number in [0, 1), by SplitMix64.
    fn random(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn cell(&self, [x, y]: [f64; 2]) -> [usize; 2] {
        [x, y].map(|v| ((v * self.side as f64) as usize).min(self.side - 1))
    }

    /// The points that are too near to a dart: cell, number in it, kind.
    fn conflicts(&self, at: [f64; 2], kind: usize) -> Vec<(usize, usize, usize)> {
        let largest = self.distances[kind].iter().copied().fold(0.0, f64::max);
        let reach = (largest * self.side as f64).ceil() as isize;
        let [column, row] = self.cell(at);
        let mut found = vec![];
        let wrapped =
            |i: usize, by: isize| (i as isize + by).rem_euclid(self.side as isize) as usize;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let cell = wrapped(row, dy) * self.side + wrapped(column, dx);
                for (number, (point, other)) in self.cells[cell].iter().enumerate() {
                    let [dx, dy] = [0, 1].map(|i| {
                        let d = (at[i] - point[i]).abs();
                        d.min(1.0 - d)
                    });
                    if dx * dx + dy * dy < self.distances[kind][*other].powi(2) {
                        found.push((cell, number, *other));
                    }
                }
            }
        }
        found
    }

    /// Throws a dart of a kind; whether it stays.
    fn throw(&mut self, kind: usize, wanted: &[u64]) -> bool {
        let at = [self.random(), self.random()];
        let mut conflicts = self.conflicts(at, kind);
        let filled = |counts: &[u64], kind: usize| counts[kind] as f64 / wanted[kind] as f64;
        let gives_way = |&(_, _, other): &(usize, usize, usize)| {
            self.distances[other][other] < self.distances[kind][kind]
                && filled(&self.counts, other) >= filled(&self.counts, kind)
        };
        if !conflicts.iter().all(gives_way) {
            return false;
        }
        conflicts.sort_unstable_by(|a, b| b.cmp(a));
        conflicts.dedup();
        for (cell, number, other) in conflicts {
            self.cells[cell].swap_remove(number);
            self.counts[other] -= 1;
        }
        let [column, row] = self.cell(at);
        self.cells[row * self.side + column].push((at, kind));
        self.counts[kind] += 1;
        true
    }
}

/// Low power and δ_min in the units of the set's own density.
fn figures(points: Vec<[f64; 2]>) -> String {
    let set = Torus::new(1.0, points);
    let low = Spectrum::of_torus(&set, 4.0).summary(1.0 / 64.0).low_power;
    format!("{low:.3} / {:.2}", Distances::of_torus(&set).delta_min)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = env::args().skip(1).peekable();
    let points: u64 = args
        .next_if(|a| !a.contains(':'))
        .map_or(Ok(7000), |a| a.parse())?;
    let named: Vec<String> = args.collect();
    let usual = ["1:1", "1:3", "1:1:2", "1:3:10"].map(String::from).to_vec();
    for shares in if named.is_empty() { usual } else { named } {
        let parsed: Shares = shares.parse()?;
        let mut parts = parsed.parts().to_vec();
        parts.sort_unstable();
        let total: u64 = parts.iter().map(|&part| u64::from(part)).sum();
        let wanted: Vec<u64> = parts
            .iter()
            .map(|&part| points * u64::from(part) / total)
            .collect();
        let densities: Vec<f64> = wanted.iter().map(|&n| n as f64).collect();
        let side = (points as f64).sqrt() as usize;
        let mut darts = Darts {
            cells: vec![vec![]; side * side],
            side,
            distances: distances(&densities),
            counts: vec![0; wanted.len()],
            state: 7,
        };
        let began = Instant::now();
        let mut thrown = 0;
        while darts
            .counts
            .iter()
            .zip(&wanted)
            .any(|(have, want)| have < want)
            && thrown < MOST_DARTS * points
        {
            let behind = |kind: &usize| darts.counts[*kind] as f64 / densities[*kind];
            let kind = (0..wanted.len())
                .min_by(|a, b| behind(a).total_cmp(&behind(b)))
                .unwrap_or(0);
            darts.throw(kind, &wanted);
            thrown += 1;
        }
        let took = began.elapsed().as_secs_f64();
        let of = |kind: usize| {
            let all = darts.cells.iter().flatten().filter(|(_, own)| *own == kind);
            all.map(|(at, _)| *at).collect::<Vec<_>>()
        };
        let kinds: Vec<String> = (0..wanted.len()).map(|kind| figures(of(kind))).collect();
        let union = darts.cells.iter().flatten().map(|(at, _)| *at).collect();
        let have: u64 = darts.counts.iter().sum();
        println!(
            "{shares}: {have} of {points} points, {:.1} µs and {:.0} darts a point; low power / δ_min of kinds {}, of all {}",
            1e6 * took / have as f64,
            thrown as f64 / have as f64,
            kinds.join(", "),
            figures(union),
        );
    }
    Ok(())
}
