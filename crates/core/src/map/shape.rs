//! The shape of a cluster: its points, and how often it occurs.

use alloc::vec::Vec;

use crate::pattern::{Alpha, Arrangement, Pattern};

/// A shape of clusters, up to translation.
///
/// ```
/// use strew_core::map::Clusters;
///
/// let clusters = Clusters::new("(5-sqrt(3))/2".parse()?, 2.3, 16)?;
/// for shape in clusters.shapes() {
///     // The first point in the order of rows, then columns, is the origin.
///     assert_eq!(shape.points()[0], (0, 0));
///     assert!(shape.density() > 0.0);
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shape {
    pub(super) points: Vec<(i64, i64)>,
    pub(super) area: u128,
    pub(super) class: usize,
    pub(super) alpha: Alpha,
}

impl Shape {
    /// A shape to be filled in.
    pub(super) const fn none(alpha: Alpha) -> Self {
        Self {
            points: Vec::new(),
            area: 0,
            class: 0,
            alpha,
        }
    }

    /// The points of a cluster, row by row, from its first.
    #[must_use]
    pub fn points(&self) -> &[(i64, i64)] {
        &self.points
    }

    /// The number of the shape's class under the eight symmetries of the square, from 0.
    #[must_use]
    pub const fn class(&self) -> usize {
        self.class
    }

    /// The number of clusters of this shape for each grid point of the plane, times 2¹²⁸: the area of
    /// index space that holds their first points, exactly.
    #[must_use]
    pub const fn area(&self) -> u128 {
        self.area
    }

    /// The number of clusters of this shape for each grid point of the plane.
    #[must_use]
    pub fn density(&self) -> f64 {
        const UNIT: f64 = 1.0 / 18_446_744_073_709_551_616.0;
        self.area as f64 * UNIT * UNIT
    }

    /// The share of the pattern's points that belong to clusters of this shape, from 0 to 1.
    #[must_use]
    pub fn share_of_points(&self) -> f64 {
        let side = u128::from(self.alpha.set_side());
        self.area as f64 * self.points.len() as f64 / (side * side) as f64
    }

    /// The arrangement of the points, with the first as its origin. It also occurs within larger clusters.
    #[must_use]
    pub fn arrangement(&self) -> Arrangement {
        Arrangement::small(Pattern::new(self.alpha), self.points[1..].to_vec())
    }
}

/// Points in the order of rows, moved so that the first is the origin.
pub(super) fn from_first(mut points: Vec<(i64, i64)>) -> Vec<(i64, i64)> {
    points.sort_unstable_by_key(|&(x, y)| (y, x));
    let (x0, y0) = points[0];
    for (x, y) in &mut points {
        (*x, *y) = (*x - x0, *y - y0);
    }
    points
}

/// The least of a shape's eight images under the symmetries of the square.
pub(super) fn upright(points: &[(i64, i64)]) -> Option<Vec<(i64, i64)>> {
    let turned = |bits: u8| {
        let turn = |&(x, y): &(i64, i64)| {
            let (x, y) = if bits & 4 == 0 { (x, y) } else { (y, x) };
            let signed = |v: i64, bit: u8| if bits & bit == 0 { v } else { -v };
            (signed(x, 1), signed(y, 2))
        };
        from_first(points.iter().map(turn).collect())
    };
    (0..8).map(turned).min()
}
