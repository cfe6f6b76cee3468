//! The signals that end a command: SIGINT, SIGTERM and SIGHUP. Files that are not complete go first.

use std::{
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, MutexGuard, Once, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
};

/// What a signal finds.
#[derive(Debug, Default)]
struct State {
    /// Files that are not complete.
    incomplete: Vec<PathBuf>,
    /// Raised by the first signal, for work that ends in good order; the second one ends the command.
    stop: Option<Arc<AtomicBool>>,
}

static STATE: Mutex<State> = Mutex::new(State {
    incomplete: vec![],
    stop: None,
});

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The first signal only raises the returned flag.
pub(super) fn stop_flag() -> Arc<AtomicBool> {
    listen();
    let stop = Arc::new(AtomicBool::new(false));
    state().stop = Some(stop.clone());
    stop
}

/// A file that a signal removes.
#[derive(Debug)]
pub(super) struct Incomplete(PathBuf);

impl Incomplete {
    /// Makes the file by `make`; no signal comes between that and its registration.
    pub(super) fn make<T, E>(
        path: &Path,
        make: impl FnOnce(&Path) -> Result<T, E>,
    ) -> Result<(T, Self), E> {
        listen();
        let mut state = state();
        let made = make(path)?;
        state.incomplete.push(path.to_owned());
        Ok((made, Self(path.to_owned())))
    }

    /// Gives the file its name by `rename`; it stays, unless that fails.
    pub(super) fn complete<E>(self, rename: impl FnOnce(&Path) -> Result<(), E>) -> Result<(), E> {
        let mut state = state();
        rename(&self.0)?;
        state.incomplete.retain(|path| *path != self.0);
        Ok(())
    }
}

impl Drop for Incomplete {
    fn drop(&mut self) {
        let mut state = state();
        if let Some(i) = state.incomplete.iter().position(|path| *path == self.0) {
            state.incomplete.swap_remove(i);
            let _ = std::fs::remove_file(&self.0);
        }
    }
}

/// Ends the command, or the work that has a flag for that.
fn end(signal: i32) {
    let state = state();
    let is_first = |stop: &Arc<AtomicBool>| !stop.swap(true, Ordering::Relaxed);
    if state.stop.as_ref().is_some_and(is_first) {
        return;
    }
    for path in &state.incomplete {
        let _ = std::fs::remove_file(path);
    }
    // The state stays locked: no file is made or named any more.
    std::process::exit(128 + signal);
}

/// Starts to listen, once. Without a listener signals end the process as ever.
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

/// Whether the parent has this process ignore a signal, as `nohup` does and shells do for what runs in
/// the background. Where that is unknown, hang-ups are taken for ignored.
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
