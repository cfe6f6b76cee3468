//! Token buckets that points are taken from.
//!
//! A bucket fills at a steady rate up to its burst. A request is let through if the bucket holds
//! its points. One larger than the burst is let through when the bucket is full, and the bucket owes the
//! rest: so on average no client exceeds the rate, and every answer within the server's limits is
//! possible.

use std::time::{Duration, Instant};

use parking_lot::Mutex;
use strew_error::{Level, Rate, Short};

#[derive(Debug)]
pub struct Bucket {
    rate: Rate,
    state: Mutex<State>,
}

#[derive(Clone, Copy, Debug)]
struct State {
    /// The points in the bucket; negative while it owes some.
    points: f64,
    at: Instant,
}

impl Bucket {
    pub(super) const fn full(rate: Rate, now: Instant) -> Self {
        Self {
            rate,
            state: Mutex::new(State {
                points: rate.burst_points,
                at: now,
            }),
        }
    }

    pub(super) const fn rate(&self) -> Rate {
        self.rate
    }

    /// Takes points, all or none. `taken` are those that the same request has taken before: without
    /// them a bucket is as full as it can be.
    pub(super) fn take(&self, points: f64, taken: f64, now: Instant) -> Result<(), Short> {
        self.with(now, |rate, held| {
            let needed = points.min(rate.burst_points - taken);
            if *held >= needed {
                *held -= points;
                return Ok(());
            }
            Err(Short {
                level: level(rate, *held),
                wait: seconds((needed - *held) / rate.points_per_second),
            })
        })
    }

    /// Takes points that are not there, too.
    pub(super) fn owe(&self, points: f64, now: Instant) {
        self.with(now, |_, held| *held -= points);
    }

    /// The points in the bucket, and when it will be full.
    pub(super) fn level(&self, now: Instant) -> Level {
        self.with(now, |rate, held| level(rate, *held))
    }

    fn with<T>(&self, now: Instant, act: impl FnOnce(Rate, &mut f64) -> T) -> T {
        let mut state = self.state.lock();
        // Requests meet here in another order than their clocks were read.
        let passed = now.saturating_duration_since(state.at).as_secs_f64();
        state.at = state.at.max(now);
        let filled = state.points + passed * self.rate.points_per_second;
        state.points = filled.min(self.rate.burst_points);
        act(self.rate, &mut state.points)
    }
}

fn level(rate: Rate, held: f64) -> Level {
    Level {
        rate,
        left: held.max(0.0) as u64,
        full_in: seconds((rate.burst_points - held) / rate.points_per_second),
    }
}

fn seconds(value: f64) -> Duration {
    Duration::try_from_secs_f64(value.max(0.0)).unwrap_or(Duration::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: Rate = Rate {
        points_per_second: 100.0,
        burst_points: 1000.0,
    };

    #[test]
    fn no_client_exceeds_burst_and_rate() {
        let start = Instant::now();
        let bucket = Bucket::full(RATE, start);
        bucket.take(600.0, 0.0, start).expect("there");
        let short = bucket.take(600.0, 0.0, start).expect_err("too much");
        assert_eq!(short.wait, Duration::from_secs(2));
        assert_eq!(short.level.left, 400);
        assert_eq!(short.level.full_in, Duration::from_secs(6));
        // A refused request costs nothing.
        let later = start + short.wait;
        bucket.take(600.0, 0.0, later).expect("as was said");
        assert_eq!(bucket.level(later).left, 0);
        let rested = later + Duration::from_secs(3600);
        assert_eq!(bucket.level(rested).left, 1000);
    }

    #[test]
    fn more_than_the_burst_needs_a_full_bucket_and_is_owed() {
        let start = Instant::now();
        let bucket = Bucket::full(RATE, start);
        bucket.take(1.0, 0.0, start).expect("full");
        assert!(bucket.take(5000.0, 0.0, start).is_err());
        bucket
            .take(4999.0, 1.0, start)
            .expect("full but for its own");
        assert_eq!(bucket.level(start).left, 0);
        let short = bucket.take(1.0, 0.0, start).expect_err("it owes");
        assert_eq!(short.wait, Duration::from_millis(40_010));
        let short = bucket.take(5000.0, 0.0, start).expect_err("it owes");
        assert_eq!(short.wait, Duration::from_secs(50));
        bucket
            .take(5000.0, 0.0, start + short.wait)
            .expect("paid back");
    }

    #[test]
    fn clocks_that_disagree_give_nothing_away() {
        let start = Instant::now();
        let bucket = Bucket::full(RATE, start + Duration::from_secs(5));
        bucket
            .take(1000.0, 0.0, start + Duration::from_secs(5))
            .expect("full");
        assert!(bucket.take(1.0, 0.0, start).is_err());
        assert!(
            bucket
                .take(1.0, 0.0, start + Duration::from_secs(5))
                .is_err()
        );
    }
}
