//! Rates of points, and the points left of them.

use std::time::Duration;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate {
    /// Points per second, above 0.
    pub points_per_second: f64,
    /// The burst allowed after a pause, at least 1.
    pub burst_points: f64,
}

impl Rate {
    /// The burst of a rate that names none, in seconds.
    const REST: f64 = 10.0;

    /// A rate with its burst, or with that of ten seconds.
    pub fn new(points_per_second: f64, burst_points: Option<f64>) -> Self {
        let burst = burst_points.unwrap_or(points_per_second * Self::REST);
        Self {
            points_per_second,
            burst_points: burst.max(1.0),
        }
    }
}

/// The points left in a bucket, and when it will be full.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    pub rate: Rate,
    /// The points left; 0 while the bucket owes some.
    pub left: u64,
    /// The time until it is full.
    pub full_in: Duration,
}

/// A bucket holds too little.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Short {
    pub level: Level,
    /// The time until the same request is let through, if no other comes first.
    pub wait: Duration,
}
