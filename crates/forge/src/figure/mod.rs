//! Figures, as SVG or PNG: of AA patterns, how points, index space and maps belong together; of measured sets, their
//! [`report`].
//!
//! They draw the facts of [`strew_core::pattern`] and [`strew_core::map`] for any α, in the manner of the
//! figures of the paper: [`index`] the index torus and the set region, [`arrangement`] an arrangement with its
//! image and margin, [`clusters`] the shapes of clusters, [`map`] blocks and their refinement. Equal
//! calls draw the same text.
//!
//! `drawing` is a list of marks that becomes SVG, or that `paint` makes a picture of, with the `letters` of a line
//! font; `panel` a square plot with its own coordinates.

mod arrangement;
mod clusters;
mod drawing;
mod index;
mod letters;
mod map;
mod mask;
mod paint;
mod panel;
mod report;

pub use crate::SettingError as FigureError;
pub use arrangement::arrangement;
pub use clusters::{clusters, found_clusters};
pub use drawing::{Anchor, Color, Drawing, Pen, Rectangle};
pub use index::index;
pub use map::map;
pub use mask::mask_spectrum;
pub use report::report;
