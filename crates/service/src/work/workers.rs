//! Handing work over: in which lane it takes its turn, and how its result comes back.

use std::{
    num::NonZero,
    sync::{Arc, atomic::Ordering},
    thread,
    time::Duration,
};

use strew_core::server::Stop;
use strew_error::Error;
use strew_plan::Lane;
use tokio::sync::oneshot;

use super::{
    Owner,
    crew::Crew,
    owner::Waiting,
    shift::{self, Lanes, Shift},
    turns::{Turn, Waiter},
};

#[derive(Clone)]
pub struct Workers {
    crew: Crew,
    lanes: Arc<Lanes>,
}

impl Workers {
    /// Threads for this number of pieces of short work at once, 0 for one per core, and half of it for long work.
    pub fn new(threads: usize) -> Self {
        let cores = || thread::available_parallelism().map_or(1, NonZero::get);
        let threads = if threads == 0 { cores() } else { threads };
        Self {
            crew: Crew::new(threads),
            lanes: Lanes::new(|lane| match lane {
                Lane::Short => threads,
                Lane::Long => (threads / 2).max(1),
                Lane::Making => 1,
            }),
        }
    }

    pub fn moved(&self) -> u64 {
        self.lanes.moved.load(Ordering::Relaxed)
    }

    /// The longest processor time that short work had before it ended or became long.
    pub fn longest_short(&self) -> Duration {
        Duration::from_nanos(self.lanes.longest.load(Ordering::Relaxed))
    }

    /// Runs a job when it is the turn of its owner's address, and waits for its result. The job
    /// should stop when the flag is raised: then the result is not wanted any more.
    pub async fn take_turn<T: Send + 'static>(
        &self,
        lane: Lane,
        job: impl FnOnce(&Stop) -> T + Send + 'static,
    ) -> Result<T, Error> {
        self.take_turn_for(&Owner::current(), lane, job).await
    }

    /// [`take_turn`](Self::take_turn) for a request that is not the one being answered.
    pub async fn take_turn_for<T: Send + 'static>(
        &self,
        owner: &Owner,
        lane: Lane,
        job: impl FnOnce(&Stop) -> T + Send + 'static,
    ) -> Result<T, Error> {
        let (answer, answered) = oneshot::channel();
        let shift = Shift::new(self.lanes.clone(), owner.clone(), lane);
        let stop = shift::stop();
        let wanted = Wanted(Some((stop.clone(), shift.clone())));
        let job = Job {
            waiting: owner.wait(),
            crew: self.crew.clone(),
            shift,
            answer,
            job: move || job(&stop),
        };
        self.lanes.turns(lane).take(owner.address(), Box::new(job));
        let answer = answered.await;
        wanted.over();
        answer.map_err(|_| Error::Internal("a computation failed"))
    }

    /// Runs a piece of work of some milliseconds when it is the turn of its owner's address.
    pub(crate) fn take_piece(
        &self,
        owner: &Owner,
        lane: Lane,
        piece: impl FnOnce() + Send + 'static,
    ) {
        let piece = Piece {
            crew: self.crew.clone(),
            shift: Shift::new(self.lanes.clone(), owner.clone(), lane),
            piece,
        };
        self.lanes
            .turns(lane)
            .take(owner.address(), Box::new(piece));
    }
}

/// Stops a job if it is dropped before its result arrives.
struct Wanted(Option<(Stop, Arc<Shift>)>);

impl Wanted {
    /// The result is there, and may look at the flag later.
    fn over(mut self) {
        self.0 = None;
    }
}

impl Drop for Wanted {
    fn drop(&mut self) {
        if let Some((stop, shift)) = &self.0 {
            stop.raise();
            shift.leave();
        }
    }
}

struct Job<T, F> {
    waiting: Waiting,
    crew: Crew,
    /// The hold on the job's turn.
    shift: Arc<Shift>,
    answer: oneshot::Sender<T>,
    job: F,
}

impl<T: Send + 'static, F: FnOnce() -> T + Send + 'static> Waiter for Job<T, F> {
    fn is_wanted(&self) -> bool {
        !self.answer.is_closed()
    }

    fn begin(self: Box<Self>, turn: Turn) {
        let Self {
            waiting,
            crew,
            shift,
            answer,
            job,
        } = *self;
        drop(waiting);
        shift.take(turn);
        let job = move || {
            if !answer.is_closed() {
                let result = job();
                shift::charge();
                let _ = answer.send(result);
            }
        };
        crew.work(shift, Box::new(job));
    }
}

struct Piece<F> {
    crew: Crew,
    shift: Arc<Shift>,
    piece: F,
}

impl<F: FnOnce() + Send + 'static> Waiter for Piece<F> {
    fn is_wanted(&self) -> bool {
        true
    }

    fn begin(self: Box<Self>, turn: Turn) {
        self.shift.take(turn);
        self.crew.work(self.shift, Box::new(self.piece));
    }
}

#[cfg(test)]
mod tests {
    use crate::access::{Caller, Gate, Usage};
    use std::sync::mpsc;
    use strew_config::Layers;

    use super::{super::shift::processor_time, *};
    use crate::{Budget, Record};

    fn record() -> Arc<Record> {
        Record::new(
            "r",
            None,
            Budget::new(1 << 20).of_address(Usage::unlimited()),
        )
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn long_work_leaves_short_work_its_threads() {
        let workers = Workers::new(1);
        let (end, held) = mpsc::channel::<()>();
        let long = workers.clone();
        let long = tokio::spawn(async move {
            long.take_turn(Lane::Long, move |_| held.recv().is_err())
                .await
        });
        for _ in 0..10 {
            let short = workers.take_turn(Lane::Short, |_| 7).await;
            assert_eq!(short, Ok(7));
        }
        drop(end);
        assert_eq!(long.await.expect("no panic"), Ok(true));
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn long_work_gives_way_to_other_addresses_and_goes_on_then() {
        let workers = Workers::new(1);
        let (end, endless) = endless(&workers, record(), Lane::Long);
        // The only place is taken by work that ends after this.
        let other = record().scope(workers.take_turn(Lane::Long, |_| 7)).await;
        assert_eq!(other, Ok(7));
        drop(end);
        assert_eq!(endless.await.expect("no panic"), Ok(()));
    }

    /// Starts work that ends when the sender is dropped, and waits until it has begun.
    fn endless(
        workers: &Workers,
        record: Arc<Record>,
        lane: Lane,
    ) -> (mpsc::Sender<()>, tokio::task::JoinHandle<Result<(), Error>>) {
        let (begun, has_begun) = mpsc::channel();
        let (end, is_over) = mpsc::channel::<()>();
        let job = move |stop: &Stop| {
            begun.send(()).expect("the test listens");
            while is_over.try_recv() == Err(mpsc::TryRecvError::Empty) {
                assert!(!stop.is_raised());
            }
        };
        let workers = workers.clone();
        let task = async move { workers.take_turn(lane, job).await };
        let task = tokio::spawn(record.scope(task));
        has_begun.recv().expect("it begins");
        (end, task)
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn short_work_that_takes_long_goes_on_as_long_work() {
        let workers = Workers::new(1);
        // Both at one address, which also has to wait for its turn among long work.
        let record = record();
        let (end, is_long) = endless(&workers, record.clone(), Lane::Long);
        let (end_other, is_short) = endless(&workers, record.clone(), Lane::Short);
        // The only place for short work is taken until it is given up.
        let short = record.scope(workers.take_turn(Lane::Short, |_| 7)).await;
        assert_eq!((short, workers.moved()), (Ok(7), 1));
        drop(end);
        assert_eq!(is_long.await.expect("no panic"), Ok(()));
        drop(end_other);
        assert_eq!(is_short.await.expect("no panic"), Ok(()));
        // A thread of the right priority does what comes next.
        for lane in [Lane::Short, Lane::Long] {
            let name = workers.take_turn(lane, |_| thread::current().name().map(String::from));
            let expected = if lane == Lane::Short {
                "strew-worker"
            } else {
                "strew-"
            };
            let name = name.await.expect("no panic").expect("a name");
            assert!(name.starts_with(expected), "{lane:?}: {name}");
        }
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn all_work_is_charged_for_the_time_it_took() {
        let settings = Layers::new().and_then(|settings| {
            let settings = settings.assignment("rate.points_per_second=1e-3")?;
            settings.assignment("rate.burst_points=1e9")?.finish()
        });
        let config = settings.expect("valid");
        let gate = Gate::new(config.access, &config.rate, config.per_address);
        let gate = gate.expect("valid");
        let address = std::net::IpAddr::from([192, 0, 2, 1]);
        let admitted = || gate.admit(None, address, Usage::unlimited());
        let left = |caller: &Caller| caller.level().expect("a rate").left;
        let workers = Workers::new(1);
        let busy = |lane, time: Duration| {
            let (workers, caller) = (workers.clone(), admitted().expect("let in"));
            record().scope(async move {
                Record::of(&caller);
                let job = move |stop: &Stop| {
                    let start = processor_time();
                    while processor_time() - start < time && !stop.is_raised() {}
                };
                workers.take_turn(lane, job).await.expect("no panic");
                caller
            })
        };
        let quick = busy(Lane::Short, Duration::ZERO).await;
        assert_eq!(left(&quick), 999_999_999);
        for lane in Lane::ALL {
            let before = left(&quick);
            let charged = before - left(&busy(lane, Duration::from_millis(60)).await);
            assert!((10_000..=13_000).contains(&charged), "{lane:?}: {charged}");
        }
        // The price counts first.
        let caller = admitted().expect("let in");
        caller.charge(1_000_000).expect("there");
        let before = left(&caller);
        caller.took(Duration::from_secs(5));
        assert_eq!(left(&caller), before);
        caller.took(Duration::from_secs(2));
        assert_eq!(before - left(&caller), 399_599);
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn work_that_is_not_wanted_ends_also_while_it_waits() {
        let workers = Workers::new(1);
        let (begun, has_begun) = mpsc::channel();
        let (ended, has_ended) = mpsc::channel();
        let job = move |stop: &Stop| {
            begun.send(()).expect("the test listens");
            while !stop.is_raised() {}
            ended.send(()).expect("the test listens");
        };
        let left = {
            let workers = workers.clone();
            tokio::spawn(record().scope(async move { workers.take_turn(Lane::Long, job).await }))
        };
        has_begun.recv().expect("it begins");
        left.abort();
        has_ended.recv().expect("it ends");
        assert_eq!(workers.take_turn(Lane::Long, |_| 8).await, Ok(8));
    }
}
