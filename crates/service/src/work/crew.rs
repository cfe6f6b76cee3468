//! The threads that work is done on: one for each piece of work that has a turn, kept for the next one.
//!
//! How many work at once is for [`Turns`](super::turns) to say. Work that waits for another turn keeps its thread, so
//! that whatever it does may wait; the thread of another takes its place.

use std::{
    sync::{
        Arc,
        mpsc::{Sender, channel},
    },
    thread,
};

use parking_lot::Mutex;

use super::shift::{Shift, lower_priority};

#[derive(Clone)]
pub(super) struct Crew(Arc<Threads>);

struct Threads {
    /// Those for short work that wait for more, and those of lower priority.
    idle: [Mutex<Vec<Sender<Task>>>; 2],
    most_idle: usize,
}

struct Task {
    shift: Arc<Shift>,
    job: Box<dyn FnOnce() + Send>,
    thread: Sender<Task>,
    crew: Crew,
}

/// The fewest threads that are kept for further work.
const LEAST_IDLE: usize = 4;

impl Crew {
    /// With this number of threads for short work, which also is about the number of them that is kept.
    pub(super) fn new(threads: usize) -> Self {
        // What cannot be started now is started when it is needed.
        let short = (0..threads).map_while(|_| start(false).ok()).collect();
        Self(Arc::new(Threads {
            idle: [Mutex::new(short), Mutex::default()],
            most_idle: threads.max(LEAST_IDLE),
        }))
    }

    /// Does work that has its turn, on a thread of the shift's priority. If there is no thread, the work is dropped.
    pub(super) fn work(&self, shift: Arc<Shift>, job: Box<dyn FnOnce() + Send>) {
        let is_long = shift.is_long();
        let idle = self.0.idle[usize::from(is_long)].lock().pop();
        let thread = match idle.map_or_else(|| start(is_long), Ok) {
            Ok(thread) => thread,
            Err(error) => {
                tracing::error!(%error, "no thread for work");
                return drop(shift.end());
            }
        };
        let task = Task {
            shift,
            job,
            thread: thread.clone(),
            crew: self.clone(),
        };
        // Idle threads listen.
        let _ = thread.send(task);
    }
}

impl Task {
    fn run(self) {
        let Self {
            shift,
            job,
            thread,
            crew,
        } = self;
        let turn = shift.run(job);
        let mut idle = crew.0.idle[usize::from(shift.is_long())].lock();
        if idle.len() < crew.0.most_idle {
            idle.push(thread);
        }
        drop(idle);
        // The next work of this lane may begin on this thread.
        drop(turn);
    }
}

fn start(is_long: bool) -> std::io::Result<Sender<Task>> {
    let (sender, tasks) = channel::<Task>();
    let name = if is_long {
        "strew-long"
    } else {
        "strew-worker"
    };
    thread::Builder::new().name(name.into()).spawn(move || {
        if is_long {
            lower_priority();
        }
        // Ends once all senders are gone.
        while let Ok(task) = tasks.recv() {
            task.run();
        }
    })?;
    Ok(sender)
}
