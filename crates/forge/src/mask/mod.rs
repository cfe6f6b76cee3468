//! Threshold masks: tileable squares of pixels in an order, for dithering and halftoning.
//!
//! Every pixel has a rank, and the pixels of rank below a share are spread evenly at every share, across the seam, too.
//! The order begins with the points of a period, scaled to the grid: an eighth of the pixels. The rest is void and
//! cluster (Ulichney 1993). Of the eighth, the pixel in the tightest cluster leaves first, until few are left, which
//! are ordered by their distances. These few have the lowest ranks. From them on the largest void is filled next, until
//! few pixels are off. The other points of the period are not kept, because points and filled voids are spread in
//! different ways, and a mask that kept them would show where they end. All energies are integers, so a mask is the
//! same on every machine.

mod few;
mod spectrum;
mod voids;

use strew_core::{PeriodicSet, Table};

pub use crate::SettingError as MaskError;
pub use spectrum::LevelSpectrum;
use voids::{Choice, Voids};

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
    ///
    /// # Errors
    /// [`MaskError`] if the size is out of range or the table has no periods.
    pub fn new(table: &Table, size: u32, seed: u64) -> Result<Self, MaskError> {
        let Some(mask) = Self::new_while(table, size, seed, || true)? else {
            unreachable!("nothing stops it");
        };
        Ok(mask)
    }

    /// As [`Mask::new`], while `goes_on` returns true: it is called every thousand pixels. `None` if it was stopped.
    ///
    /// # Errors
    /// As [`Mask::new`].
    pub fn new_while(
        table: &Table,
        size: u32,
        seed: u64,
        mut goes_on: impl FnMut() -> bool,
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
        let mut goes_on = |rank: usize| !rank.is_multiple_of(STEP) || goes_on();
        let mut voids = Voids::new(size as usize, &first);
        voids.choose(Choice::Clusters);
        for rank in (few..first.len()).rev() {
            if !goes_on(rank) {
                return Ok(None);
            }
            voids.flip();
        }
        for (rank, pixel) in few::ordered(size as usize, &voids.those(true))
            .into_iter()
            .enumerate()
        {
            ranks[pixel] = rank as u32;
        }
        voids.choose(Choice::Voids);
        for rank in few..pixels - few {
            if !goes_on(rank) {
                return Ok(None);
            }
            ranks[voids.flip()] = rank as u32;
        }
        let last = few::ordered(size as usize, &voids.those(false));
        for (rank, pixel) in (0..pixels).rev().zip(last) {
            ranks[pixel] = rank as u32;
        }
        Ok(Some(Self { size, ranks }))
    }

    /// A mask whose pixels turn on by ascending keys of their columns and rows, equal ones row by row: to compare other
    /// masks with.
    #[must_use]
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
    #[must_use]
    pub const fn size(&self) -> u32 {
        self.size
    }

    /// The rank of each pixel, row by row: each number below size² once.
    #[must_use]
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

    /// The mask as a file of NumPy's: an array of `u1` or `u2`, rows from the top.
    ///
    /// # Errors
    /// [`MaskError`] for a number of bits besides 8 and 16.
    pub fn to_npy(&self, bits: u8) -> Result<Vec<u8>, MaskError> {
        let thresholds = self.thresholds(bits);
        let (kind, bytes): (_, Vec<u8>) = match bits {
            8 => ("|u1", thresholds.map(|v| v as u8).collect()),
            16 => ("<u2", thresholds.flat_map(u16::to_le_bytes).collect()),
            _ => return Err(MaskError::new("bits", bits, "8 or 16")),
        };
        let side = self.size;
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
    ///
    /// # Errors
    /// [`MaskError`] for another number of bits.
    pub fn to_png(&self, bits: u8) -> Result<Vec<u8>, MaskError> {
        let thresholds = self.thresholds(bits);
        let (depth, bytes): (_, Vec<u8>) = match bits {
            8 => (png::BitDepth::Eight, thresholds.map(|v| v as u8).collect()),
            16 => (
                png::BitDepth::Sixteen,
                thresholds.flat_map(u16::to_be_bytes).collect(),
            ),
            _ => return Err(MaskError::new("bits", bits, "8 or 16")),
        };
        let write = || {
            let mut file = vec![];
            let mut encoder = png::Encoder::new(&mut file, self.size, self.size);
            encoder.set_color(png::ColorType::Grayscale);
            encoder.set_depth(depth);
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&bytes)?;
            writer.finish()?;
            Ok::<_, png::EncodingError>(file)
        };
        write().map_err(|error| MaskError::new("bits", bits, error.to_string()))
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
