//! The threads on which work is done, and whose turn it is.
//!
//! All numeric work runs here, never on a thread that serves sockets. It has a lane by its price, and in each
//! lane addresses take turns. Short work takes a few milliseconds at most, so many requests share a thread for
//! each core. Long work (counts of seconds, large bodies, blocks of costly points) has half as many threads of
//! lower priority, so that short work always finds a free one, and gives way to other addresses after a while.
//! Labels and portraits, which are made once for all, have one more. What is not wanted any more is stopped.

#[cfg(feature = "daemon")]
mod clock;
mod lane;
#[cfg(feature = "daemon")]
mod owner;
#[cfg(feature = "daemon")]
mod pulse;
#[cfg(feature = "daemon")]
mod shift;
#[cfg(feature = "daemon")]
mod turns;
#[cfg(feature = "daemon")]
mod workers;

pub use lane::Lane;
#[cfg(feature = "daemon")]
pub use {clock::Clock, owner::Owner, pulse::Pulse, workers::Workers};
