//! The limits of searches, checked before the work, and the number of points that a search may visit and has visited.

use core::{cell::Cell, f64::consts::PI, ops::ControlFlow};

use crate::{
    error::{Error, ErrorKind, exponential, number, rounded},
    lattice::{LATTICE_LIMIT, Lattice},
    stop::Stop,
    table::fixed,
};

/// The most neighbors that one search for the nearest returns.
pub(crate) const MAX_NEAREST: usize = 10_000;
/// The most points that a search visits: a few hundred milliseconds of work.
pub(crate) const MAX_CANDIDATES: usize = 4_000_000;
/// The most lattice lines that a search visits. Only an α next to 1 or 2 needs more.
const MAX_LINES: f64 = 1e7;
/// Lattice units kept free at the limit: more than the longest displacement and warp.
pub(crate) const BORDER: i64 = 1 << 20;

/// The names of the coordinates of a place.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Refuses a place that is not finite.
pub(crate) fn check_place<const D: usize>(at: [f64; D]) -> Result<(), Error> {
    for (name, value) in AXES.into_iter().zip(at) {
        if !value.is_finite() {
            let value = number(value);
            return Err(Error::new(ErrorKind::Place, name, value, "a finite number"));
        }
    }
    Ok(())
}

/// Refuses a search that leaves the limit of a lattice.
pub(crate) fn check_reach<const D: usize>(
    limit: f64,
    at: [f64; D],
    radius: f64,
) -> Result<(), Error> {
    for (name, value) in AXES.into_iter().zip(at) {
        if value.abs() + radius > limit {
            let allowed = alloc::format!(
                "within ±{}, with the radius searched, where f64 coordinates with this spacing \
                 still keep neighbors apart",
                exponential(limit)
            );
            let error = Error::new(ErrorKind::TooFar, name, number(value), allowed);
            return Err(error.because("too far from the origin").with_limit(limit));
        }
    }
    Ok(())
}

/// Refuses a number of neighbors that one search does not return.
pub(crate) fn check_neighbors(k: usize) -> Result<(), Error> {
    if (1..=MAX_NEAREST).contains(&k) {
        return Ok(());
    }
    let allowed = alloc::format!("an integer from 1 to {MAX_NEAREST}");
    Err(Error::new(ErrorKind::Neighbors, "k", k, allowed))
}

/// The greatest squared distance whose square root is at most a radius, as reported distances are: so a point is found with
/// its own distance as the radius.
pub(crate) fn farthest(radius: f64) -> f64 {
    let mut squared = radius * radius;
    while libm::sqrt(squared) > radius {
        squared = squared.next_down();
    }
    while libm::sqrt(squared.next_up()) <= radius {
        squared = squared.next_up();
    }
    squared
}

/// Refuses a radius that is negative or not finite.
pub(crate) fn check_radius(radius: f64) -> Result<(), Error> {
    if radius.is_finite() && radius >= 0.0 {
        return Ok(());
    }
    let allowed = "a finite number, 0 or greater";
    Err(Error::new(
        ErrorKind::Radius,
        "radius",
        number(radius),
        allowed,
    ))
}

/// How close the points of a lattice are, and how far it reaches.
pub(crate) struct Density<const D: usize> {
    /// The mean spacing of all points.
    pub(crate) spacing: f64,
    /// About the share of these that there are.
    pub(crate) share: f64,
    /// The factor of a search's radius within which points are visited.
    pub(crate) stretch: f64,
    /// The distance of lattice lines.
    pub(crate) line: f64,
    /// The largest absolute coordinate that a search may reach.
    pub(crate) limit: f64,
}

impl<const D: usize> Density<D> {
    /// The area of a disk of radius 1, or the volume of a ball.
    const BALL: f64 = if D == 2 { PI } else { 4.0 / 3.0 * PI };

    /// The radius of a ball that holds `points` points on average.
    pub(super) fn radius_of(&self, points: f64) -> f64 {
        let spacings = points / (Self::BALL * self.share);
        let root = if D == 2 { libm::sqrt } else { libm::cbrt };
        self.spacing * root(spacings)
    }

    /// Refuses a radius for which more than `limit` points must be visited, kept or not, or too many lattice
    /// lines.
    pub(super) fn check_work(&self, radius: f64, limit: usize) -> Result<(), Error> {
        let stretched = radius * self.stretch;
        self.check_number(stretched, 1.0, limit)?;
        let lines = stretched / self.line;
        if lines <= MAX_LINES {
            Ok(())
        } else {
            Err(too_many(radius, lines, limit))
        }
    }

    /// Refuses a radius within which more than `limit` points of a share of all lie on average.
    pub(super) fn check_number(&self, radius: f64, share: f64, limit: usize) -> Result<(), Error> {
        let spacings = [radius / self.spacing; D];
        let about = Self::BALL * spacings.iter().product::<f64>() * share;
        if about <= limit as f64 {
            Ok(())
        } else {
            Err(too_many(radius, about, limit))
        }
    }
}

impl Density<2> {
    /// Of a lattice of the plane.
    pub(crate) fn of(lattice: &Lattice) -> Self {
        Self {
            spacing: lattice.placement.spacing.get(),
            share: lattice.share(),
            stretch: lattice.stretch.factor,
            line: lattice.world(fixed(1)),
            limit: lattice.world(fixed(LATTICE_LIMIT - BORDER)),
        }
    }
}

/// The error of a radius within which about `about` points lie.
pub(crate) fn too_many(radius: f64, about: f64, limit: usize) -> Error {
    let problem = alloc::format!("about {} points lie within", rounded(about, 0));
    let allowed = alloc::format!("a radius with at most {limit} points");
    let error = Error::new(ErrorKind::TooMany, "radius", number(radius), allowed);
    error.because(problem).with_limit(limit as f64)
}

/// The number of points that a search may visit, kept or not, the number that it has visited, and a flag that ends it.
///
/// ```
/// use strew_core::server::{Stop, Visits};
///
/// let visits = Visits::new(1000, Stop::new());
/// assert_eq!(visits.made(), 0);
/// ```
#[derive(Debug)]
pub struct Visits {
    most: usize,
    made: Cell<usize>,
    stop: Stop,
}

/// Visits between two looks at the flag where each takes long.
const OFTEN: usize = 16;

impl Visits {
    /// A limit of `most` points, or of the number that any search may visit if that is smaller, until a flag is raised.
    #[must_use]
    pub fn new(most: usize, stop: Stop) -> Self {
        Self {
            most: most.min(2 * MAX_CANDIDATES),
            made: Cell::new(0),
            stop,
        }
    }

    /// The limit of any search.
    pub(crate) fn any() -> Self {
        Self::new(usize::MAX, Stop::default())
    }

    /// The points that were visited.
    #[must_use]
    pub fn made(&self) -> usize {
        self.made.get()
    }

    /// The flag.
    pub(crate) const fn stop(&self) -> &Stop {
        &self.stop
    }

    pub(crate) const fn most(&self) -> usize {
        self.most
    }

    /// Whether the flag is raised.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stop.is_raised()
    }

    /// Counts the points of a row that are visited together.
    pub(crate) fn row(&self, points: usize) -> ControlFlow<()> {
        self.made.set(self.made.get() + points);
        self.look()
    }

    /// Counts a point whose visit takes long.
    pub(super) fn one(&self) -> ControlFlow<()> {
        let made = self.made.get() + 1;
        self.made.set(made);
        match made % OFTEN {
            0 => self.look(),
            _ => ControlFlow::Continue(()),
        }
    }

    fn look(&self) -> ControlFlow<()> {
        match self.is_stopped() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}
