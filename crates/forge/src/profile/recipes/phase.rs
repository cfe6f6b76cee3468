//! The phases of an optimization.

use crate::optimize::{Descent, Objective};

/// A descent with one objective.
pub(crate) struct Phase {
    pub(crate) objective: Box<dyn Objective>,
    pub(crate) descent: Descent,
}
