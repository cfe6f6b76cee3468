//! Messages of requests: read whole, looked at before they are decoded, decoded where their length belongs.

mod most;
mod walk;

use std::sync::Arc;

use strew_core::server::Stop;
use strew_error::Error;
use strew_service::access::Caller;
use strew_service::{Held, Service, charge_reading};

use super::codec::Raw;
pub(super) use walk::{Shaped, no_message};

/// Reading a byte of a picture may take as long as reading this many of text.
const PIXELS: usize = 1 << 10;
/// Besides the message: what it is checked as, and the query.
const COPIES: usize = 3;

/// The message of a request.
pub(super) struct Decoded<M> {
    pub(super) message: Box<M>,
    /// As long as this many bytes of text it takes to check.
    pub(super) effort: usize,
}

impl<M: Shaped> Raw<M> {
    /// The message, and what is held of the byte budget for it.
    pub(super) async fn decoded(
        self,
        service: &Arc<Service>,
        caller: &Caller,
    ) -> Result<(Decoded<M>, Held), Error> {
        let bytes = self.bytes;
        let length = bytes.len();
        charge_reading(caller, length)?;
        let mut held = service.hold(0)?;
        let decode = move |service: &Service, _: &Stop| {
            let cost = walk::cost(M::SHAPE, &bytes, service.limits())?;
            held.grow(COPIES * cost.memory)?;
            let message = M::decode(bytes).map_err(|error| no_message(&error.to_string()))?;
            let decoded = Decoded {
                message: Box::new(message),
                effort: length + PIXELS * cost.pixels,
            };
            Ok((decoded, held))
        };
        service.process(length, decode).await.flatten()
    }
}

#[cfg(test)]
mod tests;
