//! Compresses outputs, by the endings of their names.

use std::{
    borrow::Cow,
    ffi::OsStr,
    io::{self, Read as _, Write},
    path::Path,
};

use clap::ValueEnum;
use flate2::write::GzEncoder;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum, Serialize, Deserialize)]
pub(super) enum Compression {
    #[value(name = "none")]
    #[serde(skip)]
    Plain,
    #[value(name = "gz")]
    #[serde(rename = "gz")]
    Gzip,
    #[value(name = "zst")]
    #[serde(rename = "zst")]
    Zstd,
}

impl Compression {
    /// The compression that the ending of a name means, and the name without that ending.
    pub(super) fn of(path: &Path) -> (Self, &Path) {
        let compression = match path.extension().and_then(OsStr::to_str) {
            Some("gz") => Self::Gzip,
            Some("zst") => Self::Zstd,
            _ => return (Self::Plain, path),
        };
        (compression, path.file_stem().unwrap_or_default().as_ref())
    }

    /// The name of a file that is compressed so.
    pub(super) fn name(self, plain: &str) -> String {
        match self {
            Self::Plain => plain.into(),
            Self::Gzip => format!("{plain}.gz"),
            Self::Zstd => format!("{plain}.zst"),
        }
    }

    pub(super) fn pack(self, bytes: &[u8]) -> io::Result<Cow<'_, [u8]>> {
        Ok(match self {
            Self::Plain => bytes.into(),
            Self::Gzip => {
                let mut encoder = GzEncoder::new(vec![], flate2::Compression::default());
                encoder.write_all(bytes)?;
                encoder.finish()?.into()
            }
            Self::Zstd => zstd::stream::encode_all(bytes, 0)?.into(),
        })
    }

    pub(super) fn unpack(self, bytes: Vec<u8>) -> io::Result<Vec<u8>> {
        match self {
            Self::Plain => Ok(bytes),
            Self::Gzip => {
                let mut plain = vec![];
                flate2::read::GzDecoder::new(&bytes[..]).read_to_end(&mut plain)?;
                Ok(plain)
            }
            Self::Zstd => zstd::stream::decode_all(&bytes[..]),
        }
    }
}

pub(super) enum Sink {
    Plain(Box<dyn Write + Send>),
    Gzip(GzEncoder<Box<dyn Write + Send>>),
    Zstd(zstd::stream::write::Encoder<'static, Box<dyn Write + Send>>),
}

impl Sink {
    pub(super) fn new(writer: Box<dyn Write + Send>, compression: Compression) -> io::Result<Self> {
        Ok(match compression {
            Compression::Plain => Self::Plain(writer),
            Compression::Gzip => Self::Gzip(GzEncoder::new(writer, flate2::Compression::default())),
            // 0 is the default level of zstd.
            Compression::Zstd => Self::Zstd(zstd::stream::write::Encoder::new(writer, 0)?),
        })
    }

    pub(super) fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Plain(writer) => writer.write_all(bytes),
            Self::Gzip(encoder) => encoder.write_all(bytes),
            Self::Zstd(encoder) => encoder.write_all(bytes),
        }
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
