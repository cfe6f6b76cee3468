//! Rasters from npy files and from bare floats.

use std::io::{Read, Seek, SeekFrom};

use strew_core::server::Stop;

use super::{
    error::RasterError,
    image::Image,
    limits::Limits,
    samples::Samples,
    wanted::{FEW, look},
};

const ALLOWED: &str = "two dimensions in C order, of the types u1, u2, f4 or f8, little endian";
/// The longest header: far longer than any of an array of two dimensions.
const LONGEST_HEADER: usize = 1 << 16;

#[derive(Clone, Copy)]
enum Kind {
    U8,
    U16,
    F32,
    F64,
}

impl Kind {
    const fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

pub(super) fn read(
    mut from: impl Read + Seek,
    limits: Limits,
    stop: &Stop,
) -> Result<Image, RasterError> {
    let mut start = [0; 8];
    fill(&mut from, &mut start)?;
    let [.., major, _] = start;
    let length = match major {
        1 => {
            let mut length = [0; 2];
            fill(&mut from, &mut length)?;
            usize::from(u16::from_le_bytes(length))
        }
        2 | 3 => {
            let mut length = [0; 4];
            fill(&mut from, &mut length)?;
            u32::from_le_bytes(length) as usize
        }
        other => return Err(unsupported(format!("version {other} of npy"))),
    };
    if length > LONGEST_HEADER {
        return Err(damaged(format!("its header has {length} bytes")));
    }
    let mut header = vec![0; length];
    fill(&mut from, &mut header)?;
    let header = String::from_utf8_lossy(&header);
    let kind = match value(&header, "descr")?.trim_matches(['\'', '"']) {
        "|u1" | "<u1" | "u1" | "|b1" => Kind::U8,
        "<u2" => Kind::U16,
        "<f4" => Kind::F32,
        "<f8" => Kind::F64,
        other => return Err(unsupported(format!("an array of type {other:.40}"))),
    };
    if value(&header, "fortran_order")? != "False" {
        return Err(unsupported("an array in Fortran order".into()));
    }
    let shape = value(&header, "shape")?;
    let sides = shape
        .split(',')
        .map(str::trim)
        .filter(|part| !part.is_empty());
    let sides: Result<Vec<u64>, _> = sides.map(str::parse).collect();
    let sides = sides.map_err(|_| damaged(format!("its shape is ({shape:.40})")))?;
    let &[height, width] = sides.as_slice() else {
        return Err(unsupported(format!(
            "an array of {} dimensions",
            sides.len()
        )));
    };
    let size = limits.check(width, height)?;
    let mut image = numbers(from, size, kind, stop)?;
    // Truth is stored as 0 and 1.
    image.is_sharp = value(&header, "descr")?.contains("b1");
    if let Samples::U8(values) = &mut image.samples
        && image.is_sharp
    {
        for part in values.chunks_mut(FEW) {
            look(stop)?;
            part.iter_mut()
                .for_each(|value| *value = u8::from(*value > 0) * u8::MAX);
        }
    }
    Ok(image)
}

pub(super) fn read_floats(
    mut from: impl Read + Seek,
    size: [usize; 2],
    stop: &Stop,
) -> Result<Image, RasterError> {
    from.seek(SeekFrom::Start(0))?;
    numbers(from, size, Kind::F32, stop)
}

/// The numbers from here to the end; their number must match the size.
fn numbers(
    mut from: impl Read + Seek,
    size: [usize; 2],
    kind: Kind,
    stop: &Stop,
) -> Result<Image, RasterError> {
    let here = from.stream_position()?;
    let there = from.seek(SeekFrom::End(0))?;
    from.seek(SeekFrom::Start(here))?;
    let count = size[0] * size[1];
    let (bytes, expected) = (there.saturating_sub(here), count * kind.bytes());
    if bytes != expected as u64 {
        let [width, height] = size;
        let detail = format!("{width} × {height} pixels take {expected} bytes, there are {bytes}");
        return Err(damaged(detail));
    }
    let samples = match kind {
        Kind::U8 => {
            let mut values = vec![0; count];
            fill(&mut from, &mut values)?;
            Samples::U8(values)
        }
        Kind::U16 => Samples::U16(each(from, count, u16::from_le_bytes)?),
        Kind::F32 => Samples::F32(each(from, count, f32::from_le_bytes)?),
        Kind::F64 => {
            let narrow = |bytes| f64::from_le_bytes(bytes) as f32;
            Samples::F32(each(from, count, narrow)?)
        }
    };
    Image::new(size, samples).without_nan(stop)
}

fn each<const N: usize, T>(
    mut from: impl Read,
    count: usize,
    read: impl Fn([u8; N]) -> T,
) -> Result<Vec<T>, RasterError> {
    const MOST: usize = 1 << 16;
    let mut values = Vec::with_capacity(count);
    let mut bytes = vec![0; MOST * N];
    while values.len() < count {
        let part = &mut bytes[..(count - values.len()).min(MOST) * N];
        fill(&mut from, part)?;
        let (whole, _) = part.as_chunks::<N>();
        values.extend(whole.iter().map(|bytes| read(*bytes)));
    }
    Ok(values)
}

fn fill(from: &mut impl Read, bytes: &mut [u8]) -> Result<(), RasterError> {
    from.read_exact(bytes).map_err(|error| match error.kind() {
        std::io::ErrorKind::UnexpectedEof => damaged("it ends early".into()),
        _ => error.into(),
    })
}

/// The value of a key of the header, a Python dictionary; of a tuple the text between the parentheses.
fn value<'a>(header: &'a str, key: &str) -> Result<&'a str, RasterError> {
    let find = || {
        let at = header.find(&format!("'{key}'"))?;
        let rest = header[at + key.len() + 2..].trim_start();
        let rest = rest.strip_prefix(':')?.trim_start();
        match rest.strip_prefix('(') {
            Some(tuple) => tuple.split_once(')').map(|(inside, _)| inside),
            None => rest.split([',', '}']).next().map(str::trim),
        }
    };
    find().ok_or_else(|| damaged(format!("its header has no `{key}`")))
}

fn damaged(detail: String) -> RasterError {
    RasterError::Damaged {
        format: "array",
        detail,
    }
}

fn unsupported(found: String) -> RasterError {
    RasterError::Unsupported {
        found,
        allowed: ALLOWED,
    }
}
