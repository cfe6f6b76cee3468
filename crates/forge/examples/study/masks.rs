//! Measures threshold masks of 64, 128 and 256 pixels: low power and tallest peak of the pixels that are on at shares
//! from 1/256 to 1/2, for the mask of the table, a random order, a Bayer matrix, and up to 128 pixels for plain void and
//! cluster, by brute force. A picture has a gradient dithered with each.

use std::{path::Path, time::Instant};

use strew_forge::{
    figure::Drawing,
    mask::{LevelSpectrum, Mask},
    numeric::SplitMix,
};

use crate::{Arguments, Outcome, figures, paint};

/// Seeds of each mask.
const SEEDS: u64 = 3;
/// The shares of pixels that are on, in 256ths.
const LEVELS: [u8; 10] = [1, 4, 8, 16, 24, 32, 40, 48, 64, 128];

pub fn study(mut arguments: Arguments) -> Outcome {
    let table = arguments.table()?;
    let columns = LEVELS.map(|level| format!("{level}/256: low power | peak"));
    figures::head(&format!("mask | {}", columns.join(" | ")));
    let mut times = vec![];
    for size in [64, 128, 256] {
        let all = |make: &dyn Fn(u64) -> Outcome<Mask>| (0..SEEDS).map(make).collect();
        let start = Instant::now();
        let masks: Outcome<Vec<_>> = all(&|seed| Ok(Mask::new(&table, size, seed)?));
        times.push(start.elapsed().as_secs_f64() / SEEDS as f64);
        print("strew", size, masks?);
        if size <= 128 {
            print("voids", size, all(&|seed| void_and_cluster(size, seed))?);
        }
        print("white", size, all(&|seed| Ok(white(size, seed)))?);
        print("bayer", size, vec![bayer(size)]);
    }
    figures::head("pixels | 64 | 128 | 256");
    figures::row("seconds", &times);
    for path in arguments.rest()? {
        let masks = [white(128, 0), bayer(128), Mask::new(&table, 128, 0)?];
        let mut drawing = Drawing::new(768.0, 408.0);
        for (mask, top) in masks.iter().zip([0.0, 140.0, 280.0]) {
            drawing.cells([[0.0, top], [768.0, 128.0]], 768, gradient(mask));
        }
        paint::save(Path::new(&path), &drawing, [768.0, 408.0])?;
    }
    Ok(())
}

fn print(name: &str, size: u32, masks: Vec<Mask>) {
    let worst = |level: &u8| {
        let level = f64::from(*level) / 256.0;
        let all: Vec<_> = masks.iter().map(|mask| mask.spectrum(level)).collect();
        let worst = |of: fn(&LevelSpectrum) -> f64| all.iter().map(of).fold(0.0, f64::max);
        [worst(|s| s.low_power), worst(|s| s.peak)]
    };
    let numbers: Vec<f64> = LEVELS.iter().flat_map(worst).collect();
    figures::row(format!("{name} {size}"), &numbers);
}

/// A gradient from black to white of 768 × 128 pixels, dithered with a mask.
fn gradient(mask: &Mask) -> Vec<u8> {
    let thresholds: Vec<u16> = mask.thresholds(16).collect();
    let size = mask.size() as usize;
    let shade = |i: usize| {
        let (x, y) = (i % 768, i / 768);
        let gray = x as f64 / 767.0 * 65536.0;
        let is_on = gray > f64::from(thresholds[y % size * size + x % size]);
        if is_on { 255 } else { 0 }
    };
    (0..768 * 128).map(shade).collect()
}

/// The order of Bayer (1973): bits of x xor y and of y, the lowest first.
fn bayer(size: u32) -> Mask {
    let bits = size.trailing_zeros();
    Mask::by_key(size, |x, y| {
        (0..bits).fold(0, |key, bit| {
            let pair = 2 * ((x ^ y) >> bit & 1) + (y >> bit & 1);
            key << 2 | u64::from(pair)
        })
    })
}

/// A random order.
fn white(size: u32, seed: u64) -> Mask {
    Mask::by_key(size, |x, y| {
        let place = seed << 40 | u64::from(x) << 20 | u64::from(y);
        // The number with this place in the sequence of the generator.
        let before = place.wrapping_sub(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        SplitMix::new(before).next_u64()
    })
}

/// Void and cluster as Ulichney (1993) has it: from a tenth of the pixels in a random order, with a Gaussian of
/// σ = 1.5 pixels over the whole square.
fn void_and_cluster(size: u32, seed: u64) -> Outcome<Mask> {
    let side = size as usize;
    let pixels = side * side;
    let apart = |a: usize, b: usize| a.abs_diff(b).min(side - a.abs_diff(b));
    let square = |i: usize| (i % side).pow(2) + (i / side).pow(2);
    let gauss: Vec<f64> = (0..pixels)
        .map(|i| (-(square(i) as f64) / 4.5).exp())
        .collect();
    let weight =
        |a: usize, b: usize| gauss[apart(a / side, b / side) * side + apart(a % side, b % side)];
    let mut is_on = vec![false; pixels];
    let mut energies = vec![0.0; pixels];
    let flip = |at: usize, energies: &mut [f64], is_on: &mut [bool]| {
        is_on[at] = !is_on[at];
        let sign = if is_on[at] { 1.0 } else { -1.0 };
        for (other, energy) in energies.iter_mut().enumerate() {
            *energy += sign * weight(at, other);
        }
    };
    let tightest = |energies: &[f64], is_on: &[bool]| {
        let on = (0..pixels).filter(|&at| is_on[at]);
        on.max_by(|&a, &b| energies[a].total_cmp(&energies[b]))
    };
    let largest = |energies: &[f64], is_on: &[bool]| {
        let off = (0..pixels).filter(|&at| !is_on[at]);
        off.min_by(|&a, &b| energies[a].total_cmp(&energies[b]))
    };
    for (at, &rank) in white(size, seed).ranks().iter().enumerate() {
        if rank < size * size / 10 {
            flip(at, &mut energies, &mut is_on);
        }
    }
    // The pixel of the tightest cluster goes into the largest void, until that is where it came from.
    while let Some(from) = tightest(&energies, &is_on) {
        flip(from, &mut energies, &mut is_on);
        let to = largest(&energies, &is_on).ok_or("no void")?;
        flip(to, &mut energies, &mut is_on);
        if from == to {
            break;
        }
    }
    let mut ranks = vec![0; pixels];
    let mut left: Vec<usize> = (0..pixels).filter(|&at| is_on[at]).collect();
    let few = left.len();
    while !left.is_empty() {
        // Summed anew: the rest of a difference would hide the weights of far pixels.
        let energy = |&at: &usize| -> f64 { left.iter().map(|&other| weight(at, other)).sum() };
        let sums: Vec<f64> = left.iter().map(energy).collect();
        let last = (0..left.len()).max_by(|&a, &b| sums[a].total_cmp(&sums[b]));
        let at = left.swap_remove(last.ok_or("no cluster")?);
        ranks[at] = left.len() as u32;
    }
    for rank in few..pixels {
        let at = largest(&energies, &is_on).ok_or("no void")?;
        flip(at, &mut energies, &mut is_on);
        ranks[at] = rank as u32;
    }
    Ok(Mask::by_key(size, |x, y| ranks[(y * size + x) as usize]))
}
