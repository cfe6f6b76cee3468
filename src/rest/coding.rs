//! Content codings: text goes out compressed to clients that accept it, block by block.
//!
//! Packed formats, pictures and Arrow stay as they are: noise does not compress. What coding an
//! answer gets depends on nothing but `Accept-Encoding` and the content type, so that its tag
//! (`freshness`) can be known before it is made. It is chosen once: an answer with a tag carries it as
//! [`Decided`].

use std::{convert::Infallible, io};

use axum::body::{BodyDataStream, to_bytes};
use bytes::Bytes;
use futures_util::{StreamExt as _, stream};
use http::{HeaderMap, HeaderValue, header};
use strew_error::Error;
use strew_plan::Lane;
use strew_service::{Held, Owner, Service, Workers};

use super::negotiate::{BY_CODING, Coding, vary};
use crate::body::{Body, BoxError, Response, Whole};

/// The coding of an answer whose tag says it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Decided(pub(super) Option<Coding>);

#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    coding: Coding,
    /// Whether its tag says so.
    is_decided: bool,
}

/// Chooses a coding for an answer, as its content type and the client's headers say.
pub(super) fn choose(accept: &HeaderMap, response: &mut Response) -> Option<Choice> {
    let decided = response.extensions_mut().remove::<Decided>();
    let answer = response.headers_mut();
    // Also of answers that stay plain: with other headers they would not.
    vary(answer, BY_CODING);
    // Without a choice nothing else is looked at.
    if accept.is_empty() && decided.is_none_or(|Decided(coding)| coding.is_none()) {
        return None;
    }
    if answer.contains_key(header::CONTENT_ENCODING) {
        return None;
    }
    let content_type = answer.get(header::CONTENT_TYPE)?.to_str().ok()?;
    let coding = match decided {
        Some(Decided(coding)) => coding,
        None => Coding::chosen(accept, content_type),
    };
    let is_decided = decided.is_some();
    coding.map(|coding| Choice { coding, is_decided })
}

impl Choice {
    pub(super) async fn apply(
        self,
        is_head: bool,
        service: &Service,
        response: Response,
    ) -> Result<Response, Error> {
        let Self { coding, is_decided } = self;
        let whole = http_body::Body::size_hint(response.body()).exact();
        // Without a tag, which names the coding, an answer may stay plain: where that is shorter, and where
        // there is no room for a compressor.
        if !is_decided {
            let length = response.headers().get(header::CONTENT_LENGTH);
            let length = length.and_then(|value| value.to_str().ok()?.parse::<u64>().ok());
            let is_short = length.or(whole).is_some_and(|length| length < SHORT);
            if is_short || service.hold(coding.memory()).is_err() {
                return Ok(response);
            }
        }
        let (mut parts, body) = response.into_parts();
        let _held = parts.extensions.remove::<Whole>();
        let mut held = None;
        let body = match whole {
            // The length is not known, which an empty body would not say.
            _ if is_head => unknown_length(),
            Some(length) => {
                let encoded = whole_document(body, length, coding, service).await?;
                held = Some(service.hold(encoded.len())?);
                Body::from(encoded)
            }
            None => {
                let held = service.hold(coding.memory())?;
                let encoder = Encoder::new(coding).map_err(|_| FAILED)?;
                compressed(body, encoder, service.workers().clone(), held)
            }
        };
        let name = HeaderValue::from_static(coding.name());
        parts.headers.insert(header::CONTENT_ENCODING, name);
        parts.headers.remove(header::CONTENT_LENGTH);
        parts.headers.remove(header::ACCEPT_RANGES);
        let mut response = Response::from_parts(parts, body);
        if let Some(held) = held {
            Whole::hold(&mut response, held);
        }
        Ok(response)
    }
}

/// Compressing less than a packet gains nothing.
const SHORT: u64 = 1024;

const FAILED: Error = Error::Internal("an answer cannot be compressed");

pub(super) fn unknown_length() -> Body {
    Body::from_stream(stream::empty::<Result<Bytes, Infallible>>())
}

async fn whole_document(
    body: Body,
    length: u64,
    coding: Coding,
    service: &Service,
) -> Result<Bytes, Error> {
    /// Compressing more than this takes milliseconds.
    const MUCH: u64 = 256 << 10;
    let _held = service.hold(coding.memory())?;
    let most = usize::try_from(length).unwrap_or(usize::MAX);
    let plain = to_bytes(body, most).await.map_err(|_| FAILED)?;
    let lane = match length <= MUCH {
        true => Lane::Short,
        false => Lane::Long,
    };
    let encode = move |_: &_| Encoder::whole(coding, &plain);
    let encoded = service.workers().take_turn(lane, encode).await?;
    encoded.map_err(|_| FAILED)
}

/// A body compressed block by block, each sent on when it is done. The work is done where points
/// are made; meanwhile the next block is being made.
fn compressed(body: Body, encoder: Encoder, workers: Workers, held: Held) -> Body {
    // The body is polled outside of its request.
    let threads = (workers, Owner::current());
    let start = Some((body.into_data_stream(), encoder));
    Body::from_stream(stream::try_unfold(start, move |state| {
        // The memory of the encoder is held as long as the stream is.
        let _ = &held;
        next_block(state, threads.clone())
    }))
}

type State = Option<(BodyDataStream, Encoder)>;

async fn next_block(
    state: State,
    (workers, owner): (Workers, Owner),
) -> Result<Option<(Bytes, State)>, BoxError> {
    let Some((mut blocks, encoder)) = state else {
        return Ok(None);
    };
    let block = blocks.next().await.transpose()?;
    let is_last = block.is_none();
    let encode = move |_: &_| encoder.encode(block);
    let made = workers.take_turn_for(&owner, Lane::Short, encode).await;
    let (encoder, encoded) = made??;
    Ok(Some((encoded, (!is_last).then_some((blocks, encoder)))))
}

/// Points are made faster than anything is compressed, and their digits are noise, so low levels
/// are the right ones. Of CSV: zstd 1 leaves 34 % at 265 MB/s, zstd 6 33 % at 66; gzip 2 40 % at
/// 114 MB/s, gzip 6 38 % at 56, gzip 1 58 % at 167 (one busy core).
const ZSTD_LEVEL: i32 = 1;
const GZIP_LEVEL: u32 = 2;

pub(super) enum Encoder {
    Zstd(zstd::stream::write::Encoder<'static, Vec<u8>>),
    Gzip(flate2::write::GzEncoder<Vec<u8>>),
}

impl Encoder {
    pub(super) fn new(coding: Coding) -> io::Result<Self> {
        Ok(match coding {
            Coding::Zstd => Self::Zstd(zstd::stream::write::Encoder::new(vec![], ZSTD_LEVEL)?),
            Coding::Gzip => {
                let level = flate2::Compression::new(GZIP_LEVEL);
                Self::Gzip(flate2::write::GzEncoder::new(vec![], level))
            }
        })
    }

    pub(super) fn whole(coding: Coding, plain: &[u8]) -> io::Result<Bytes> {
        let mut encoder = Self::new(coding)?;
        if let Self::Zstd(encoder) = &mut encoder {
            // A small document needs no large window.
            encoder.set_pledged_src_size(Some(plain.len() as u64))?;
        }
        encoder.writer().write_all(plain)?;
        Ok(encoder.encode(None)?.1)
    }

    fn writer(&mut self) -> &mut dyn io::Write {
        match self {
            Self::Zstd(encoder) => encoder,
            Self::Gzip(encoder) => encoder,
        }
    }

    /// The compressed bytes of a block, from which all of it can be read; after the last one, the end.
    pub(super) fn encode(mut self, block: Option<Bytes>) -> io::Result<(Self, Bytes)> {
        match (&mut self, block) {
            (encoder, Some(block)) => {
                encoder.writer().write_all(&block)?;
                encoder.writer().flush()?;
            }
            (Self::Zstd(encoder), None) => encoder.do_finish()?,
            (Self::Gzip(encoder), None) => encoder.try_finish()?,
        }
        let written = match &mut self {
            Self::Zstd(encoder) => std::mem::take(encoder.get_mut()),
            Self::Gzip(encoder) => std::mem::take(encoder.get_mut()),
        };
        Ok((self, written.into()))
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use super::*;

    fn read(coding: Coding, bytes: &[u8], most: usize) -> Vec<u8> {
        let mut text = vec![0; most];
        let mut read = 0;
        let mut reader: Box<dyn io::Read> = match coding {
            Coding::Zstd => Box::new(zstd::stream::read::Decoder::new(bytes).expect("a decoder")),
            Coding::Gzip => Box::new(flate2::read::GzDecoder::new(bytes)),
        };
        // A stream that was cut reads as an error at its end.
        while let Ok(1..) = reader.read(&mut text[read..]).inspect(|n| read += n) {}
        text.truncate(read);
        text
    }

    #[test]
    fn every_block_can_be_read_as_soon_as_it_is_sent() {
        for coding in Coding::ALL {
            let mut encoder = Encoder::new(coding).expect("an encoder");
            let (mut plain, mut sent) = (vec![], vec![]);
            for i in 0..20u32 {
                let block: Vec<u8> = (0..5000u32)
                    .flat_map(|j| {
                        format!("{},", (i * 7919 + j).wrapping_mul(2_654_435_761) >> 16)
                            .into_bytes()
                    })
                    .collect();
                plain.extend_from_slice(&block);
                let (next, bytes) = encoder.encode(Some(block.into())).expect("encoded");
                encoder = next;
                sent.extend_from_slice(&bytes);
                assert_eq!(
                    read(coding, &sent, plain.len()),
                    plain,
                    "{coding:?}, block {i}"
                );
            }
            sent.extend_from_slice(&encoder.encode(None).expect("ended").1);
            assert_eq!(read(coding, &sent, plain.len() + 1), plain);
            assert!(sent.len() < plain.len() * 2 / 3);
        }
    }
}
