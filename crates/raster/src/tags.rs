//! Whether the tags of a TIFF fit into the file, before a decoder takes memory for them.

use std::io::{self, Read, Seek, SeekFrom};

use super::{error::RasterError, tiff_faults::broken};

/// Refuses a file whose first directory has a tag that is longer than the file.
pub(super) fn check(from: &mut (impl Read + Seek), length: u64) -> Result<(), RasterError> {
    let fits = fits(from, length);
    from.seek(SeekFrom::Start(0))?;
    match fits {
        Ok(true) => Ok(()),
        Ok(false) => Err(broken("a tag is longer than the file")),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
            Err(broken("it ends before its first directory does"))
        }
        Err(error) => Err(error.into()),
    }
}

fn fits(from: &mut (impl Read + Seek), length: u64) -> io::Result<bool> {
    let mut head = [0; 16];
    from.seek(SeekFrom::Start(0))?;
    from.read_exact(&mut head[..8])?;
    let is_little = head[0] == b'I';
    let number = |bytes: &[u8]| {
        let next = |all: u64, byte: &u8| all << 8 | u64::from(*byte);
        match is_little {
            true => bytes.iter().rev().fold(0, next),
            false => bytes.iter().fold(0, next),
        }
    };
    let is_big = number(&head[2..4]) == 43;
    // The bytes of a place in the file, and of the number of entries.
    let (place, entries) = if is_big { (8, 8) } else { (4, 2) };
    if is_big {
        from.read_exact(&mut head[8..])?;
    }
    let start = number(&head[if is_big { 8..16 } else { 4..8 }]);
    from.seek(SeekFrom::Start(start))?;
    from.read_exact(&mut head[..entries])?;
    let entries = number(&head[..entries]);
    let mut entry = vec![0; 4 + 2 * place];
    for _ in 0..entries {
        from.read_exact(&mut entry)?;
        let bytes = match number(&entry[2..4]) {
            3 | 8 => 2,
            4 | 9 | 11 | 13 => 4,
            5 | 10 | 12 | 16..=18 => 8,
            _ => 1,
        };
        if number(&entry[4..4 + place]) > length / bytes {
            return Ok(false);
        }
    }
    Ok(true)
}
