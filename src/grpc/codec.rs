//! The codec of the calls: a request stays the bytes that it came as, an answer is what prost writes.
//!
//! So a message is looked at and paid for before it is decoded, and is decoded where its length belongs.

use std::marker::PhantomData;

use bytes::{Buf as _, Bytes};
use prost::Message;
use tonic::{
    Status,
    codec::{self, DecodeBuf},
};
use tonic_prost::ProstEncoder;

/// The bytes of a message that is not decoded yet.
#[derive(Debug)]
pub struct Raw<M> {
    pub(super) bytes: Bytes,
    message: PhantomData<fn() -> M>,
}

/// Reads messages as they are, and writes answers.
#[derive(Debug)]
pub struct Codec<M, A>(PhantomData<fn() -> (M, A)>);

impl<M, A> Default for Codec<M, A> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<M: 'static, A: Message + 'static> codec::Codec for Codec<M, A> {
    type Encode = A;
    type Decode = Raw<M>;
    type Encoder = ProstEncoder<A>;
    type Decoder = Self;

    fn encoder(&mut self) -> ProstEncoder<A> {
        ProstEncoder::default()
    }

    fn decoder(&mut self) -> Self {
        Self::default()
    }
}

impl<M, A> codec::Decoder for Codec<M, A> {
    type Item = Raw<M>;
    type Error = Status;

    fn decode(&mut self, bytes: &mut DecodeBuf<'_>) -> Result<Option<Raw<M>>, Status> {
        let bytes = bytes.copy_to_bytes(bytes.remaining());
        let message = PhantomData;
        Ok(Some(Raw { bytes, message }))
    }
}
