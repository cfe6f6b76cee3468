//! The threads on which work is done, and whose turn it is.
//!
//! All numeric work runs here, never on a thread that serves sockets. Its price decides its lane, and in each lane
//! addresses take turns. Short work takes a few milliseconds at most and has a thread for each core. Long work (counts
//! of seconds, large bodies, blocks of costly points) has half that number, at lower priority, so that short work
//! always finds a free thread, and it lets other addresses have a turn after a while. Labels and portraits, which all
//! clients share, have one more thread. Work stops once no client wants it.

mod clock;
mod owner;
mod pulse;
mod shift;
mod turns;
mod workers;

pub use {clock::Clock, owner::Owner, pulse::Pulse, workers::Workers};
