//! Fields: shares that vary from place to place.
//!
//! A [`Field`] has a share in [0, 1] at each place of the plane, and [`PointSet::in_field`] has the set whose
//! density follows it. Closures are fields. A [`FieldSpec`] is one that a program can keep, compare and name
//! by a digest: shapes, pixels and noise, and what is joined from them.
//!
//! ```
//! use strew_core::{PointSet, Region, Table, field::{FieldSpec, Marks}};
//!
//! # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
//! let river = Marks::Lines(vec![vec![[0.0, 8.0], [30.0, 21.0], [64.0, 30.0]]]);
//! let reeds = FieldSpec::distance(river, [1.0, 9.0], [1.0, 0.0])?;
//! let set = PointSet::new(table).seed(7).in_field(reeds);
//! let number = set.count(Region::chunk(64.0, [0, 0])?)?;
//! assert!(number > 300 && number < 2000);
//! # Ok::<(), strew_core::Error>(())
//! ```
//!
//! [`PointSet::in_field`]: crate::PointSet::in_field

pub use crate::sample::{Edges, Field, FieldSpec, Filter, Marks, Noise, Pixels, Raster, Terrain};
