//! How variants are spread over the points.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// Evenly, each of them and all together; points do not move.
    Even,
    /// More evenly still, on a table whose points were moved for these shares.
    Joint,
}

/// The default spread: each point draws its variant independently.
pub(crate) const CHANCE: &str = "chance";

impl Spread {
    pub const NAMES: &'static [&'static str] = &[CHANCE, Self::Even.name(), Self::Joint.name()];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Even => "even",
            Self::Joint => "joint",
        }
    }
}
