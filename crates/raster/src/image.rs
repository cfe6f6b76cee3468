//! A raster in memory: its numbers, the pixels without one, and its place.

use strew_core::server::Stop;

use super::{
    error::RasterError,
    limits::Limits,
    samples::Samples,
    wanted::{FEW, look},
};

#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width and height in pixels.
    pub size: [usize; 2],
    pub samples: Samples,
    /// Which pixels have no data, if any: their number is 0.
    pub missing: Option<Vec<bool>>,
    /// The number that stands for a share of 1 by default: the greatest of an integer type, else 1.
    pub full: f64,
    /// Whether its numbers are those of a picture: gray or light, of which the greatest of the type is white.
    pub is_picture: bool,
    /// Whether its pixels are bits, between which there is nothing.
    pub is_sharp: bool,
    /// The place that the file states, if any.
    pub place: Place,
    /// The code of EPSG of the plane of that place, if the file states it.
    pub epsg: Option<u16>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    Unknown,
    /// Min x, min y, max x, max y.
    Box([f64; 4]),
    /// Somewhere that is no box along the axes, or not stated in full.
    Unusable(&'static str),
}

impl Image {
    pub(super) fn new(size: [usize; 2], samples: Samples) -> Self {
        Self {
            size,
            full: samples.full(),
            samples,
            missing: None,
            is_picture: false,
            is_sharp: false,
            place: Place::Unknown,
            epsg: None,
        }
    }

    /// The pixels that NaN stands for are missing. Infinite ones are refused, unless they are missing for other reasons.
    pub(super) fn without_nan(mut self, stop: &Stop) -> Result<Self, RasterError> {
        let Samples::F32(values) = &mut self.samples else {
            return Ok(self);
        };
        for (part, start) in values.chunks_mut(FEW).zip((0..).step_by(FEW)) {
            look(stop)?;
            for (value, at) in part.iter_mut().zip(start..) {
                let is_missing = self.missing.as_ref().is_some_and(|missing| missing[at]);
                if value.is_infinite() && !is_missing {
                    return Err(RasterError::NotFinite {
                        x: at % self.size[0],
                        y: at / self.size[0],
                        value: (*value).into(),
                    });
                }
                if !value.is_finite() {
                    *value = 0.0;
                    let all = self.size[0] * self.size[1];
                    self.missing.get_or_insert_with(|| vec![false; all])[at] = true;
                }
            }
        }
        Ok(self)
    }

    pub(super) fn without(mut self, further: Vec<bool>) -> Self {
        self.samples.clear(&further);
        match &mut self.missing {
            _ if !further.contains(&true) => {}
            Some(missing) => {
                for (missing, further) in missing.iter_mut().zip(further) {
                    *missing |= further;
                }
            }
            missing => *missing = Some(further),
        }
        self
    }

    /// Places it by x = a·column + b·row + c and y = d·column + e·row + f of the corners of pixels. Rows that run from
    /// south to north, or from east to west, are turned around.
    pub fn at(self, [a, b, c, d, e, f]: [f64; 6], stop: &Stop) -> Result<Self, RasterError> {
        let [width, height] = self.size.map(|side| side as f64);
        let [x, y] = [[c, c + a * width], [f, f + e * height]];
        let is_box = b == 0.0 && d == 0.0 && x[0] != x[1] && y[0] != y[1];
        let [[west, east], [south, north]] = [x, y].map(|[a, b]| [a.min(b), a.max(b)]);
        let place = match is_box && x.iter().chain(&y).all(|v| v.is_finite()) {
            true => Place::Box([west, south, east, north]),
            false if b != 0.0 || d != 0.0 => Place::Unusable("it is turned or sheared"),
            false => Place::Unusable("its place has no area"),
        };
        let turn = match (a < 0.0, e > 0.0) {
            _ if !is_box => 1,
            (false, false) => 1,
            (true, false) => 2,
            (true, true) => 3,
            (false, true) => 4,
        };
        Ok(Self {
            place,
            ..self.upright(turn, stop)?
        })
    }

    /// Turns it as the tag of orientation of Exif says (1 to 8): others mean nothing.
    pub(super) fn upright(mut self, orientation: u16, stop: &Stop) -> Result<Self, RasterError> {
        if !(2..=8).contains(&orientation) {
            return Ok(self);
        }
        let [width, height] = self.size;
        let size = match orientation {
            2..=4 => [width, height],
            _ => [height, width],
        };
        let from = |x: usize, y: usize| {
            let [column, row] = match orientation {
                2 => [width - 1 - x, y],
                3 => [width - 1 - x, height - 1 - y],
                4 => [x, height - 1 - y],
                5 => [y, x],
                6 => [y, height - 1 - x],
                7 => [width - 1 - y, height - 1 - x],
                _ => [width - 1 - y, x],
            };
            row * width + column
        };
        self.samples = match self.samples {
            Samples::U8(all) => Samples::U8(turned(&all, size, from, stop)?),
            Samples::U16(all) => Samples::U16(turned(&all, size, from, stop)?),
            Samples::F32(all) => Samples::F32(turned(&all, size, from, stop)?),
        };
        let missing = self.missing.map(|all| turned(&all, size, from, stop));
        self.missing = missing.transpose()?;
        self.size = size;
        Ok(self)
    }
}

/// The pixels of another arrangement, each by the place that it comes from.
fn turned<T: Copy>(
    all: &[T],
    [width, height]: [usize; 2],
    from: impl Fn(usize, usize) -> usize,
    stop: &Stop,
) -> Result<Vec<T>, RasterError> {
    let mut made = Vec::with_capacity(all.len());
    for y in 0..height {
        look(stop)?;
        made.extend((0..width).map(|x| all[from(x, y)]));
    }
    Ok(made)
}

/// A number of up to 8 bytes.
pub(super) fn number(bytes: &[u8], is_little: bool) -> u64 {
    let next = |all: u64, byte: &u8| all << 8 | u64::from(*byte);
    match is_little {
        true => bytes.iter().rev().fold(0, next),
        false => bytes.iter().fold(0, next),
    }
}

/// The orientation that the data of Exif state, 1 if they state none.
pub(super) fn orientation(exif: &[u8]) -> u16 {
    let exif = exif.strip_prefix(b"Exif\0\0").unwrap_or(exif);
    let is_little = exif.starts_with(b"II");
    let number = |at: usize, bytes: usize| {
        let bytes = exif.get(at..at.checked_add(bytes)?)?;
        Some(number(bytes, is_little) as usize)
    };
    let find = || {
        let start = number(4, 4)?;
        let entries = (0..number(start, 2)?).map(|i| start + 2 + 12 * i);
        let entry = entries.into_iter().find(|at| number(*at, 2) == Some(274))?;
        number(entry + 8, 2)
    };
    find()
        .and_then(|found| u16::try_from(found).ok())
        .unwrap_or(1)
}

impl Limits {
    pub(super) fn check(self, width: u64, height: u64) -> Result<[usize; 2], RasterError> {
        let side = self.side as u64;
        let is_within = (1..=side).contains(&width) && (1..=side).contains(&height);
        if !is_within || width * height > self.pixels as u64 {
            return Err(RasterError::Size {
                width,
                height,
                limits: self,
            });
        }
        Ok([width as usize, height as usize])
    }
}
