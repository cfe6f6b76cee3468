//! Compresses outputs, by the endings of their names.

use std::{
    ffi::OsStr,
    io::{self, Read as _, Write},
    path::Path,
};

use flate2::write::GzEncoder;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    Gzip,
    Zstd,
}

impl Compression {
    /// The compression that the ending of a name means, and the name without that ending.
    pub(super) fn of(path: &Path) -> Option<(Self, &Path)> {
        let compression = match path.extension().and_then(OsStr::to_str)? {
            "gz" => Self::Gzip,
            "zst" => Self::Zstd,
            _ => return None,
        };
        let stem = path.file_stem()?;
        Some((compression, Path::new(stem)))
    }

    pub(super) const fn ending(self) -> &'static str {
        match self {
            Self::Gzip => "gz",
            Self::Zstd => "zst",
        }
    }

    pub(super) fn pack(self, bytes: &[u8]) -> io::Result<Vec<u8>> {
        match self {
            Self::Gzip => {
                let mut encoder = GzEncoder::new(vec![], flate2::Compression::default());
                encoder.write_all(bytes)?;
                encoder.finish()
            }
            Self::Zstd => zstd::stream::encode_all(bytes, 0),
        }
    }

    pub(super) fn unpack(self, bytes: &[u8]) -> io::Result<Vec<u8>> {
        match self {
            Self::Gzip => {
                let mut plain = vec![];
                flate2::read::GzDecoder::new(bytes).read_to_end(&mut plain)?;
                Ok(plain)
            }
            Self::Zstd => zstd::stream::decode_all(bytes),
        }
    }
}

/// The names of a file and of its compressed variants, the plain one first.
pub(super) fn names(
    plain: &str,
    variants: &[Compression],
) -> impl Iterator<Item = (String, Option<Compression>)> {
    let packed = |&variant: &Compression| {
        let name = format!("{plain}.{}", variant.ending());
        (name, Some(variant))
    };
    let packed: Vec<_> = variants.iter().map(packed).collect();
    [(plain.to_owned(), None)].into_iter().chain(packed)
}

pub(super) enum Sink {
    Plain(Box<dyn Write + Send>),
    Gzip(GzEncoder<Box<dyn Write + Send>>),
    Zstd(zstd::stream::write::Encoder<'static, Box<dyn Write + Send>>),
}

impl Sink {
    pub(super) fn new(
        writer: Box<dyn Write + Send>,
        compression: Option<Compression>,
    ) -> io::Result<Self> {
        Ok(match compression {
            None => Self::Plain(writer),
            Some(Compression::Gzip) => {
                Self::Gzip(GzEncoder::new(writer, flate2::Compression::default()))
            }
            // 0 is the default level of zstd.
            Some(Compression::Zstd) => Self::Zstd(zstd::stream::write::Encoder::new(writer, 0)?),
        })
    }

    /// Writes the rest, which the compressor still holds.
    pub(super) fn finish(self) -> io::Result<()> {
        let mut writer = match self {
            Self::Plain(writer) => writer,
            Self::Gzip(encoder) => encoder.finish()?,
            Self::Zstd(encoder) => encoder.finish()?,
        };
        writer.flush()
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Plain(writer) => writer.write(bytes),
            Self::Gzip(encoder) => encoder.write(bytes),
            Self::Zstd(encoder) => encoder.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Plain(writer) => writer.flush(),
            Self::Gzip(encoder) => encoder.flush(),
            Self::Zstd(encoder) => encoder.flush(),
        }
    }
}
