//! The plane or space, by the number of axes that callers name.

use ::strew_plan::{Found, Library};
use strew_error::Error;
use strew_query::Draft;

use crate::failure::Failure;

#[derive(Clone, Copy)]
pub enum Dimension {
    Plane = 2,
    Space = 3,
}

impl Dimension {
    pub fn of(axes: u32) -> Result<Self, Failure> {
        match axes {
            2 => Ok(Self::Plane),
            3 => Ok(Self::Space),
            _ => Err(Failure::argument(
                "axes",
                "not a number of axes",
                "2 for the plane, 3 for space",
            )),
        }
    }

    pub const fn axes(self) -> usize {
        self as usize
    }

    pub fn query(self, text: &str) -> Result<Draft, Error> {
        match self {
            Self::Plane => Library::read(text),
            Self::Space => Library::read_in_space(text),
        }
    }

    pub fn point(self, library: &Library, id: &[i64], set: &str) -> Result<Found, Error> {
        let parts: Vec<String> = id.iter().map(i64::to_string).collect();
        match self {
            Self::Plane => library.point(&parts.join(":"), set),
            Self::Space => library.point_in_space(&parts.join(":"), set),
        }
    }

    pub fn nearest(self, library: &Library, query: &str) -> Result<Vec<Found>, Error> {
        match self {
            Self::Plane => library.nearest(query),
            Self::Space => library.nearest_in_space(query),
        }
    }
}
