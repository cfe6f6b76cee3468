//! The signals that a daemon handles: those that stop it, of which the first drains and the second
//! ends at once, and SIGHUP, which asks it to read files again.

use std::io;

#[cfg(unix)]
use tokio::signal::unix::{Signal, SignalKind, signal};

/// The exit status of a process that a signal cut short.
const CUT_SHORT: i32 = 1;

/// The signals, listened for from the moment this is made.
pub struct Signals {
    #[cfg(unix)]
    terminate: Signal,
    #[cfg(unix)]
    interrupt: Signal,
}

impl Signals {
    /// Starts to listen for ctrl-C, and for SIGTERM where there is one. Needs a tokio runtime.
    pub fn new() -> io::Result<Self> {
        Ok(Self {
            #[cfg(unix)]
            terminate: signal(SignalKind::terminate())?,
            #[cfg(unix)]
            interrupt: signal(SignalKind::interrupt())?,
        })
    }

    pub async fn next(&mut self) -> &'static str {
        #[cfg(unix)]
        tokio::select! {
            _ = self.terminate.recv() => "SIGTERM",
            _ = self.interrupt.recv() => "SIGINT",
        }
        #[cfg(not(unix))]
        match tokio::signal::ctrl_c().await {
            Ok(()) => "ctrl-C",
            Err(_) => std::future::pending().await,
        }
    }

    /// Waits for the first one. From then on the second ends the process at once.
    pub async fn first_then_exit(mut self) {
        let signal = self.next().await;
        tracing::info!(signal, "draining; once more to stop at once");
        tokio::spawn(async move {
            self.next().await;
            tracing::warn!("stopped before the drain was over");
            std::process::exit(CUT_SHORT);
        });
    }
}

/// SIGHUP, listened for from the moment this is made; it never comes where there is none.
pub struct Hangups {
    #[cfg(unix)]
    signal: Signal,
}

impl Hangups {
    pub fn new() -> io::Result<Self> {
        Ok(Self {
            #[cfg(unix)]
            signal: signal(SignalKind::hangup())?,
        })
    }

    pub async fn next(&mut self) {
        #[cfg(unix)]
        if self.signal.recv().await.is_some() {
            return;
        }
        std::future::pending().await
    }
}
