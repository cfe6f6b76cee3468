//! Multi-class dart throwing after Wei (2010), as other work describes it, beside the kinds of a table: figures of each
//! kind, the rarest first, and of all points, each in the units of its own density, and what a point takes.
//!
//! Disks of two points of kinds i and j must be r_ij apart. r_ii follows from the density of the kind; between kinds it
//! is that of all kinds up to the denser of the two. The kind that is most behind throws next. A dart that meets only
//! denser kinds which are not behind removes the points in its way.

use std::time::Instant;

use strew_core::table::Shares;
use strew_forge::{measure::Sample, numeric::SplitMix};

use crate::{Arguments, Outcome, figures, ground::HEXAGONAL};

/// The radius of a kind over that of the hexagonal lattice of its density: about as dense as darts get.
const RADIUS: f64 = 0.67;
/// The darts for each point after which a run has failed.
const MOST_DARTS: u64 = 20_000;

pub fn study(mut arguments: Arguments) -> Outcome {
    let points: u64 = arguments.value("--points", "7000")?;
    let mut all = arguments.rest()?;
    if all.is_empty() {
        all = ["1:1", "1:3", "1:1:2", "1:3:10"].map(String::from).to_vec();
    }
    figures::head_of_sets(" | µs a point | darts a point");
    for shares in all {
        let parsed: Shares = shares.parse()?;
        let mut parts = parsed.parts().to_vec();
        parts.sort_unstable();
        let total = u64::from(parsed.total());
        let wanted = parts.iter().map(|&part| points * u64::from(part) / total);
        let mut darts = Darts::new(points, wanted.map(|n| n as f64).collect());
        let began = Instant::now();
        let mut thrown = 0;
        while let Some(kind) = darts.behind()
            && thrown < MOST_DARTS * points
        {
            darts.throw(kind);
            thrown += 1;
        }
        let took = began.elapsed().as_secs_f64();
        let print = |subject: String, kind: Option<usize>, more: &[f64]| {
            let own = darts.cells.iter().flatten();
            let own = own.filter(|(_, own)| kind.is_none_or(|kind| *own == kind));
            let set = Sample::torus(1.0, own.map(|(at, _)| *at).collect());
            figures::measured(subject, &set, more);
        };
        for kind in 0..parts.len() {
            print(format!("{shares}, kind {kind}"), Some(kind), &[]);
        }
        let have: f64 = darts.counts.iter().sum();
        let more = [1e6 * took / have, thrown as f64 / have];
        print(format!("{shares}, all of {points}"), None, &more);
    }
    Ok(())
}

/// Points on the unit torus in cells.
struct Darts {
    cells: Vec<Vec<([f64; 2], usize)>>,
    side: usize,
    /// The least distances between kinds, the rarest kind first.
    distances: Vec<Vec<f64>>,
    counts: Vec<f64>,
    wanted: Vec<f64>,
    random: SplitMix,
}

impl Darts {
    fn new(points: u64, wanted: Vec<f64>) -> Self {
        let apart = |density: f64| RADIUS * HEXAGONAL / density.sqrt();
        // Between two kinds it is that of all kinds up to the denser one.
        let up_to = |kind: usize| wanted.iter().filter(|&&d| d <= wanted[kind]).sum();
        let row = |i: usize| {
            let distance = |j: usize| apart(if i == j { wanted[i] } else { up_to(i.max(j)) });
            (0..wanted.len()).map(distance).collect()
        };
        let side = (points as f64).sqrt() as usize;
        Self {
            cells: vec![vec![]; side * side],
            side,
            distances: (0..wanted.len()).map(row).collect(),
            counts: vec![0.0; wanted.len()],
            wanted,
            random: SplitMix::new(7),
        }
    }

    fn filled(&self, kind: usize) -> f64 {
        self.counts[kind] / self.wanted[kind]
    }

    /// The kind that is most behind.
    fn behind(&self) -> Option<usize> {
        let kinds = 0..self.wanted.len();
        let most = kinds.min_by(|&a, &b| self.filled(a).total_cmp(&self.filled(b)));
        most.filter(|&kind| self.filled(kind) < 1.0)
    }

    fn cell(&self, at: [f64; 2]) -> [usize; 2] {
        at.map(|v| ((v * self.side as f64) as usize).min(self.side - 1))
    }

    /// The points that are too near to a dart: cell, number in it, kind.
    fn conflicts(&self, at: [f64; 2], kind: usize) -> Vec<(usize, usize, usize)> {
        let largest = self.distances[kind].iter().copied().fold(0.0, f64::max);
        let reach = (largest * self.side as f64).ceil() as isize;
        let [columns, rows] = self.cell(at).map(|middle| {
            let (middle, side) = (middle as isize, self.side as isize);
            (-reach..=reach).map(move |by| (middle + by).rem_euclid(side) as usize)
        });
        let mut found = vec![];
        for cell in rows.flat_map(|row| columns.clone().map(move |c| row * self.side + c)) {
            for (number, (point, other)) in self.cells[cell].iter().enumerate() {
                let apart = |i: usize| (at[i] - point[i]).abs();
                let [dx, dy] = [0, 1].map(|i| apart(i).min(1.0 - apart(i)));
                if dx * dx + dy * dy < self.distances[kind][*other].powi(2) {
                    found.push((cell, number, *other));
                }
            }
        }
        found
    }

    /// Throws a dart of a kind. It stays if every dart in conflict with it can be removed.
    fn throw(&mut self, kind: usize) {
        let at = [0, 1].map(|_| self.random.next_f64());
        let mut conflicts = self.conflicts(at, kind);
        let gives_way = |&(_, _, other): &(usize, usize, usize)| {
            self.distances[other][other] < self.distances[kind][kind]
                && self.filled(other) >= self.filled(kind)
        };
        if !conflicts.iter().all(gives_way) {
            return;
        }
        conflicts.sort_unstable_by(|a, b| b.cmp(a));
        conflicts.dedup();
        for (cell, number, other) in conflicts {
            self.cells[cell].swap_remove(number);
            self.counts[other] -= 1.0;
        }
        let [column, row] = self.cell(at);
        self.cells[row * self.side + column].push((at, kind));
        self.counts[kind] += 1.0;
    }
}
