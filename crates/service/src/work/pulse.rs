//! The pulse: whether short work still gets its turn in time.
//!
//! A daemon whose workers are stuck still answers what needs none of them. So it hands them a piece of work every
//! second, as a client would, and looks at how long that takes.

use std::time::{Duration, Instant};

use parking_lot::Mutex;
use strew_plan::Lane;
use tokio::sync::watch::Sender;

use super::Workers;

/// The time between two beats.
const PACE: Duration = Duration::from_secs(1);

/// How long the last beat has been waiting, if it is.
#[derive(Debug, Default)]
pub struct Pulse(Mutex<Option<Instant>>);

impl Pulse {
    /// Hands work to workers again and again, and reports when it begins or ceases to wait for longer than `bound`:
    /// whether it is done in time.
    pub async fn beat(&self, workers: Workers, bound: Duration, in_time: Sender<bool>) {
        loop {
            *self.0.lock() = Some(Instant::now());
            let beat = workers.take_turn(Lane::Short, |_| ());
            tokio::pin!(beat);
            if tokio::time::timeout(bound, &mut beat).await.is_err() {
                in_time.send_replace(false);
                let _ = beat.await;
                in_time.send_replace(true);
            }
            *self.0.lock() = None;
            tokio::time::sleep(PACE).await;
        }
    }

    pub fn is_within(&self, bound: Duration) -> bool {
        let begun = *self.0.lock();
        begun.is_none_or(|begun| begun.elapsed() <= bound)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use tokio::sync::watch;

    use super::*;

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn stuck_workers_have_no_pulse() {
        let workers = Workers::new(1);
        let (release, held) = mpsc::channel::<()>();
        let stuck = workers.clone();
        let job = move |_: &_| held.recv().is_err();
        let stuck = tokio::spawn(async move { stuck.take_turn(Lane::Short, job).await });
        let (sender, mut in_time) = watch::channel(true);
        let beating = tokio::spawn(async move {
            let bound = Duration::from_millis(1);
            Pulse::default().beat(workers, bound, sender).await;
        });
        in_time
            .wait_for(|in_time| !in_time)
            .await
            .expect("it beats");
        drop(release);
        in_time
            .wait_for(|in_time| *in_time)
            .await
            .expect("it beats");
        assert_eq!(stuck.await.expect("no panic"), Ok(true));
        beating.abort();
    }
}
