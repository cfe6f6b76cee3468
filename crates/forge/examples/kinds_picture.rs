//! Draws kinds by chance, by labels and of a joint table side by side, in squares as they are served, with a seed
//! and its warp.
//!
//! `cargo run --release -p strew-forge --example kinds_picture -- TABLE 1:3 OUT.png [--side 26] [--pixels 12]`: `side`
//! is that of a square in mean spacings, `pixels` those of a spacing.

use std::{error::Error, fs::File, io::BufWriter, path::Path};

use strew_core::{PointSet, Region, Table, table::Shares};
use strew_forge::{MixJob, labels, mix, read_table};

/// The colors of the background and of the kinds, the rarest first.
const PALETTE: [[u8; 3]; 6] = [
    [255, 255, 255],
    [20, 60, 150],
    [230, 120, 0],
    [120, 180, 90],
    [190, 30, 90],
    [90, 90, 90],
];
/// Steps between a kind's color and white, for smooth edges.
const SHADES: usize = 4;
const SEED: u64 = 5;
const CORNER: [f64; 2] = [12_345.0, -6_789.0];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |name: &str, default: f64| {
        let at = arguments.iter().position(|a| a == name);
        let found = at.and_then(|at| arguments.get(at + 1));
        found.map_or(Ok(default), |text| text.parse::<f64>())
    };
    let [file, shares, out] = arguments.first_chunk().ok_or("TABLE SHARES OUT.png")?;
    let (side, pixels) = (number("--side", 26.0)?, number("--pixels", 12.0)?);
    let shares: Shares = shares.parse()?;
    let table = read_table(Path::new(file))?;
    let labeled = labels(&table, &shares, &())?.ok_or("stopped")?;
    let joint = mix(&table, &MixJob::joint(shares.clone()), &())?.ok_or("stopped")?;
    let squares = [
        square(&table, side, |_, id| by_chance(&shares, id))?,
        square(&labeled, side, PointSet::kind_of)?,
        square(&joint.table, side, PointSet::kind_of)?,
    ];
    let width = (side * pixels) as usize;
    let gap = 8;
    let mut image = Image::new(3 * width + 2 * gap, width);
    for (column, points) in squares.iter().enumerate() {
        let left = column * (width + gap);
        for &([x, y], kind) in points {
            image.disk(
                [x * pixels, y * pixels],
                0.34 * pixels,
                kind,
                left..left + width,
            );
        }
    }
    image.write(Path::new(out))
}

type Points = Vec<([f64; 2], u8)>;

/// The points of a square, with their kinds.
fn square(
    table: &Table,
    side: f64,
    kind: impl Fn(&PointSet, strew_core::PointId) -> Option<u8>,
) -> Result<Points, Box<dyn Error>> {
    let set = PointSet::new(table.clone()).seed(SEED);
    let region = Region::new(CORNER, CORNER.map(|v| v + side))?;
    let mut points = Points::new();
    for member in set.within(region)?.iter() {
        let [x, y] = member.at();
        let kind = kind(&set, member.id()).ok_or("no kind")?;
        points.push(([x - CORNER[0], y - CORNER[1]], kind));
    }
    Ok(points)
}

/// A kind drawn by a hash of the id.
fn by_chance(shares: &Shares, id: strew_core::PointId) -> Option<u8> {
    let mut random = strew_forge::numeric::SplitMix::new(id.x as u64);
    let mut random = strew_forge::numeric::SplitMix::new(random.next_u64() ^ id.y as u64);
    let mut drawn = random.next_f64();
    (0..shares.kinds() as u8).find(|&kind| {
        drawn -= shares.of(kind);
        drawn < 0.0
    })
}

/// A picture with a palette.
struct Image {
    width: usize,
    colors: Vec<u8>,
}

impl Image {
    fn new(width: usize, height: usize) -> Self {
        let colors = vec![0; width * height];
        Self { width, colors }
    }

    /// Draws a disk into some columns, the first of which is at x = 0.
    fn disk(&mut self, [x, y]: [f64; 2], radius: f64, kind: u8, columns: std::ops::Range<usize>) {
        let height = self.colors.len() / self.width;
        for row in 0..height {
            let dy = row as f64 + 0.5 - y;
            if dy.abs() > radius + 1.0 {
                continue;
            }
            for column in columns.clone() {
                let dx = (column - columns.start) as f64 + 0.5 - x;
                let inside = radius + 0.5 - (dx * dx + dy * dy).sqrt();
                let shade = (inside.clamp(0.0, 1.0) * SHADES as f64).round() as usize;
                if shade > 0 {
                    let color = usize::from(kind) * SHADES + shade;
                    self.colors[row * self.width + column] = color as u8;
                }
            }
        }
    }

    fn write(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let [paper, kinds @ ..] = PALETTE;
        let mut palette = paper.to_vec();
        for color in kinds {
            for shade in 1..=SHADES {
                let mixed = color.iter().zip(paper).map(|(&c, p)| {
                    let part = shade as f64 / SHADES as f64;
                    (f64::from(c) * part + f64::from(p) * (1.0 - part)) as u8
                });
                palette.extend(mixed);
            }
        }
        let height = self.colors.len() / self.width;
        let file = BufWriter::new(File::create(path)?);
        let mut encoder = png::Encoder::new(file, self.width as u32, height as u32);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette);
        encoder.set_compression(png::Compression::High);
        encoder.write_header()?.write_image_data(&self.colors)?;
        Ok(())
    }
}
