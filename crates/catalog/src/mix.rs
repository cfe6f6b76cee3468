//! Making a mix: a table whose variants are evenly spread.

use std::fmt;

use strew_core::{Table, server::Stop, table::Shares};
use strew_error::{Error, Fault};
use strew_forge::{Progress, Watch};

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Made {
    /// Labels of its blocks, for kinds in these shares.
    Labels(Shares),
    /// A second order of its blocks, for kinds whose shares vary.
    SecondOrder,
}

impl fmt::Display for Made {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Labels(shares) => shares.fmt(f),
            Self::SecondOrder => f.write_str("second order"),
        }
    }
}

impl Made {
    /// A table with this, if that is built in.
    pub fn built_in(&self, of: &Table) -> Option<Table> {
        match self {
            Self::Labels(shares) => of.built_in_even(shares),
            Self::SecondOrder => None,
        }
    }

    /// Whether a table has this, and equals the other one in everything else.
    pub fn is(&self, made: &Table, of: &Table) -> bool {
        let is_of = made.displacements() == of.displacements() && made.map() == of.map();
        is_of
            && match (self, made.mix()) {
                (Self::Labels(shares), Some(mix)) => mix.shares() == shares,
                (Self::SecondOrder, None) => made.ranks().is_some() && made.ranks() != of.ranks(),
                _ => false,
            }
    }
}

/// Ends the work of the forge once a flag is raised.
struct Until<'a>(&'a Stop);

impl Watch for Until<'_> {
    fn progress(&self, _: &Progress) {}

    fn stop(&self) -> bool {
        self.0.is_raised()
    }
}

/// Makes labels or a second order of a table, unless they are built in. Takes seconds.
pub fn make(table: &Table, what: &Made, stop: &Stop) -> Result<Table, Error> {
    if let Some(built_in) = what.built_in(table) {
        return Ok(built_in);
    }
    let watch = Until(stop);
    let made = match what {
        Made::Labels(shares) => strew_forge::labels(table, shares, &watch),
        Made::SecondOrder => strew_forge::second_order(table, &watch)
            .and_then(|order| Ok(order.map(|order| table.with_ranks(order)).transpose()?)),
    };
    let made = made.map_err(|error| {
        let allowed =
            "weights nearer to each other, fewer variants, a larger map, or spread chance";
        Fault::new("variants", what, error.to_string(), allowed)
    })?;
    tracing::info!(%what, "made a mix");
    made.ok_or(Error::Internal(
        "a mix was stopped before its request ended",
    ))
}

#[cfg(all(test, feature = "even"))]
mod tests {
    use strew_core::PointSet;

    use super::*;

    #[test]
    fn labels_that_are_built_in_are_not_made() {
        let blue = PointSet::blue().table().clone();
        let stop = Stop::new();
        stop.raise();
        for shares in ["1:1", "1:3", "1:1:2", "1:3:10"] {
            let what = Made::Labels(shares.parse().expect("shares"));
            let made = make(&blue, &what, &stop).expect("built in");
            assert!(what.is(&made, &blue), "{shares}");
        }
        let what = Made::Labels("1:5".parse().expect("shares"));
        assert!(make(&blue, &what, &stop).is_err(), "stopped");
    }
}
