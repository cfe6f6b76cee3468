//! Text at the highest levels of compression, which is too slow for a request or a start.

use std::io::{self, Write as _};

pub struct Packed {
    pub zstd: Vec<u8>,
    pub gzip: Vec<u8>,
}

/// Compresses a text. Takes about a second for a megabyte.
pub fn packed(text: &[u8]) -> io::Result<Packed> {
    /// The highest level that needs no more than 8 MiB in browsers (RFC 9659).
    const ZSTD: i32 = 19;
    let mut gzip = flate2::write::GzEncoder::new(vec![], flate2::Compression::best());
    gzip.write_all(text)?;
    Ok(Packed {
        zstd: zstd::bulk::compress(text, ZSTD)?,
        gzip: gzip.finish()?,
    })
}
