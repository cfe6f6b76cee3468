//! Pictures of sets side by side, in gray.

use std::{error::Error, fs::File, io::BufWriter, path::Path};

use strew_core::{
    PointSet, Region,
    field::{FieldSpec, Marks, Noise},
};

use crate::sets::Case;

/// The corner of pictures of the plane.
const CORNER: [f64; 2] = [12_345.0, -6_789.0];
/// Columns between two pictures.
const GAP: usize = 12;

/// Draws a forest or a set of the [cases](Case) for each number of steps, or shares.
pub fn draw(
    all: &PointSet,
    what: &str,
    out: &Path,
    steps: &[f64],
    seed: u64,
) -> Result<(), Box<dyn Error>> {
    let mut pictures = Vec::new();
    match what {
        "shares" => {
            for share in [0.25, 0.0625, 0.04, 0.005f64] {
                let set = all.clone().seed(seed).keep(share)?;
                pictures.push(Picture::of(&set, 32.0 / share.sqrt(), 400)?);
            }
        }
        "forest" => {
            let forest = all.clone().seed(seed).in_field(forest()?);
            for &steps in steps {
                let set = forest.clone().settle(steps as u32)?;
                pictures.push(Picture::of(&set, 110.0, 700)?);
            }
        }
        name => {
            let case = Case::all()
                .into_iter()
                .find(|case| case.name.starts_with(name));
            let case = case.ok_or("no such set")?;
            let (set, _) = case.set(all, seed, CORNER[0])?;
            for &steps in steps {
                let set = set.clone().settle(steps as u32)?;
                pictures.push(Picture::of(&set, case.side(3000.0), 900)?);
            }
        }
    }
    write(&pictures, out)
}

/// Natural patches, a bare road through them, and a straight edge of a field at their right.
fn forest() -> Result<FieldSpec, strew_core::Error> {
    let at = |x: f64, y: f64| [CORNER[0] + x, CORNER[1] + y];
    let patches = FieldSpec::noise(Noise {
        seed: 3,
        wavelength: 60.0,
        octaves: 3,
        range: [0.0, 1.0],
    })?;
    let patches = patches.curve(vec![[0.3, 0.08], [0.7, 1.0]])?;
    let way = vec![
        at(-5.0, 20.0),
        at(35.0, 34.0),
        at(60.0, 60.0),
        at(75.0, 120.0),
    ];
    let road = FieldSpec::distance(Marks::Lines(vec![way]), [2.0, 2.001], [0.0, 1.0])?;
    let edge = FieldSpec::ramp(at(112.0, 0.0), at(112.004, 0.001), [1.0, 0.0])?;
    FieldSpec::multiply(vec![patches, road, edge])
}

/// A square picture.
struct Picture {
    width: usize,
    gray: Vec<f64>,
}

impl Picture {
    /// Draws a square of a set.
    fn of(set: &PointSet, side: f64, width: usize) -> Result<Self, Box<dyn Error>> {
        let mut picture = Self {
            width,
            gray: vec![1.0; width * width],
        };
        let scale = width as f64 / side;
        // Points of all pictures cover about a tenth of the plane where it is densest.
        let local = (set.placement().keep.get()).sqrt().recip();
        let radius = 0.2 * scale * local;
        let region = Region::new(CORNER.map(|v| v - 1.0), CORNER.map(|v| v + side + 1.0))?;
        for member in set.within(region)?.to_vec() {
            let [x, y] = [member.x - CORNER[0], member.y - CORNER[1]];
            picture.disk([x * scale, (side - y) * scale], radius.max(0.9));
        }
        Ok(picture)
    }

    fn disk(&mut self, at: [f64; 2], radius: f64) {
        let range = |v: f64| {
            let low = (v - radius - 1.0).max(0.0) as usize;
            low..((v + radius + 2.0).max(0.0) as usize).min(self.width)
        };
        for row in range(at[1]) {
            for column in range(at[0]) {
                let far = (column as f64 + 0.5 - at[0]).hypot(row as f64 + 0.5 - at[1]);
                let covered = (radius + 0.5 - far).clamp(0.0, 1.0);
                self.gray[row * self.width + column] *= 1.0 - covered;
            }
        }
    }
}

/// Writes pictures side by side, in 16 shades.
fn write(pictures: &[Picture], out: &Path) -> Result<(), Box<dyn Error>> {
    let height = pictures.first().map_or(0, |picture| picture.width);
    let width = pictures.len() * (height + GAP) - GAP;
    let mut bytes = Vec::new();
    for row in 0..height {
        let mut line = vec![15u8; width.next_multiple_of(2)];
        for (column, picture) in pictures.iter().enumerate() {
            let from = column * (height + GAP);
            let gray = &picture.gray[row * height..][..height];
            for (to, gray) in line[from..].iter_mut().zip(gray) {
                *to = (gray * 15.0).round() as u8;
            }
        }
        bytes.extend(line.chunks_exact(2).map(|two| two[0] << 4 | two[1]));
    }
    let file = BufWriter::new(File::create(out)?);
    let mut encoder = png::Encoder::new(file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Four);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&bytes)?;
    Ok(())
}
