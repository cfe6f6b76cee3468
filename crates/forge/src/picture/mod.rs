//! Pictures of measured sets, as SVG.
//!
//! `panels` arranges and draws a picture with a plotting library. `overlay` adds what that library
//! would draw one mark at a time: the dots of the points and the cells of the 2-D spectrum.

//!
//! In WebAssembly there are no pictures: the plotting library would bring the interfaces of browsers along.

#[cfg(not(target_arch = "wasm32"))]
mod overlay;
#[cfg(target_arch = "wasm32")]
#[path = "absent.rs"]
mod panels;
#[cfg(not(target_arch = "wasm32"))]
mod panels;

pub use panels::{PictureError, picture};
