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

mod clusters;
mod drawing;
mod letters;
mod paint;
mod panel;
mod pattern;
mod report;

pub use crate::SettingError as FigureError;
pub use clusters::{clusters, found_clusters};
pub(crate) use drawing::png_file;
pub use drawing::{Anchor, Color, Drawing, Pen, Rectangle};
pub use pattern::{arrangement, index, map};
pub use report::{mask_spectrum, report};
