//! Calls that Ctrl-C ends, with the limits of this process.

use std::{
    cell::Cell,
    process,
    sync::{
        Mutex, PoisonError,
        atomic::Ordering,
        mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel},
    },
    thread,
    time::Duration,
};

use pyo3::{exceptions::PyRuntimeError, prelude::*, types::PyDict};
use strew_error::Error;
use strew_plan::{
    Library,
    library::{MOST_PIXELS, Work},
};

use crate::{failure::raised, library};

/// How often a call looks at signals and reports progress.
const TICK: Duration = Duration::from_millis(50);
/// How long a call that was interrupted waits for its work to end. What takes longer ends by itself, and what it made
/// is dropped.
const PATIENCE: Duration = Duration::from_millis(500);

/// The most points, rows, vertices and pixels, where the caller has set them.
static LIMITS: Mutex<[Option<u64>; 4]> = Mutex::new([None; 4]);

type Job = Box<dyn FnOnce() + Send>;
/// A thread that does one job after another, and the process that has it: forks have no threads.
type Worker = (u32, SyncSender<Job>);

thread_local! {
    static WORKER: Cell<Option<Worker>> = const { Cell::new(None) };
}

/// Sets limits of this process, and returns all of them.
#[pyfunction]
pub fn limits(py: Python<'_>, changed: [Option<u64>; 4]) -> PyResult<Bound<'_, PyDict>> {
    let plain = library()?.limits();
    let plain = [
        plain.max_points,
        plain.max_rows,
        plain.max_vertices as u64,
        MOST_PIXELS as u64,
    ];
    let mut set = LIMITS.lock().unwrap_or_else(PoisonError::into_inner);
    let told = PyDict::new(py);
    for (i, name) in ["points", "rows", "vertices", "pixels"].iter().enumerate() {
        set[i] = changed[i].or(set[i]);
        told.set_item(name, set[i].unwrap_or(plain[i]))?;
    }
    Ok(told)
}

/// The library with the limits of this process, for work that can be stopped.
fn limited(work: Work) -> PyResult<Library> {
    let library = library()?;
    let set = *LIMITS.lock().unwrap_or_else(PoisonError::into_inner);
    let size = |i: usize| set[i].map(|most| usize::try_from(most).unwrap_or(usize::MAX));
    let mut limits = library.limits().clone();
    limits.max_points = set[0].unwrap_or(limits.max_points);
    limits.max_rows = set[1].unwrap_or(limits.max_rows);
    limits.max_vertices = size(2).unwrap_or(limits.max_vertices);
    Ok(library.with(work, limits, size(3).unwrap_or(MOST_PIXELS)))
}

/// Does work in a thread of its own, without the interpreter's lock, while this one looks at signals. An exception of a
/// signal's handler, or of whoever follows the progress, stops the work. `total` is the number of points it makes.
pub fn done<T: Send + 'static>(
    py: Python<'_>,
    total: Option<u128>,
    work: impl FnOnce(&Library) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    let call = Work::new();
    let library = limited(call.clone())?;
    let (sender, mut receiver) = sync_channel(1);
    let worker = worker()?;
    let job: Job = Box::new(move || drop(sender.send(work(&library))));
    let _ = worker.1.send(job);
    loop {
        match py.detach(|| waited(&mut receiver, TICK)) {
            Ok(made) => {
                WORKER.set(Some(worker));
                return made.map_err(|error| raised(py, &error));
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err("the work panicked"));
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        let points = call.points.load(Ordering::Relaxed);
        let looked = py.check_signals().and_then(|()| {
            let followers = py.import("strew._progress")?;
            followers.getattr("report")?.call1((points, total))
        });
        if let Err(error) = looked {
            call.stop.raise();
            let _ = py.detach(|| waited(&mut receiver, PATIENCE));
            return Err(error);
        }
    }
}

/// The worker of the calling thread, which has none until it is set again.
fn worker() -> PyResult<Worker> {
    let own = WORKER
        .take()
        .filter(|(process, _)| *process == process::id());
    own.map_or_else(
        || {
            let (sender, jobs) = sync_channel::<Job>(1);
            let begun = thread::Builder::new().spawn(|| jobs.into_iter().for_each(|job| job()));
            begun.map_err(|error| PyRuntimeError::new_err(format!("no thread: {error}")))?;
            Ok((process::id(), sender))
        },
        Ok,
    )
}

fn waited<T>(receiver: &mut Receiver<T>, time: Duration) -> Result<T, RecvTimeoutError> {
    receiver.recv_timeout(time)
}
