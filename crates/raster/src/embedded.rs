//! Strips and tiles of a TIFF that are JPEGs or WebPs. They are decoded here, not by the crate of TIFF, so that none is
//! larger than its place, JPEGs that are cut off are refused, and cosine transforms are the same on all machines.

use std::io::{Cursor, Read, Seek, SeekFrom};

use tiff::{
    decoder::{ChunkType, Decoder},
    tags::Tag,
};

use super::{
    error::RasterError,
    picture,
    tiff_faults::{broken, damaged},
};

/// The codes of compressions.
const JPEG: u16 = 7;
const WEBP: u16 = 50001;

pub(super) struct Embedded {
    pub(super) is_jpeg: bool,
    /// Whether the pixels of a JPEG are stored as YCbCr and meant as RGB. Others are meant as they are stored.
    is_ycbcr: bool,
    /// The tables that all JPEGs share, without their end marker.
    tables: Vec<u8>,
    starts: Vec<u64>,
    lengths: Vec<u64>,
}

impl Embedded {
    /// Those of the current directory, if it has any.
    pub(super) fn of(decoder: &mut Decoder<impl Read + Seek>) -> Result<Option<Self>, RasterError> {
        let mut number = |tag| decoder.find_tag_unsigned::<u16>(tag).map_err(damaged);
        let compression = number(Tag::Compression)?;
        let Some(JPEG | WEBP) = compression else {
            return Ok(None);
        };
        let is_ycbcr = number(Tag::PhotometricInterpretation)? == Some(6);
        let tables = decoder.find_tag(Tag::JPEGTables).map_err(damaged)?;
        let tables = tables.map(|tables| tables.into_u8_vec().map_err(damaged));
        let mut tables = tables.transpose()?.unwrap_or_default();
        tables.truncate(tables.len().saturating_sub(2));
        let tags = match decoder.get_chunk_type() {
            ChunkType::Strip => [Tag::StripOffsets, Tag::StripByteCounts],
            ChunkType::Tile => [Tag::TileOffsets, Tag::TileByteCounts],
        };
        let mut numbers = |tag| decoder.find_tag_unsigned_vec(tag).map_err(damaged);
        Ok(Some(Self {
            is_jpeg: compression == Some(JPEG),
            is_ycbcr,
            tables,
            starts: numbers(tags[0])?.unwrap_or_default(),
            lengths: numbers(tags[1])?.unwrap_or_default(),
        }))
    }

    /// The bytes of a strip or tile of `across` columns and `tall` rows, up to the pixel that is farthest from its first.
    pub(super) fn read(
        &self,
        from: &mut (impl Read + Seek),
        chunk: usize,
        [across, tall]: [usize; 2],
        [width, height]: [usize; 2],
        channels: usize,
    ) -> Result<Vec<u8>, RasterError> {
        let (Some(start), Some(length)) = (self.starts.get(chunk), self.lengths.get(chunk)) else {
            return Err(broken("it has too few strips or tiles"));
        };
        let mut bytes = vec![];
        from.seek(SeekFrom::Start(*start))?;
        from.take(*length).read_to_end(&mut bytes)?;
        let mut found = 0;
        let check = |[x, y]: [usize; 2], stored: usize| {
            found = stored;
            // The alpha of a WebP may be left out.
            let is_opaque = !self.is_jpeg && [stored, channels] == [3, 4];
            let detail = match x == across && (height..=tall).contains(&y) {
                false => format!("a strip or tile has {x} × {y} pixels"),
                true if stored == channels || is_opaque => return Ok(()),
                true => format!("a strip or tile has {stored} channels"),
            };
            Err(broken(&detail))
        };
        let (_, pixels, _) = if self.is_jpeg {
            if !self.tables.is_empty() && bytes.len() > 2 {
                bytes.splice(..2, self.tables.iter().copied());
            }
            picture::jpeg_pixels(Cursor::new(bytes), self.is_ycbcr, check)?
        } else {
            picture::webp_pixels(Cursor::new(bytes), check)?
        };
        let rows = pixels.chunks_exact(across * found).take(height);
        let all = rows.flat_map(|row| row[..width * found].chunks_exact(found));
        let opaque = vec![u8::MAX; channels - found];
        Ok(all
            .flat_map(|pixel| pixel.iter().chain(&opaque))
            .copied()
            .collect())
    }
}
