//! Measures threshold masks, and draws a gradient dithered with each.
//!
//! `cargo run -p strew-forge --example masks -- TABLE [PICTURE.png]` prints, for masks of 64, 128 and 256 pixels, low
//! power and tallest peak of the pixels that are on at 1/16, 1/8, 1/4 and 1/2, for the mask of the table, a random
//! order and a Bayer matrix.

use std::{error::Error, fs, time::Instant};

use strew_core::Table;
use strew_forge::mask::Mask;

/// Seeds of each mask of a table.
const SEEDS: u64 = 3;

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

fn white(size: u32) -> Result<Mask, Box<dyn Error>> {
    ranked(size, |x, y| {
        let mut z = (u64::from(x) << 32 | u64::from(y)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    })
}

fn print(name: &str, size: u32, masks: &[Mask]) {
    print!("{name:6} {size:4}");
    for level in [1.0 / 16.0, 0.125, 0.25, 0.5] {
        let all: Vec<_> = masks.iter().map(|mask| mask.spectrum(level)).collect();
        let worst = |of: fn(&strew_forge::mask::LevelSpectrum) -> f64| {
            all.iter().map(of).fold(0.0, f64::max)
        };
        print!("  {:8.5} {:6.0}", worst(|s| s.low_power), worst(|s| s.peak));
    }
    println!();
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let table = arguments.next().ok_or("give a table")?;
    let table = Table::from_bytes(&fs::read(table)?)?;
    println!("              1/16             1/8             1/4             1/2");
    for size in [64, 128, 256] {
        let start = Instant::now();
        let masks: Result<Vec<_>, _> = (0..SEEDS)
            .map(|seed| Mask::new(&table, size, seed))
            .collect();
        let masks = masks?;
        let time = start.elapsed() / SEEDS as u32;
        print("strew", size, &masks);
        print("white", size, &[white(size)?]);
        print("bayer", size, &[bayer(size)?]);
        println!("{time:.1?} for a mask of {size}");
    }
    if let Some(path) = arguments.next() {
        let size = 128;
        let masks = [white(size)?, bayer(size)?, Mask::new(&table, size, 0)?];
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
