//! The threads on which work is done, and whose turn it is.
//!
//! All numeric work runs here, never on a thread that serves sockets. Its price decides its lane, and in each lane
//! addresses take turns. Short work takes a few milliseconds at most; as much of it runs at once as there are cores. Half
//! of that number runs of long work (counts of seconds, large bodies, blocks of costly points), at lower priority, so
//! that short work always finds a free core, and it lets other addresses have a turn after a while. The price is not
//! trusted: short work that takes longer goes on as long work (`shift.rs`), and all work is charged for the time that it
//! took. Labels and portraits, which all clients share, run one at a time. Work stops once no client wants it.

mod clock;
mod crew;
mod owner;
mod pulse;
mod shift;
mod turns;
mod workers;

pub use {clock::Clock, owner::Owner, pulse::Pulse, workers::Workers};
