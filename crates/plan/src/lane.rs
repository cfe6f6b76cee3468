//! The lanes of work: short work never waits for long work.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lane {
    /// Work of a few milliseconds.
    Short,
    /// All other work for one request.
    Long,
    /// Labels, portraits and other things that are made once for all requests. Takes seconds.
    Making,
}

impl Lane {
    pub const ALL: [Self; 3] = [Self::Short, Self::Long, Self::Making];
}
