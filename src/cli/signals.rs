//! The signals that end a command: SIGINT, SIGTERM and SIGHUP. Incomplete files are removed first.

use std::{
    path::{Path, PathBuf},
    sync::{
        Arc, Once,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
};

use parking_lot::Mutex;

#[derive(Debug, Default)]
struct State {
    incomplete: Vec<PathBuf>,
    /// Set by the first signal, for work that stops in good order. The second signal ends the command.
    stop: Option<Arc<AtomicBool>>,
}

static STATE: Mutex<State> = Mutex::new(State {
    incomplete: vec![],
    stop: None,
});

/// Returns a flag that the first signal sets, instead of ending the command.
pub(super) fn stop_flag() -> Arc<AtomicBool> {
    // Before signals are heard: one that came in between would end the command without a word.
    let stop = Arc::new(AtomicBool::new(false));
    STATE.lock().stop = Some(stop.clone());
    listen();
    stop
}

/// A file that a signal removes.
pub(super) struct Incomplete(PathBuf);

impl Incomplete {
    /// Makes the file by `make`; no signal comes between that and its registration.
    pub(super) fn make<T, E>(
        path: &Path,
        make: impl FnOnce(&Path) -> Result<T, E>,
    ) -> Result<(T, Self), E> {
        listen();
        let mut state = STATE.lock();
        let made = make(path)?;
        state.incomplete.push(path.to_owned());
        Ok((made, Self(path.to_owned())))
    }

    /// Renames the file by `rename` and keeps it, unless that fails.
    pub(super) fn complete<E>(self, rename: impl FnOnce(&Path) -> Result<(), E>) -> Result<(), E> {
        let mut state = STATE.lock();
        rename(&self.0)?;
        state.incomplete.retain(|path| *path != self.0);
        Ok(())
    }
}

impl Drop for Incomplete {
    fn drop(&mut self) {
        let mut state = STATE.lock();
        if let Some(i) = state.incomplete.iter().position(|path| *path == self.0) {
            state.incomplete.swap_remove(i);
            let _ = std::fs::remove_file(&self.0);
        }
    }
}

/// Ends the command; the first signal only sets the flag, if there is one.
fn end(signal: i32) {
    let state = STATE.lock();
    let is_first = |stop: &Arc<AtomicBool>| !stop.swap(true, Ordering::Relaxed);
    if state.stop.as_ref().is_some_and(is_first) {
        return;
    }
    for path in &state.incomplete {
        let _ = std::fs::remove_file(path);
    }
    // The state stays locked, so no file is made or renamed any more.
    std::process::exit(128 + signal);
}

/// Starts the listener, once. Without it signals end the process as usual.
fn listen() {
    static LISTENING: Once = Once::new();
    LISTENING.call_once(|| {
        let (ready, is_ready) = mpsc::channel::<()>();
        let thread = std::thread::Builder::new().name("signals".into());
        let listener = thread.spawn(move || {
            let runtime = tokio::runtime::Builder::new_current_thread();
            if let Ok(runtime) = { runtime }.enable_all().build() {
                runtime.block_on(hear(ready));
            }
        });
        if listener.is_ok() {
            // Also ends when the listener gave up.
            let _ = is_ready.recv();
        }
    });
}

#[cfg(unix)]
async fn hear(ready: mpsc::Sender<()>) {
    use tokio::signal::unix::{SignalKind, signal};
    let heard = [
        SignalKind::interrupt(),
        SignalKind::terminate(),
        SignalKind::hangup(),
    ];
    for kind in heard {
        if is_ignored(kind.as_raw_value()) {
            continue;
        }
        if let Ok(mut signals) = signal(kind) {
            tokio::spawn(async move {
                while signals.recv().await.is_some() {
                    end(kind.as_raw_value());
                }
            });
        }
    }
    drop(ready);
    std::future::pending::<()>().await;
}

/// Whether the parent made this process ignore a signal, as `nohup` does, and shells for background jobs.
/// Where that is unknown, hang-ups count as ignored.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    match mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()) {
        Some(mask) => mask >> (signal - 1) & 1 == 1,
        None => signal == tokio::signal::unix::SignalKind::hangup().as_raw_value(),
    }
}

#[cfg(not(unix))]
async fn hear(ready: mpsc::Sender<()>) {
    const INTERRUPT: i32 = 2;
    drop(ready);
    while tokio::signal::ctrl_c().await.is_ok() {
        end(INTERRUPT);
    }
}
