//! What ends long work: a flag, and a number of points. Methods that take one are named `…_until` and `…_visiting`.
//!
//! ```
//! use strew_core::{Circle, ErrorKind, PointSet, Table, server::Stop};
//!
//! # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
//! let (set, circle) = (PointSet::new(table), Circle::new([0.0, 0.0], 500.0)?);
//! let stop = Stop::new();
//! assert!(set.within_until(circle, stop.clone()).is_ok());
//! // From another thread, while the counting goes on:
//! stop.raise();
//! let stopped = set.within_until(circle, stop).unwrap_err();
//! assert_eq!(stopped.kind(), ErrorKind::Stopped);
//! # Ok::<(), strew_core::Error>(())
//! ```

pub use crate::{near::Visits, stop::Stop};
