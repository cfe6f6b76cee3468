//! The methods that types of the plane and of space have alike, each written once.

mod placing;
mod planned;
mod requested;

pub(crate) use placing::placing;
pub(crate) use planned::{planned, windows};
pub(crate) use requested::requested;
