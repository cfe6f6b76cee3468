//! The noise of Strew's points beside that of other ways to place them: the figures of `strew_core::comparison`.

use fast_poisson::Poisson2D;
use strew_core::{PointSet, Twin};
use strew_forge::{
    Report, Resolution,
    measure::{Window, twin_set},
    numeric::SplitMix,
};

use crate::{
    Outcome,
    arguments::Arguments,
    figures,
    sets::{places, square},
};

/// The side of the windows, in mean spacings.
const SIDE: f64 = 300.0;

pub fn study(_: Arguments) -> Outcome {
    println!("Windows of {SIDE}² mean spacings:\n");
    figures::print_head(&[]);
    // One point at random in each cell of a grid.
    let mut random = SplitMix::new(7);
    let cells = SIDE as i32;
    let jittered = (0..cells * cells)
        .map(|cell| [cell % cells, cell / cells].map(|v| f64::from(v) + random.next_f64()));
    let jittered = jittered.collect();
    let mut random = SplitMix::new(7);
    let independent = (0..cells * cells).map(|_| [0, 1].map(|_| random.next_f64() * SIDE));
    // A radius of 0.84 makes about one point a unit of area.
    let disks = Poisson2D::new().with_dimensions([SIDE, SIDE], 0.84);
    let strew = square(&PointSet::blue().seed(7), [0.0; 2], SIDE)?;
    for (name, points) in [
        ("Strew, blue, seed 7", places(&strew)),
        ("fast_poisson", disks.with_seed(7).generate()),
        ("jittered grid", jittered),
        ("a repeated tile", tiled()?),
        ("random", independent.collect()),
    ] {
        let density = points.len() as f64 / (SIDE * SIDE);
        let set = Window::new(SIDE, density, points);
        let report = Report::of_window(name.into(), false, &set, Resolution::default());
        figures::print(&report.figures, &[]);
    }
    Ok(())
}

/// A toroidal tile of 5,041 blue points, repeated.
fn tiled() -> Outcome<Vec<[f64; 2]>> {
    let twin = Twin::new(183, 112).ok_or("no fraction")?;
    let tile = twin_set(PointSet::blue().table(), twin).ok_or("no twin")?;
    let repeats = (SIDE / tile.side()).ceil() as i32;
    let mut points = Vec::new();
    for (i, j) in (0..repeats).flat_map(|j| (0..repeats).map(move |i| (i, j))) {
        let corner = [i, j].map(|v| f64::from(v) * tile.side());
        let moved = tile
            .points()
            .iter()
            .map(|p| [0, 1].map(|i| p[i] + corner[i]));
        points.extend(moved.filter(|at| at.iter().all(|v| (0.0..SIDE).contains(v))));
    }
    Ok(points)
}
