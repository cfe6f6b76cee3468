//! Pictures of measured sets, as SVG.
//!
//! `panels` arranges and draws a picture with a plotting library. `overlay` adds what that library
//! would draw one mark at a time: the dots of the points and the cells of the 2-D spectrum.

mod overlay;
mod panels;

pub use panels::{PictureError, picture};
