//! The noise of Strew's points beside that of other ways to place them: the figures of `strew_core::comparison`.

use fast_poisson::Poisson2D;
use strew_core::{PointSet, Twin};
use strew_forge::{
    measure::{Sample, twin_set},
    numeric::SplitMix,
    read_table,
};

use crate::{
    Arguments, Outcome, figures,
    ground::{places, square},
};

/// The side of the windows of different methods, in mean spacings.
const SIDE: f64 = 300.0;
/// A small table.
const SMALL: &str = "../catalog/tables/blue-5-sqrt3-over-2-s.strew";

pub fn study(_: Arguments) -> Outcome {
    // One point at random in each cell of a grid.
    let mut random = SplitMix::new(7);
    let cells = SIDE as i32;
    let jittered = (0..cells * cells).map(|cell| [cell % cells, cell / cells]);
    let jittered = jittered.map(|cell| cell.map(|v| f64::from(v) + random.next_f64()));
    let jittered = jittered.collect();
    let independent = SplitMix::new(7).places((cells * cells) as usize, SIDE);
    // A radius of 0.84 makes about one point a unit of area.
    let disks = Poisson2D::new().with_dimensions([SIDE, SIDE], 0.84);
    let strew = square(&PointSet::blue().seed(7), [0.0; 2], SIDE)?;
    figures::head_of_sets("");
    for (name, points) in [
        ("Strew, blue, seed 7", places(&strew)),
        ("fast_poisson", disks.with_seed(7).generate()),
        ("jittered grid", jittered),
        ("a repeated tile", tiled()?),
        ("random", independent),
    ] {
        let density = points.len() as f64 / (SIDE * SIDE);
        let set = Sample::window(SIDE, density, points);
        figures::measured(name.into(), &set, &[]);
    }
    Ok(())
}

/// A toroidal tile of 5,041 blue points, repeated.
fn tiled() -> Outcome<Vec<[f64; 2]>> {
    let table = read_table(&std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(SMALL))?;
    let tile = twin_set(&table, Twin::new(183, 112).ok_or("no fraction")?).ok_or("no twin")?;
    let repeats = (SIDE / tile.side()).ceil() as i32;
    let corners = (0..repeats).flat_map(|j| (0..repeats).map(move |i| [i, j].map(f64::from)));
    let mut points = Vec::new();
    for corner in corners {
        let moved = |p: &[f64; 2]| [0, 1].map(|i| p[i] + corner[i] * tile.side());
        points.extend(tile.points().iter().map(moved));
    }
    points.retain(|at| at.iter().all(|v| (0.0..SIDE).contains(v)));
    Ok(points)
}
