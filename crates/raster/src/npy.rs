//! Rasters from npy files and from bare floats.

use std::io::{Read, Seek, SeekFrom};

use strew_core::server::Stop;

use super::{error::RasterError, image::Image, limits::Limits, samples::Samples};

const ALLOWED: &str = "two dimensions of the types b1, u1, u2, f4 or f8";
/// The longest header: far longer than any of an array of two dimensions.
const LONGEST_HEADER: usize = 1 << 16;

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
    let kind = value(&header, "descr")?.trim_matches(['\'', '"']);
    let order = value(&header, "fortran_order")?.to_lowercase();
    let wrong = |_| damaged(format!("its fortran_order is {order:.40}"));
    let is_by_columns = order.parse::<bool>().map_err(wrong)?;
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
    let [width, height] = limits.check(width, height)?;
    if is_by_columns {
        // Exif's orientation 5 exchanges rows and columns.
        return numbers(from, [height, width], kind, stop)?.upright(5, stop);
    }
    numbers(from, [width, height], kind, stop)
}

pub(super) fn read_floats(
    mut from: impl Read + Seek,
    size: [usize; 2],
    stop: &Stop,
) -> Result<Image, RasterError> {
    from.seek(SeekFrom::Start(0))?;
    numbers(from, size, "<f4", stop)
}

/// The numbers from here to the end; their number must match the size.
fn numbers(
    mut from: impl Read + Seek,
    size: [usize; 2],
    kind: &str,
    stop: &Stop,
) -> Result<Image, RasterError> {
    let here = from.stream_position()?;
    let there = from.seek(SeekFrom::End(0))?;
    from.seek(SeekFrom::Start(here))?;
    let count = size[0] * size[1];
    let (is_big, of) = (
        kind.starts_with('>'),
        kind.trim_start_matches(['<', '>', '|']),
    );
    let each_bytes = match of {
        "b1" | "u1" => 1,
        "u2" => 2,
        "f4" => 4,
        "f8" => 8,
        _ => return Err(unsupported(format!("an array of type {kind:.40}"))),
    };
    let (bytes, expected) = (there.saturating_sub(here), count * each_bytes);
    if bytes != expected as u64 {
        let [width, height] = size;
        let detail = format!("{width} × {height} pixels take {expected} bytes, there are {bytes}");
        return Err(damaged(detail));
    }
    let samples = match of {
        // Truth is stored as 0 and 1.
        "b1" => Samples::U8(each(from, count, is_big, |[is]| {
            u8::from(is > 0) * u8::MAX
        })?),
        "u1" => Samples::U8(each(from, count, is_big, u8::from_le_bytes)?),
        "u2" => Samples::U16(each(from, count, is_big, u16::from_le_bytes)?),
        "f4" => Samples::F32(each(from, count, is_big, f32::from_le_bytes)?),
        _ => {
            let narrow = |bytes| f64::from_le_bytes(bytes) as f32;
            Samples::F32(each(from, count, is_big, narrow)?)
        }
    };
    let image = Image::new(size, samples).without_nan(stop)?;
    Ok(Image {
        is_sharp: of == "b1",
        ..image
    })
}

fn each<const N: usize, T>(
    mut from: impl Read,
    count: usize,
    is_big: bool,
    read: impl Fn([u8; N]) -> T,
) -> Result<Vec<T>, RasterError> {
    const MOST: usize = 1 << 16;
    let mut values = Vec::with_capacity(count);
    let mut bytes = vec![0; MOST * N];
    while values.len() < count {
        let part = &mut bytes[..(count - values.len()).min(MOST) * N];
        fill(&mut from, part)?;
        let (whole, _) = part.as_chunks_mut::<N>();
        if is_big {
            whole.iter_mut().for_each(|bytes| bytes.reverse());
        }
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
    RasterError::damaged("array", detail)
}

fn unsupported(found: String) -> RasterError {
    RasterError::Unsupported {
        found,
        allowed: ALLOWED,
    }
}
