//! Pixels: numbers in rows, and their bounds over squares.

use alloc::{format, string::ToString as _, sync::Arc, vec::Vec};
use core::ops::RangeInclusive;

use super::definition::Canon;
use crate::{
    error::{Error, ErrorKind, number},
    stop::Stop,
    table::Digest,
};

/// The least and the greatest number of a square of pixels.
pub(super) type Ends = [f32; 2];

/// The width of the squares of the finest level of bounds, in pixels.
const SQUARE: usize = 8;

/// The largest number of pixels that bounds are taken from one by one.
const FEW: usize = 64;

/// The stored numbers.
#[derive(Clone, Debug)]
pub(super) enum Store {
    /// 255 is 1.
    Bytes(Vec<u8>),
    /// 65535 is 1.
    Words(Vec<u16>),
    /// As they are.
    Floats(Vec<f32>),
}

/// Rows of numbers, from the least y upward: shares for a [`Raster`](crate::Raster), heights for a
/// [`Terrain`](super::Terrain).
///
/// They are stored as they come, in 1, 2 or 4 bytes each, and clones share them. Bounds over squares of
/// 8 pixels and more take another 0.17 bytes a pixel.
///
/// ```
/// use strew_core::field::Pixels;
///
/// let pixels = Pixels::from_bytes(2, vec![0, 255, 51, 102])?;
/// assert_eq!(pixels.size(), [2, 2]);
/// assert_eq!(pixels.clone().digest(), pixels.digest());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pixels(Arc<Stored>);

#[derive(Debug)]
struct Stored {
    size: [usize; 2],
    store: Store,
    /// 1 where a pixel has a number and 0 where it is missing, if any is. A missing one repeats a number that is there,
    /// so that bounds are those of the others.
    present: Option<Pixels>,
    /// The bounds of squares of pixels; each level has squares of twice the width of the one before.
    levels: Vec<Level>,
    digest: Digest,
}

#[derive(Clone, Debug)]
struct Level {
    size: [usize; 2],
    ends: Vec<Ends>,
}

impl Pixels {
    /// The most columns and rows.
    pub const MAX_SIDE: usize = 1 << 20;

    /// Pixels of 8 bits, `width` a row; 255 is 1.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless there are whole rows, at least one.
    pub fn from_bytes(width: usize, pixels: Vec<u8>) -> Result<Self, Error> {
        Self::new(width, Store::Bytes(pixels))
    }

    /// Pixels of 16 bits, `width` a row; 65535 is 1.
    ///
    /// # Errors
    /// As [`from_bytes`](Self::from_bytes).
    pub fn from_words(width: usize, pixels: Vec<u16>) -> Result<Self, Error> {
        Self::new(width, Store::Words(pixels))
    }

    /// Finite numbers, `width` a row.
    ///
    /// # Errors
    /// [`ErrorKind::Field`] unless there are whole rows, at least one, of finite numbers within ±10³⁰.
    pub fn from_floats(width: usize, pixels: Vec<f32>) -> Result<Self, Error> {
        if let Some(at) = pixels.iter().position(|v| v.is_nan() || v.abs() > 1e30) {
            let value = format!("{} at {at}", number(f64::from(pixels[at])));
            let allowed = "finite numbers within ±1e30";
            return Err(Error::new(ErrorKind::Field, "pixels", value, allowed));
        }
        Self::new(width, Store::Floats(pixels))
    }

    fn new(width: usize, store: Store) -> Result<Self, Error> {
        let number = store.len();
        if width == 0 || number == 0 || !number.is_multiple_of(width) {
            let value = format!("{number} in rows of {width}");
            let allowed = "whole rows, at least one";
            return Err(Error::new(ErrorKind::Field, "pixels", value, allowed));
        }
        let size = [width, number / width];
        if let Some(side) = size.into_iter().find(|&side| side > Self::MAX_SIDE) {
            let allowed = format!("at most {} columns and rows", Self::MAX_SIDE);
            let error = Error::new(ErrorKind::Field, "pixels", side, allowed);
            return Err(error.with_limit(Self::MAX_SIDE as f64));
        }
        Ok(Self::stored(size, store, None))
    }

    fn stored(size: [usize; 2], store: Store, present: Option<Self>) -> Self {
        let mut digest = store.digest(size[0]);
        if let Some(present) = &present {
            let mut canon = Canon::new("pixels without data");
            canon.digest(digest);
            canon.digest(present.digest());
            digest = canon.finish();
        }
        Self(Arc::new(Stored {
            size,
            levels: levels(size, &store),
            store,
            present,
            digest,
        }))
    }

    /// These pixels without some, by their places in the rows: where one is missing a field of them is empty, and its
    /// neighbors are interpolated among those that are there.
    #[must_use]
    pub fn without(self, is_missing: impl Fn(usize) -> bool) -> Self {
        let present: Vec<u8> = (0..self.0.store.len())
            .map(|at| if is_missing(at) { 0 } else { 255 })
            .collect();
        if !present.contains(&0) {
            return self;
        }
        let mut store = self.0.store.clone();
        match &mut store {
            Store::Bytes(all) => fill(all, &present),
            Store::Words(all) => fill(all, &present),
            Store::Floats(all) => fill(all, &present),
        }
        let size = self.0.size;
        let present = Self::stored(size, Store::Bytes(present), None);
        Self::stored(size, store, Some(present))
    }

    /// The pixels that are there as ones, if any is missing.
    pub(super) fn present(&self) -> Option<&Self> {
        self.0.present.as_ref()
    }

    /// Whether a pixel has a number.
    pub(super) fn has(&self, at: usize) -> bool {
        let present = self.0.present.as_ref();
        present.is_none_or(|present| present.0.store.get(at) > 0.0)
    }

    /// Pixels made from each of these, unless stopped.
    pub(super) fn map(&self, stop: &Stop, of: impl Fn(f32) -> f32) -> Result<Self, Error> {
        self.made(stop, |at| of(self.0.store.get(at)))
    }

    /// Pixels made from their places in the rows, unless stopped.
    pub(super) fn made(&self, stop: &Stop, of: impl Fn(usize) -> f32) -> Result<Self, Error> {
        /// The most pixels that are made without a look at the flag.
        const FEW: usize = 1 << 14;
        let number = self.0.store.len();
        let mut pixels = Vec::with_capacity(number);
        while pixels.len() < number {
            if stop.is_raised() {
                return Err(Stop::error());
            }
            pixels.extend((pixels.len()..number).take(FEW).map(&of));
        }
        let present = self.0.present.clone();
        Ok(Self::stored(self.0.size, Store::Floats(pixels), present))
    }

    /// The numbers of columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.0.size
    }

    /// The memory taken, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let bounds: usize = self.0.levels.iter().map(|level| level.ends.len()).sum();
        let present = self.present().map_or(0, Self::bytes);
        self.0.store.bytes() + size_of::<Ends>() * bounds + present
    }

    /// The least and the greatest number, of pixels that are not missing.
    #[must_use]
    pub fn ends(&self) -> [f32; 2] {
        let last = self.0.levels.last().and_then(|level| level.ends.first());
        last.copied().unwrap_or_default()
    }

    /// The digest of the numbers and of how they stand in rows.
    #[must_use]
    pub fn digest(&self) -> Digest {
        self.0.digest
    }

    pub(super) fn store(&self) -> &Store {
        &self.0.store
    }

    /// Bounds of the numbers in some columns and rows, which are there.
    pub(super) fn bounds(
        &self,
        columns: RangeInclusive<usize>,
        rows: RangeInclusive<usize>,
    ) -> Ends {
        let Stored {
            size,
            store,
            levels,
            ..
        } = &*self.0;
        let [wide, tall] = [&columns, &rows].map(|range| range.end() - range.start() + 1);
        if wide * tall <= FEW {
            let all = rows.flat_map(|y| columns.clone().map(move |x| y * size[0] + x));
            return all.fold([f32::INFINITY, f32::NEG_INFINITY], |ends, at| {
                joined(ends, [store.get(at); 2])
            });
        }
        let mut width = SQUARE;
        for level in levels {
            let [x, y] = [&columns, &rows].map(|range| range.start() / width..=range.end() / width);
            let is_coarse = x.end() - x.start() < 4 && y.end() - y.start() < 4;
            if is_coarse || level.ends.len() == 1 {
                let all = y.flat_map(|y| x.clone().map(move |x| y * level.size[0] + x));
                return all.fold([f32::INFINITY, f32::NEG_INFINITY], |ends, at| {
                    joined(ends, level.ends[at])
                });
            }
            width *= 2;
        }
        self.ends()
    }
}

impl PartialEq for Pixels {
    fn eq(&self, other: &Self) -> bool {
        self.0.digest == other.0.digest
    }
}

impl Store {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Bytes(all) => all.len(),
            Self::Words(all) => all.len(),
            Self::Floats(all) => all.len(),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Bytes(all) => all.len(),
            Self::Words(all) => 2 * all.len(),
            Self::Floats(all) => 4 * all.len(),
        }
    }

    pub(super) fn get(&self, at: usize) -> f32 {
        match self {
            Self::Bytes(all) => f32::from(all[at]) / 255.0,
            Self::Words(all) => f32::from(all[at]) / 65535.0,
            Self::Floats(all) => all[at],
        }
    }

    fn digest(&self, width: usize) -> Digest {
        let mut hasher = blake3::Hasher::new();
        let bits = match self {
            Self::Bytes(_) => 8u64,
            Self::Words(_) => 16,
            Self::Floats(_) => 32,
        };
        hasher.update(&bits.to_le_bytes());
        hasher.update(&(width as u64).to_le_bytes());
        let mut bytes = Vec::with_capacity(1 << 16);
        match self {
            Self::Bytes(all) => {
                hasher.update(all);
            }
            Self::Words(all) => {
                for part in all.chunks(1 << 15) {
                    bytes.clear();
                    bytes.extend(part.iter().flat_map(|v| v.to_le_bytes()));
                    hasher.update(&bytes);
                }
            }
            Self::Floats(all) => {
                for part in all.chunks(1 << 14) {
                    bytes.clear();
                    // −0 is 0.
                    bytes.extend(part.iter().flat_map(|v| (v + 0.0).to_le_bytes()));
                    hasher.update(&bytes);
                }
            }
        }
        Digest::from_bytes(*hasher.finalize().as_bytes())
    }
}

/// Puts a number that is there in the place of each missing one: the one before it in the rows, or the first.
fn fill<T: Copy + Default>(all: &mut [T], present: &[u8]) {
    let first = present.iter().position(|is_present| *is_present > 0);
    let mut last = first.map_or(T::default(), |at| all[at]);
    for (value, is_present) in all.iter_mut().zip(present) {
        match is_present {
            0 => *value = last,
            _ => last = *value,
        }
    }
}

fn joined(a: Ends, b: Ends) -> Ends {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// The levels of bounds, from the finest to a single square.
fn levels(size: [usize; 2], store: &Store) -> Vec<Level> {
    let mut levels = match store {
        Store::Bytes(all) => alloc::vec![finest(size, all, |v| f32::from(v) / 255.0)],
        Store::Words(all) => alloc::vec![finest(size, all, |v| f32::from(v) / 65535.0)],
        Store::Floats(all) => alloc::vec![finest(size, all, |v| v)],
    };
    while let Some(last) = levels.last().filter(|last| last.ends.len() > 1) {
        let squares = last.size.map(|v| v.div_ceil(2));
        let of = |at: usize| {
            let [x, y] = [at % squares[0] * 2, at / squares[0] * 2];
            let xs = x..(x + 2).min(last.size[0]);
            let all = (y..(y + 2).min(last.size[1]))
                .flat_map(|y| xs.clone().map(move |x| y * last.size[0] + x));
            all.map(|at| last.ends[at])
                .fold([f32::INFINITY, f32::NEG_INFINITY], joined)
        };
        let ends = (0..squares[0] * squares[1]).map(of).collect();
        levels.push(Level {
            size: squares,
            ends,
        });
    }
    levels
}

/// The bounds of squares of [`SQUARE`] pixels.
fn finest<T: Copy + PartialOrd>(size: [usize; 2], pixels: &[T], of: impl Fn(T) -> f32) -> Level {
    let squares = size.map(|v| v.div_ceil(SQUARE));
    let mut ends = Vec::with_capacity(squares[0] * squares[1]);
    for rows in pixels.chunks(SQUARE * size[0]) {
        let start = ends.len();
        for row in rows.chunks(size[0]) {
            for (square, part) in row.chunks(SQUARE).enumerate() {
                let mut found = [part[0]; 2];
                for &v in part {
                    found = [
                        if v < found[0] { v } else { found[0] },
                        if v > found[1] { v } else { found[1] },
                    ];
                }
                let found = found.map(&of);
                match ends.get_mut(start + square) {
                    Some(ends) => *ends = joined(*ends, found),
                    None => ends.push(found),
                }
            }
        }
    }
    Level {
        size: squares,
        ends,
    }
}

/// Refuses pixels that are no shares.
pub(super) fn check_shares(pixels: &Pixels) -> Result<(), Error> {
    let ends = pixels.ends();
    match ends.into_iter().find(|v| !(0.0..=1.0).contains(v)) {
        Some(pixel) => {
            let value = number(f64::from(pixel)).to_string();
            let allowed = "shares from 0 to 1";
            Err(Error::new(ErrorKind::Field, "pixels", value, allowed))
        }
        None => Ok(()),
    }
}
