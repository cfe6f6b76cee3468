//! Outputs that are compressed, by the ending of their names.

use std::{
    ffi::OsStr,
    io::{self, Write},
    path::Path,
};

use flate2::write::GzEncoder;

/// How an output is compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    /// By gzip: `.gz`.
    Gzip,
    /// By zstd: `.zst`.
    Zstd,
}

impl Compression {
    /// The compression that a name ends with, and the name without that ending.
    pub(super) fn of(path: &Path) -> Option<(Self, &Path)> {
        let compression = match path.extension().and_then(OsStr::to_str)? {
            "gz" => Self::Gzip,
            "zst" => Self::Zstd,
            _ => return None,
        };
        let stem = path.file_stem()?;
        Some((compression, Path::new(stem)))
    }
}

/// A writer, behind a compressor where one is wanted.
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
            // The level that zstd itself takes if none is named.
            Some(Compression::Zstd) => Self::Zstd(zstd::stream::write::Encoder::new(writer, 0)?),
        })
    }

    /// Writes what the compressor holds back.
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
