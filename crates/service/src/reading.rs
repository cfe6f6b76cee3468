//! Reading requests: on the threads that serve sockets if it takes no time, else on the workers.
//!
//! How long it takes is known from the bytes of the request, and of pictures from their headers.

use std::sync::Arc;

use crate::access::Caller;
use strew_catalog::bounded_list::until;
use strew_core::server::Stop;
use strew_error::Error;
use strew_plan::Lane;
use strew_raster::Price;

use crate::{Record, Service};

/// Up to this number of bytes, work takes no longer than handing it over.
const FEW: usize = 4 << 10;
/// More bytes than this take milliseconds.
const MANY: usize = 64 << 10;

/// The lane in which this number of bytes is processed; none if they are few enough to process at once.
fn lane(bytes: usize) -> Option<Lane> {
    if bytes <= FEW {
        return None;
    }
    Some(match bytes <= MANY {
        true => Lane::Short,
        false => Lane::Long,
    })
}

/// Charges a caller for a request of this many bytes, before any of them is read.
pub fn charge_reading(caller: &Caller, bytes: usize) -> Result<(), Error> {
    /// The bytes that are read and checked in a microsecond.
    const BYTES: usize = 50;
    match bytes <= FEW {
        true => Ok(()),
        false => Ok(caller.charge((bytes / BYTES) as u128)?),
    }
}

impl Service {
    /// Reads or writes this many bytes of a request or an answer: at once if they are few, else on the
    /// workers. The job should stop when the flag is raised: then the result is not wanted any more.
    pub async fn process<T: Send + 'static>(
        self: &Arc<Self>,
        bytes: usize,
        job: impl FnOnce(&Self, &Stop) -> T + Send + 'static,
    ) -> Result<T, Error> {
        let Some(lane) = lane(bytes) else {
            return Ok(job(self, &Stop::NEVER));
        };
        let (service, record) = (self.clone(), Record::current());
        let job = move |stop: &Stop| until(stop, || job(&service, stop));
        let job = move |stop: &Stop| Record::within(record, || job(stop));
        self.workers.take_turn(lane, job).await
    }

    /// Reads a request of this many bytes, then checks it: where that belongs by the pictures in it.
    pub async fn read<R: Send + 'static, T: Send + 'static>(
        self: &Arc<Self>,
        bytes: usize,
        read: impl FnOnce() -> Result<R, Error> + Send + 'static,
        price: fn(&R) -> Price,
        check: impl FnOnce(&Self, R, &Stop) -> Result<T, Error> + Send + 'static,
    ) -> Result<T, Error> {
        let first = move |service: &Self, stop: &Stop| {
            let read = read()?;
            let all = price(&read).bytes.max(bytes);
            Ok::<_, Error>(match lane(all) == lane(bytes) {
                true => Ok(check(service, read, stop)),
                false => Err((read, check, all)),
            })
        };
        match self.process(bytes, first).await?? {
            Ok(checked) => checked,
            Err((read, check, all)) => {
                let check = move |service: &Self, stop: &Stop| check(service, read, stop);
                self.process(all, check).await?
            }
        }
    }
}
