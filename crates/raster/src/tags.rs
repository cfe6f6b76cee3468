//! The directories of a TIFF: whether their tags fit into the file, before a decoder takes memory for them; and colors
//! that the decoder does not know, under a name that it knows.

use std::io::{self, Read, Seek, SeekFrom};

use super::{error::RasterError, image::number, tiff_faults::broken};

/// The most directories that are looked at: smaller copies of the picture, and masks.
const MOST: usize = 64;

/// The meanings of a sample (PhotometricInterpretation) that are read as if they were gray: white is zero, an index of
/// a palette, a mask.
pub(super) const WHITE_IS_ZERO: u16 = 0;
pub(super) const PALETTE: u16 = 3;
const MASK: u16 = 4;

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Directory {
    /// The bits of NewSubfileType: 4 for a mask.
    pub(super) subfile: u64,
    /// PhotometricInterpretation, as stored.
    pub(super) photometric: u16,
}

/// A file in which indices and masks are called gray.
#[derive(Debug)]
pub(super) struct Tagged<R> {
    from: R,
    at: u64,
    /// The place and the bytes of what is called otherwise.
    gray: Vec<(u64, [u8; 2])>,
    /// The directories, up to the first that does not fit.
    pub(super) directories: Vec<Directory>,
}

impl<R: Read + Seek> Tagged<R> {
    /// Refuses a file whose first directory has a tag that is longer than the file.
    pub(super) fn new(mut from: R) -> Result<Self, RasterError> {
        let length = from.seek(SeekFrom::End(0))?;
        let mut tagged = Self {
            from,
            at: 0,
            gray: vec![],
            directories: vec![],
        };
        let read = tagged.look(length);
        tagged.seek(SeekFrom::Start(0))?;
        match read {
            _ if !tagged.directories.is_empty() => Ok(tagged),
            Ok(()) => Err(broken("a tag is longer than the file")),
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
                Err(broken("it ends before its first directory does"))
            }
            Err(error) => Err(error.into()),
        }
    }

    fn look(&mut self, length: u64) -> io::Result<()> {
        let from = &mut self.from;
        let mut head = [0; 16];
        from.seek(SeekFrom::Start(0))?;
        from.read_exact(&mut head[..8])?;
        let is_little = head[0] == b'I';
        let number = |bytes: &[u8]| number(bytes, is_little);
        let is_big = number(&head[2..4]) == 43;
        // The bytes of a place in the file, and of the number of entries.
        let (place, entries) = if is_big { (8, 8) } else { (4, 2) };
        if is_big {
            from.read_exact(&mut head[8..])?;
        }
        let mut start = number(&head[if is_big { 8..16 } else { 4..8 }]);
        while start != 0 && self.directories.len() < MOST {
            let mut directory = Directory::default();
            let mut gray = None;
            from.seek(SeekFrom::Start(start))?;
            from.read_exact(&mut head[..entries])?;
            let mut entry = vec![0; 4 + 2 * place];
            let mut at = start + entries as u64;
            for _ in 0..number(&head[..entries]) {
                from.read_exact(&mut entry)?;
                let bytes = match number(&entry[2..4]) {
                    3 | 8 => 2,
                    4 | 9 | 11 | 13 => 4,
                    5 | 10 | 12 | 16..=18 => 8,
                    _ => 1,
                };
                if number(&entry[4..4 + place]) > length / bytes {
                    return Ok(());
                }
                let value = &entry[4 + place..][..bytes.min(place as u64) as usize];
                match number(&entry[..2]) {
                    254 => directory.subfile = number(value),
                    262 => {
                        directory.photometric = number(value) as u16;
                        gray = Some(at + 4 + place as u64);
                    }
                    _ => {}
                }
                at += entry.len() as u64;
            }
            if let (WHITE_IS_ZERO | PALETTE | MASK, Some(at)) = (directory.photometric, gray) {
                self.gray
                    .push((at, if is_little { [1, 0] } else { [0, 1] }));
            }
            self.directories.push(directory);
            from.read_exact(&mut head[..place])?;
            start = number(&head[..place]);
        }
        Ok(())
    }
}

impl<R: Read> Read for Tagged<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let number = self.from.read(out)?;
        let end = self.at + number as u64;
        for (place, bytes) in &self.gray {
            for (at, byte) in (*place..).zip(bytes) {
                if (self.at..end).contains(&at) {
                    out[(at - self.at) as usize] = *byte;
                }
            }
        }
        self.at = end;
        Ok(number)
    }
}

impl<R: Seek> Seek for Tagged<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = self.from.seek(to)?;
        Ok(self.at)
    }
}
