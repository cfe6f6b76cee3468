//! The noise of Strew's points beside that of other ways to place them: the figures of
//! `strew_core::comparison`.
//!
//! ```sh
//! cargo run --release -p strew-forge --example comparison
//! ```

use fast_poisson::Poisson2D;
use strew_core::{PointSet, Region, Twin};
use strew_forge::{
    judge::figures_of_window,
    measure::{Window, twin_set},
    numeric::SplitMix,
};

/// The side of the windows, in mean spacings.
const SIDE: f64 = 300.0;

fn main() {
    println!("windows of {SIDE}² mean spacings");
    println!(
        "{:<24} {:>8} {:>11} {:>9} {:>9} {:>14} {:>9}",
        "", "points", "low power", "δ_min", "δ_avg", "anisotropy dB", "peak"
    );
    for (name, points) in [
        ("Strew, blue, seed 7", strew()),
        ("fast_poisson", poisson_disks()),
        ("jittered grid", jittered()),
        ("a repeated tile", tiled()),
        ("random", random()),
    ] {
        let density = points.len() as f64 / (SIDE * SIDE);
        let set = Window::new(SIDE, density, points);
        let figures = figures_of_window(name.into(), false, &set, 4.0);
        let value = |name| figures.value(name).unwrap_or(f64::NAN);
        println!(
            "{name:<24} {:>8} {:>11.1e} {:>9.3} {:>9.3} {:>14.2} {:>9.0}",
            figures.points,
            value("low_power"),
            value("delta_min"),
            value("delta_avg"),
            value("anisotropy_db"),
            value("tallest_peak")
        );
    }
}

fn strew() -> Vec<[f64; 2]> {
    let region = Region::new([0.0, 0.0], [SIDE, SIDE]).expect("ordered");
    let plan = PointSet::blue().seed(7).within(region).expect("near");
    plan.iter().map(|member| member.at()).collect()
}

/// Poisson disks; a radius of 0.84 makes about one point a unit of area.
fn poisson_disks() -> Vec<[f64; 2]> {
    Poisson2D::new()
        .with_dimensions([SIDE, SIDE], 0.84)
        .with_seed(7)
        .generate()
}

/// One point at random in each cell of a grid.
fn jittered() -> Vec<[f64; 2]> {
    let mut random = SplitMix::new(7);
    let cells = SIDE as i32;
    (0..cells * cells)
        .map(|cell| [cell % cells, cell / cells].map(|v| f64::from(v) + random.next_f64()))
        .collect()
}

/// A toroidal tile of 5,041 blue points, repeated.
fn tiled() -> Vec<[f64; 2]> {
    let set = PointSet::blue();
    let tile = twin_set(set.table(), Twin::new(183, 112).expect("a fraction")).expect("a twin");
    let spacing = tile.side() / (tile.points().len() as f64).sqrt();
    let side = tile.side() / spacing;
    let repeats = (SIDE / side).ceil() as i32;
    let mut points = Vec::new();
    for (i, j) in (0..repeats).flat_map(|j| (0..repeats).map(move |i| (i, j))) {
        for point in tile.points() {
            let at = [
                point[0] / spacing + f64::from(i) * side,
                point[1] / spacing + f64::from(j) * side,
            ];
            if at.iter().all(|v| (0.0..SIDE).contains(v)) {
                points.push(at);
            }
        }
    }
    points
}

fn random() -> Vec<[f64; 2]> {
    let mut random = SplitMix::new(7);
    let count = (SIDE * SIDE) as usize;
    (0..count)
        .map(|_| [random.next_f64() * SIDE, random.next_f64() * SIDE])
        .collect()
}
