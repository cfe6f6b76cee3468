//! Measures threshold masks, and draws a gradient dithered with each.
//!
//! `cargo run -p strew-forge --example masks -- TABLE [PICTURE.png]` prints, for masks of 64, 128 and 256 pixels, low
//! power and tallest peak of the pixels that are on at shares from 1/256 to 1/2, for the mask of the table, a random
//! order, a Bayer matrix, and up to 128 pixels for plain void and cluster, by brute force.

use std::{error::Error, fs, time::Instant};

use strew_core::Table;
use strew_forge::mask::Mask;

/// Seeds of each mask.
const SEEDS: u64 = 3;
/// The shares of pixels that are on.
const LEVELS: [f64; 10] = [
    1.0 / 256.0,
    1.0 / 64.0,
    1.0 / 32.0,
    1.0 / 16.0,
    3.0 / 32.0,
    1.0 / 8.0,
    5.0 / 32.0,
    3.0 / 16.0,
    1.0 / 4.0,
    1.0 / 2.0,
];

fn ranked(size: u32, key: impl Fn(u32, u32) -> u64) -> Result<Mask, Box<dyn Error>> {
    let mut order: Vec<u32> = (0..size * size).collect();
    order.sort_by_key(|&i| (key(i % size, i / size), i));
    let mut ranks = vec![0; order.len()];
    for (rank, pixel) in order.into_iter().enumerate() {
        ranks[pixel as usize] = rank as u32;
    }
    Ok(Mask::from_ranks(size, ranks)?)
}

/// The order of Bayer (1973): bits of x xor y and of y, the lowest first.
fn bayer(size: u32) -> Result<Mask, Box<dyn Error>> {
    let bits = size.trailing_zeros();
    ranked(size, |x, y| {
        (0..bits).fold(0, |key, bit| {
            let pair = 2 * ((x ^ y) >> bit & 1) + (y >> bit & 1);
            key << 2 | u64::from(pair)
        })
    })
}

fn white(size: u32, seed: u64) -> Result<Mask, Box<dyn Error>> {
    ranked(size, |x, y| {
        let mut z =
            (seed << 40 | u64::from(x) << 20 | u64::from(y)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    })
}

/// Void and cluster as Ulichney (1993) has it: from a tenth of the pixels in a random order, with a Gaussian of
/// σ = 1.5 pixels over the whole square.
fn void_and_cluster(size: u32, seed: u64) -> Result<Mask, Box<dyn Error>> {
    let side = size as usize;
    let pixels = side * side;
    let apart = |a: usize, b: usize| a.abs_diff(b).min(side - a.abs_diff(b));
    let gauss: Vec<f64> = (0..pixels)
        .map(|i| (-((i % side * (i % side) + i / side * (i / side)) as f64) / 4.5).exp())
        .collect();
    let weight =
        |a: usize, b: usize| gauss[apart(a / side, b / side) * side + apart(a % side, b % side)];
    let mut is_on: Vec<bool> = white(size, seed)?
        .ranks()
        .iter()
        .map(|&rank| rank < size * size / 10)
        .collect();
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
    for at in 0..pixels {
        if is_on[at] {
            is_on[at] = false;
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
    Ok(Mask::from_ranks(size, ranks)?)
}

fn print(name: &str, size: u32, masks: &[Mask]) {
    print!("{name:7}{size:4}");
    for level in LEVELS {
        let all: Vec<_> = masks.iter().map(|mask| mask.spectrum(level)).collect();
        let worst = |of: fn(&strew_forge::mask::LevelSpectrum) -> f64| {
            all.iter().map(of).fold(0.0, f64::max)
        };
        print!(" {:7.4}{:6.0}", worst(|s| s.low_power), worst(|s| s.peak));
    }
    println!();
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let table = arguments.next().ok_or("give a table")?;
    let table = Table::from_bytes(&fs::read(table)?)?;
    print!("           ");
    for level in LEVELS {
        print!(" {level:13.4}");
    }
    println!();
    for size in [64, 128, 256] {
        let start = Instant::now();
        let masks: Result<Vec<_>, _> = (0..SEEDS)
            .map(|seed| Mask::new(&table, size, seed))
            .collect();
        let masks = masks?;
        let time = start.elapsed() / SEEDS as u32;
        print("strew", size, &masks);
        if size <= 128 {
            let plain: Result<Vec<_>, _> = (0..SEEDS)
                .map(|seed| void_and_cluster(size, seed))
                .collect();
            print("voids", size, &plain?);
        }
        let random: Result<Vec<_>, _> = (0..SEEDS).map(|seed| white(size, seed)).collect();
        print("white", size, &random?);
        print("bayer", size, &[bayer(size)?]);
        println!("{time:.1?} for a mask of {size}");
    }
    if let Some(path) = arguments.next() {
        let size = 128;
        let masks = [white(size, 0)?, bayer(size)?, Mask::new(&table, size, 0)?];
        fs::write(path, gradients(&masks)?)?;
    }
    Ok(())
}

/// A gradient from black to white, dithered with each mask, one below another.
fn gradients(masks: &[Mask]) -> Result<Vec<u8>, Box<dyn Error>> {
    const SIDES: [usize; 2] = [768, 128];
    const GAP: usize = 12;
    let [width, height] = SIDES;
    let rows = masks.len() * (height + GAP) - GAP;
    let mut pixels = vec![255u8; width * rows];
    for (i, mask) in masks.iter().enumerate() {
        let thresholds: Vec<u16> = mask.thresholds(16).collect();
        let size = mask.size() as usize;
        for y in 0..height {
            for x in 0..width {
                let gray = x as f64 / (width - 1) as f64 * 65536.0;
                let is_on = gray > f64::from(thresholds[y % size * size + x % size]);
                pixels[(i * (height + GAP) + y) * width + x] = if is_on { 255 } else { 0 };
            }
        }
    }
    let mut file = vec![];
    let mut encoder = png::Encoder::new(&mut file, width as u32, rows as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    let bits = pixels.chunks(8).map(|eight| {
        eight
            .iter()
            .fold(0u8, |byte, &v| byte << 1 | u8::from(v > 0))
    });
    let bits: Vec<u8> = bits.collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&bits)?;
    writer.finish()?;
    Ok(file)
}
