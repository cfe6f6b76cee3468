//! Measures thinned sets as they are served: windows of 60,000 points at shares from 1/2 to 1/64.
//!
//! `cargo run --release -p strew-forge --example served -- TABLE [--seed 3] [--warp 1]` prints the mean power below
//! ν = 0.5, the tallest mode below ν = 0.8 over the mean of its ring, and δ_min. With `--svg` it writes a picture
//! instead: shares 1/4, 1/16, 1/25 and 1/200.

use std::{error::Error, path::Path};

use strew_core::{PointSet, Region};
use strew_forge::{
    measure::{Distances, Spectrum, Window},
    read_table,
};

/// The number of points of a window.
const POINTS: f64 = 60_000.0;
/// The width of a ring.
const RING: f64 = 0.02;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |name: &str, default: f64| {
        let at = arguments.iter().position(|a| a == name);
        let found = at.and_then(|at| arguments.get(at + 1));
        found.map_or(Ok(default), |text| text.parse::<f64>())
    };
    let table = read_table(Path::new(arguments.first().ok_or("which table?")?))?;
    let all = PointSet::new(table).seed(number("--seed", 3.0)? as u64);
    let all = all.warp(number("--warp", 1.0)?)?;
    if arguments.iter().any(|a| a == "--svg") {
        return draw(&all);
    }
    println!("share points low tallest/ring delta_min");
    for octave in 1..=6 {
        let share = (-f64::from(octave)).exp2();
        let side = (POINTS / share).sqrt();
        let set = all.clone().keep(share)?;
        // Away from the origin, where seed 0 is no usual place.
        let corner = [12_345.0, -6_789.0];
        let region = Region::new(corner, corner.map(|v| v + side))?;
        let points = set.within(region)?.to_vec();
        let placed = points.iter().map(|p| [p.x - corner[0], p.y - corner[1]]);
        let window = Window::new(side, share, placed.collect());
        let spectrum = Spectrum::of_window(&window, 1.0);
        println!(
            "1/{} {} {:.3e} {:.1} {:.3}",
            1 << octave,
            points.len(),
            spectrum.summary(0.04).low_power,
            tallest(&spectrum, window.side()),
            Distances::of_window(&window).delta_min
        );
    }
    Ok(())
}

/// Draws squares of 32 spacings of the thinned sets.
fn draw(all: &PointSet) -> Result<(), Box<dyn Error>> {
    const SIDE: f64 = 32.0;
    println!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 134 32' width='1600' height='382'>"
    );
    println!("<rect width='134' height='32' fill='white'/>");
    for (column, share) in [0.25, 0.0625, 0.04, 0.005].into_iter().enumerate() {
        let set = all.clone().keep(share)?;
        let local = (1.0 / share).sqrt();
        let region = Region::new([0.0; 2], [SIDE * local; 2])?;
        let left = column as f64 * (SIDE + 2.0);
        println!("<g transform='translate({left} 0)'>");
        for p in set.within(region)?.to_vec() {
            let [x, y] = [p.x / local, p.y / local];
            println!("<circle cx='{x:.2}' cy='{y:.2}' r='0.2'/>");
        }
        println!("</g>");
    }
    println!("</svg>");
    Ok(())
}

/// The tallest mode below ν = 0.8, over the mean of its ring.
fn tallest(spectrum: &Spectrum, side: f64) -> f64 {
    let most = (0.8 * side) as i64;
    let mut rings = vec![(0.0, 0.0, 0.0f64); (0.8 / RING) as usize + 1];
    for kx in -most..=most {
        for ky in -most..=most {
            let nu = ((kx * kx + ky * ky) as f64).sqrt() / side;
            // The taper spreads what is at 0 over a few modes.
            if nu > 4.0 / side && nu < 0.8 {
                let power = spectrum.at(kx, ky).unwrap_or(0.0);
                let (count, sum, most) = &mut rings[(nu / RING) as usize];
                *count += 1.0;
                *sum += power;
                *most = most.max(power);
            }
        }
    }
    let over = rings.iter().filter(|ring| ring.0 > 0.0);
    over.map(|(count, sum, most)| most * count / sum)
        .fold(0.0, f64::max)
}
