//! Threshold masks: tileable squares of pixels in an order, for dithering and halftoning.
//!
//! Every pixel has a rank, and the pixels of rank below a share are spread evenly at every share, across the seam, too.
//! The order begins with the points of a period, scaled to the grid: an eighth of the pixels. The rest is void and
//! cluster (Ulichney 1993). Of the eighth, the pixel in the tightest cluster leaves first, until few are left, which
//! are ordered by their distances. These few have the lowest ranks. From them on the largest void is filled next, until
//! few pixels are off. The other points of the period are not kept, because points and filled voids are spread in
//! different ways, and a mask that kept them would show where they end. All energies are integers, so a mask is the
//! same on every machine.

use rustfft::num_complex::Complex;
use strew_core::{PeriodicSet, Table};

use crate::{
    figure::png_file,
    measure::{Summary, of_grid, ring_sums},
};

mod voids;

use self::voids::{Choice, Voids, few_ordered};

pub use crate::SettingError as MaskError;

/// A square of pixels that tiles, with the order in which they turn on.
///
/// ```
/// use strew_core::Table;
/// use strew_forge::mask::Mask;
///
/// let table = Table::undisplaced("(5-sqrt(3))/2".parse()?, 49, "pattern")?;
/// let mask = Mask::new(&table, 32, 7)?;
/// let mut ranks = mask.ranks().to_vec();
/// ranks.sort_unstable();
/// assert!(ranks.into_iter().eq(0..32 * 32));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    size: u32,
    /// The rank of each pixel, row by row.
    ranks: Vec<u32>,
}

impl Mask {
    /// The smallest side.
    pub const LEAST_SIZE: u32 = 16;
    /// The largest side: making it takes some seconds.
    pub const MOST_SIZE: u32 = 1024;

    /// The mask of a table and a seed, `size` pixels wide and high.
    pub fn new(table: &Table, size: u32, seed: u64) -> Result<Self, MaskError> {
        let mask = Self::new_while(table, size, seed, |_| true)?;
        Ok(mask.unwrap_or_else(|| unreachable!("nothing stops it")))
    }

    /// As [`Mask::new`], while `goes_on` returns true, which is called with the number of pixels that come next, or `None`.
    pub fn new_while(
        table: &Table,
        size: u32,
        seed: u64,
        mut goes_on: impl FnMut(usize) -> bool,
    ) -> Result<Option<Self>, MaskError> {
        /// A few milliseconds of work.
        const STEP: usize = 1000;
        /// One of this number of pixels is left by the clusters: with fewer, voids are wider than the kernel.
        const FEW: usize = 56;
        if !(Self::LEAST_SIZE..=Self::MOST_SIZE).contains(&size) {
            let [least, most] = [Self::LEAST_SIZE, Self::MOST_SIZE];
            let allowed = format!("an integer from {least} to {most} pixels");
            return Err(MaskError::new("size", size, allowed));
        }
        let pixels = (size * size) as usize;
        let first = first(table, size, seed)?;
        let few = pixels / FEW;
        let mut ranks = vec![0; pixels];
        let mut voids = Voids::new(size as usize, &first);
        voids.choose(Choice::Clusters);
        for rank in (few..first.len()).rev() {
            if rank.is_multiple_of(STEP) && !goes_on(STEP) {
                return Ok(None);
            }
            voids.flip();
        }
        let lowest = few_ordered(size as usize, &voids.those(true), &mut goes_on);
        voids.choose(Choice::Voids);
        for rank in few..pixels - few {
            if rank.is_multiple_of(STEP) && !goes_on(STEP) {
                return Ok(None);
            }
            ranks[voids.flip()] = rank as u32;
        }
        let last = few_ordered(size as usize, &voids.those(false), &mut goes_on);
        for (rank, pixel) in (0..).zip(lowest).chain((0..size * size).rev().zip(last)) {
            ranks[pixel] = rank;
        }
        Ok(goes_on(0).then_some(Self { size, ranks }))
    }

    /// The number of pixels that turn off and on while a mask of a side is made, and of the few twice more.
    pub fn steps(size: u32) -> u64 {
        u64::from(size).pow(2) * 8 / 7
    }

    /// A mask whose pixels turn on by ascending keys of their columns and rows, equal ones row by row: to compare other
    /// masks with.
    pub fn by_key<K: Ord>(size: u32, key: impl Fn(u32, u32) -> K) -> Self {
        let mut order: Vec<u32> = (0..size * size).collect();
        order.sort_by_key(|&i| key(i % size, i / size));
        let mut ranks = vec![0; order.len()];
        for (rank, pixel) in (0..).zip(order) {
            ranks[pixel as usize] = rank;
        }
        Self { size, ranks }
    }

    /// The side in pixels.
    pub const fn size(&self) -> u32 {
        self.size
    }

    /// The rank of each pixel, row by row: each number below size² once.
    pub fn ranks(&self) -> &[u32] {
        &self.ranks
    }

    /// The thresholds of pixels, from 0 up to 2^`bits`: rank · 2^`bits` / size², rounded down. A pixel is on
    /// where the gray, from 0 to 2^`bits`, is above its threshold.
    pub fn thresholds(&self, bits: u8) -> impl Iterator<Item = u16> + '_ {
        let pixels = self.ranks.len() as u64;
        let levels = 1u64 << bits.min(16);
        let ranks = self.ranks.iter();
        ranks.map(move |&rank| (u64::from(rank) * levels / pixels) as u16)
    }

    /// The thresholds as bytes, those of 16 bits by a function.
    fn bytes(&self, bits: u8, wide: fn(u16) -> [u8; 2]) -> Result<Vec<u8>, MaskError> {
        let thresholds = self.thresholds(bits);
        match bits {
            8 => Ok(thresholds.map(|v| v as u8).collect()),
            16 => Ok(thresholds.flat_map(wide).collect()),
            _ => Err(MaskError::new("bits", bits, "8 or 16")),
        }
    }

    /// The mask as a file of NumPy's: an array of `u1` or `u2`, rows from the top.
    pub fn to_npy(&self, bits: u8) -> Result<Vec<u8>, MaskError> {
        let bytes = self.bytes(bits, u16::to_le_bytes)?;
        let (side, kind) = (self.size, if bits == 8 { "|u1" } else { "<u2" });
        let text =
            format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({side}, {side}), }}");
        // Magic, version and the length of the text, which fills 128 bytes with them.
        let mut file = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
        file.extend_from_slice(text.as_bytes());
        file.resize(127, b' ');
        file.push(b'\n');
        file.extend_from_slice(&bytes);
        Ok(file)
    }

    /// The mask as a gray PNG file of 8 or 16 bits.
    pub fn to_png(&self, bits: u8) -> Result<Vec<u8>, MaskError> {
        let bytes = self.bytes(bits, u16::to_be_bytes)?;
        let depth = match bits {
            8 => png::BitDepth::Eight,
            _ => png::BitDepth::Sixteen,
        };
        let gray = (png::ColorType::Grayscale, depth);
        let file = png_file([self.size; 2], gray, png::Compression::default(), &bytes);
        file.map_err(|error| MaskError::new("bits", bits, error.to_string()))
    }
}

/// An eighth of the pixels: those of the points of lowest rank in a period on the grid, each once.
fn first(table: &Table, size: u32, seed: u64) -> Result<Vec<usize>, MaskError> {
    let wanted = u64::from(size) * u64::from(size) / 8;
    let set = PeriodicSet::new(table.clone(), wanted)?;
    let set = set.side(f64::from(size))?.seed(seed);
    let mut points: Vec<(f64, usize)> = set
        .iter()
        .map(|point| {
            let [x, y] = point.at().map(|v| v as usize);
            let rank = set.rank(point.id()).unwrap_or(1.0);
            (rank, y * size as usize + x)
        })
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut is_taken = vec![false; (size * size) as usize];
    let mut pixels: Vec<usize> = points.into_iter().map(|(_, pixel)| pixel).collect();
    pixels.retain(|&pixel| !std::mem::replace(&mut is_taken[pixel], true));
    pixels.truncate(wanted as usize);
    Ok(pixels)
}

/// The spectrum of the pixels of a mask that are on at a level.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelSpectrum {
    /// The share of pixels that are on.
    pub level: f64,
    /// The mean power over 0 < ν < 0.5, ν in units of √N of the N pixels that are on, or off if those are fewer.
    /// Pixels in a random order have 1.
    pub low_power: f64,
    /// The tallest single peak.
    pub peak: f64,
    /// The mean power over rings of width 0.05 of ν from 0 up to 2, or to the corner of the spectrum.
    pub rings: Vec<f64>,
}

impl LevelSpectrum {
    /// The width of a ring.
    pub const RING: f64 = 0.05;
    /// The number of rings.
    const RINGS: usize = 40;
}

impl Mask {
    /// The spectrum of the pixels whose rank is below a share of all, from 0 to 1: the mean over frequencies of
    /// |Σ (on − share) exp(−2πi k·x)|² ÷ (size²·share·(1 − share)).
    pub fn spectrum(&self, level: f64) -> LevelSpectrum {
        let size = self.size as usize;
        let pixels = size * size;
        let on = ((level.clamp(0.0, 1.0) * pixels as f64).round() as usize).clamp(1, pixels - 1);
        let share = on as f64 / pixels as f64;
        let is_on = |rank: u32| f64::from(u8::from((rank as usize) < on));
        let ranks = self.ranks.iter();
        let values = ranks.map(|&rank| Complex::new(is_on(rank) - share, 0.0));
        let values = of_grid(values.collect(), size, 2);
        let unit = (pixels as f64 * share.min(1.0 - share)).sqrt();
        let scale = pixels as f64 * share * (1.0 - share);
        let modes = values.iter().enumerate().skip(1);
        let modes = modes.map(|(i, value)| {
            let frequency = |k: usize| k.min(size - k) as f64;
            let nu = frequency(i % size).hypot(frequency(i / size)) / unit;
            (nu, value.norm_sqr() / scale)
        });
        let summary = Summary::of(modes.clone(), &[]);
        let rings = ring_sums(modes, LevelSpectrum::RING, LevelSpectrum::RINGS);
        let mean = |[count, _, total, ..]: [f64; 5]| total / count.max(1.0);
        LevelSpectrum {
            level: share,
            low_power: summary.low_power,
            peak: summary.tallest,
            rings: rings.into_iter().map(mean).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::SplitMix;

    /// Ranks in an order hashed by SplitMix64.
    fn white(size: u32) -> Mask {
        let hashed = |x, y| SplitMix::new(u64::from(y * size + x)).next_u64();
        Mask::by_key(size, hashed)
    }

    #[test]
    fn random_pixels_have_power_one() {
        for level in [0.125, 0.25, 0.5] {
            let spectrum = white(128).spectrum(level);
            assert!((spectrum.low_power - 1.0).abs() < 0.25, "{spectrum:?}");
            assert!(spectrum.peak < 30.0);
        }
    }

    #[test]
    fn a_lattice_is_nothing_but_peaks() {
        // Every second pixel of every second row comes first.
        let mask = Mask::by_key(32, |x, y| x % 2 + 2 * (y % 2));
        let spectrum = mask.spectrum(0.25);
        assert!(spectrum.low_power < 1e-20);
        // Three peaks share all of the variance.
        assert!((spectrum.peak - 1024.0 / 3.0).abs() < 1e-6);
    }
}
