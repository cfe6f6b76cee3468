//! Compressed bodies and parameters of clients: unpacked up to a limit, and charged to the byte budget as they grow.

use std::{
    io::{self, BufReader, Read},
    sync::Arc,
};

use bytes::Bytes;
use flate2::bufread::MultiGzDecoder;
use strew_core::server::Stop;
use strew_error::{Error, Fault};

use crate::{Budget, Held, Service, segments::Segments};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    Gzip,
    Zstd,
}

/// The bytes that are unpacked at once.
const PIECE: usize = 16 << 10;
/// Up to this size, bytes are unpacked in place, since handing them to a worker would take as long.
const FEW: usize = 4 << 10;
/// Frames of Zstandard that refer further back, in powers of two, are refused: decoders need not hold more than
/// 8 MiB (RFC 8878, 3.1.1.1.2).
const ZSTD_WINDOW: u32 = 23;

impl Service {
    /// Unpacks the bytes of `field`: at once if they are few, else on the workers.
    ///
    /// # Errors
    /// [`Error::BodyTooLarge`] if that makes more than a body may have, [`Error::Invalid`] if they are damaged,
    /// and as [`Budget::hold`] if there is no room.
    pub async fn unpacked(
        self: &Arc<Self>,
        coding: Coding,
        bytes: Bytes,
        field: &'static str,
    ) -> Result<Bytes, Error> {
        let (budget, limit) = (self.own_budget(), self.limits().max_body_bytes);
        if bytes.len() <= FEW
            && let Some(few) = unpack(coding, &bytes, FEW.min(limit), &budget, field)?
        {
            return Ok(few);
        }
        let all = move |_: &Self, _: &Stop| unpack(coding, &bytes, limit, &budget, field);
        let all = self.process(limit.max(MANY), all).await??;
        all.ok_or(Error::BodyTooLarge { limit })
    }
}

/// The price of bytes that are not few: they may become large, so they take turns with long work.
const MANY: usize = (64 << 10) + 1;

/// Unpacks bytes if that makes at most `most`; nothing if it makes more.
fn unpack(
    coding: Coding,
    bytes: &[u8],
    most: usize,
    budget: &Budget,
    field: &str,
) -> Result<Option<Bytes>, Error> {
    let wrong = |error: io::Error| {
        let name = match coding {
            Coding::Gzip => "gzip",
            Coding::Zstd => "zstd",
        };
        let value = format!("{} bytes", bytes.len());
        Fault::new(
            field,
            value,
            format!("not {name}: {error}"),
            format!("whole {name}"),
        )
    };
    let packed: Box<dyn Read> = match coding {
        Coding::Gzip => Box::new(MultiGzDecoder::new(bytes)),
        Coding::Zstd => {
            let decoder = zstd::Decoder::with_buffer(BufReader::with_capacity(PIECE, bytes));
            let mut decoder = decoder.map_err(wrong)?;
            decoder.window_log_max(ZSTD_WINDOW).map_err(wrong)?;
            Box::new(decoder)
        }
    };
    let (mut packed, mut held) = (packed, budget.hold(0)?);
    let mut piece = [0; PIECE];
    let mut all = Segments::default();
    loop {
        let length = packed.read(&mut piece).map_err(wrong)?;
        if length == 0 {
            let bytes = all.joined();
            return Ok(Some(Bytes::from_owner(Charged { bytes, _held: held })));
        }
        if all.len() + length > most {
            return Ok(None);
        }
        held.grow(length)?;
        all.append(&piece[..length]);
    }
}

/// Bytes with their share of the budget.
struct Charged {
    bytes: Bytes,
    _held: Held,
}

impl AsRef<[u8]> for Charged {
    fn as_ref(&self) -> &[u8] {
        &self.bytes
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    fn packed(coding: Coding, bytes: &[u8]) -> Vec<u8> {
        match coding {
            Coding::Gzip => {
                let mut encoder = flate2::write::GzEncoder::new(vec![], Default::default());
                encoder.write_all(bytes).expect("memory takes it");
                encoder.finish().expect("memory takes it")
            }
            Coding::Zstd => zstd::encode_all(bytes, 3).expect("memory takes it"),
        }
    }

    #[test]
    fn no_more_is_unpacked_than_is_allowed_and_all_of_it_is_held() {
        let budget = Budget::new(1 << 20);
        for coding in [Coding::Gzip, Coding::Zstd] {
            let whole = vec![7; 100_000];
            let bytes = packed(coding, &whole);
            let unpacked = unpack(coding, &bytes, whole.len(), &budget, "body");
            let unpacked = unpacked.expect("in order").expect("short enough");
            assert_eq!(unpacked, whole);
            assert_eq!(budget.held(), whole.len());
            drop(unpacked);
            assert_eq!(budget.held(), 0);
            let unpacked = unpack(coding, &bytes, whole.len() - 1, &budget, "body");
            assert_eq!(unpacked, Ok(None));
            let half = unpack(coding, &bytes[..bytes.len() / 2], 1 << 20, &budget, "body");
            assert!(matches!(half, Err(Error::Invalid(_))), "{half:?}");
            let refused = unpack(coding, &bytes, 1 << 20, &Budget::new(1000), "body");
            assert!(
                matches!(refused, Err(Error::NeedsMoreBytes { .. })),
                "{refused:?}"
            );
        }
    }

    #[test]
    fn a_frame_that_refers_too_far_back_is_refused() {
        let mut encoder = zstd::Encoder::new(vec![], 1).expect("memory takes it");
        encoder.window_log(27).expect("known");
        encoder.write_all(&[0; 1000]).expect("memory takes it");
        let bytes = encoder.finish().expect("memory takes it");
        let refused = unpack(Coding::Zstd, &bytes, 1 << 20, &Budget::new(1 << 20), "body");
        assert!(matches!(refused, Err(Error::Invalid(_))), "{refused:?}");
    }
}
