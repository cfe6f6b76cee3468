//! The client of a request, as far as it affects the answer.

use std::{
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
    time::{Duration, Instant},
};

use parking_lot::{Mutex, MutexGuard};
use strew_error::{Denied, Level};

use super::{InUse, Quota, Usage, bucket::Bucket};

/// The price of a request, in points.
const REQUEST: u128 = 1;
/// A price is an estimate, and may be wrong. Work that takes longer than this for each point charged is charged a point
/// for each such time, beyond the first milliseconds: so what is quick has the same price always.
const POINT: Duration = Duration::from_micros(5);
const QUICK: Duration = Duration::from_millis(2);

#[derive(Clone, Debug, Default)]
pub struct Caller {
    pub(super) name: Option<Arc<str>>,
    pub(super) is_admin: bool,
    pub(super) max_points: Option<u64>,
    pub(super) places: Option<Arc<Places>>,
    pub(super) bucket: Option<Arc<Bucket>>,
    /// The expenses of its request; those of a key are not kept.
    pub(super) spent: Option<Arc<Mutex<Spent>>>,
    pub(super) usage: Option<Arc<Usage>>,
}

/// What a request has cost so far.
#[derive(Debug, Default)]
pub(super) struct Spent {
    /// The points charged.
    points: f64,
    /// The processor time of its work.
    time: Duration,
}

/// The streams that a key may have at once, and those that it has.
#[derive(Debug)]
pub(super) struct Places {
    pub(super) limit: usize,
    pub(super) open: Arc<AtomicUsize>,
}

/// A place for one stream, of the key and of the address; given back when dropped.
#[derive(Debug)]
pub struct Place {
    open: Option<Arc<AtomicUsize>>,
    _address: Option<InUse>,
}

impl Drop for Place {
    fn drop(&mut self) {
        if let Some(open) = &self.open {
            open.fetch_sub(1, Ordering::AcqRel);
        }
    }
}

impl Caller {
    pub fn admin() -> Self {
        Self {
            is_admin: true,
            ..Self::default()
        }
    }

    /// The name of the key, if there was one.
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Whether the caller may change what the daemon does.
    ///
    /// # Errors
    /// [`Denied::NotAdmin`] if not.
    pub fn must_be_admin(&self) -> Result<(), Denied> {
        if self.is_admin {
            return Ok(());
        }
        Err(Denied::NotAdmin {
            name: self.name().map(Into::into),
        })
    }

    /// The most points of one answer, where the server allows `limit`.
    pub fn max_points(&self, limit: u64) -> u64 {
        self.max_points.map_or(limit, |own| own.min(limit))
    }

    /// A place for one more stream among `all`.
    ///
    /// # Errors
    /// [`Denied::TooManyStreams`] if the key has reached its limit of streams, [`Denied::Address`] and
    /// [`Denied::Share`] if the address has reached its own.
    pub fn place(&self, all: &Quota) -> Result<Place, Denied> {
        let usage = self.usage.as_ref();
        let mut place = Place {
            open: None,
            _address: usage.map(|usage| usage.stream(all)).transpose()?,
        };
        if let Some(places) = &self.places {
            let limit = places.limit;
            let more = |open: usize| (open < limit).then_some(open + 1);
            places
                .open
                .fetch_update(Ordering::AcqRel, Ordering::Acquire, more)
                .map_err(|_| Denied::TooManyStreams { limit })?;
            place.open = Some(places.open.clone());
        }
        Ok(place)
    }

    /// Takes points from the caller's rate, before the work that they are the price of.
    ///
    /// # Errors
    /// [`Denied::TooFast`] if there are too few; then nothing is taken.
    pub fn charge(&self, points: u128) -> Result<(), Denied> {
        let Some(bucket) = &self.bucket else {
            return Ok(());
        };
        let mut spent = self.spent();
        let before = spent.as_ref().map_or(0.0, |spent| spent.points);
        let taken = bucket.take(points as f64, before, Instant::now());
        taken.map_err(|short| Denied::TooFast { points, short })?;
        if let Some(spent) = &mut spent {
            spent.points += points as f64;
        }
        Ok(())
    }

    /// Counts the processor time of work for the request. What it took beyond the points charged is charged now, also
    /// where there are too few: the work is done.
    pub fn took(&self, time: Duration) {
        let (Some(bucket), Some(mut spent)) = (&self.bucket, self.spent()) else {
            return;
        };
        spent.time += time;
        let time = spent.time.saturating_sub(QUICK);
        let owed = time.div_duration_f64(POINT) - spent.points;
        if owed > 0.0 {
            bucket.owe(owed, Instant::now());
            spent.points += owed;
        }
    }

    pub(super) fn begin(&mut self) -> Result<(), Denied> {
        self.spent = self.bucket.is_some().then(Arc::default);
        self.charge(REQUEST)
    }

    fn spent(&self) -> Option<MutexGuard<'_, Spent>> {
        Some(self.spent.as_ref()?.lock())
    }

    pub fn level(&self) -> Option<Level> {
        let bucket = self.bucket.as_ref()?;
        Some(bucket.level(Instant::now()))
    }
}
