//! Fixed-point coordinates: 2⁻²⁰ grid units.

/// Fraction bits of every coordinate: one unit is 2⁻²⁰ grid units, about 3·10⁻⁷ mean spacings.
///
/// Rounding to it adds less than 10⁻¹² to the low-frequency power, and the coordinates of a patch fit
/// 32-bit lanes.
///
/// ```
/// use strew_core::table::{FRACTION_BITS, from_grid_units};
///
/// assert_eq!(from_grid_units(1.0), Some(1 << FRACTION_BITS));
/// ```
pub const FRACTION_BITS: u32 = 20;

/// The bound of a displacement along an axis, in grid units (exclusive). Published tables stay within
/// 13. A vector longer than the map's half-width would leave the surroundings that its block knows.
///
/// ```
/// use strew_core::table::{MAX_DISPLACEMENT, from_grid_units};
///
/// assert_eq!(from_grid_units(MAX_DISPLACEMENT), None);
/// assert!(from_grid_units(MAX_DISPLACEMENT.next_down()).is_some());
/// ```
pub const MAX_DISPLACEMENT: f64 = 127.0;

/// A displacement in units of 2⁻²⁰ grid units.
///
/// ```
/// use strew_core::table::{Displacement, to_grid_units};
///
/// let vector: Displacement = [1 << 20, -1 << 19];
/// assert_eq!(vector.map(to_grid_units), [1.0, -0.5]);
/// ```
pub type Displacement = [i32; 2];

/// A lattice coordinate in fixed point.
pub(crate) const fn fixed(v: i64) -> i128 {
    (v as i128) << FRACTION_BITS
}

/// A fixed-point coordinate in grid units.
///
/// ```
/// assert_eq!(strew_core::table::to_grid_units(-5 << 18), -1.25);
/// ```
#[must_use]
pub fn to_grid_units(fixed: i32) -> f64 {
    f64::from(fixed) / f64::from(1 << FRACTION_BITS)
}

/// The fixed-point coordinate nearest to one in grid units, or `None` at [`MAX_DISPLACEMENT`] and
/// beyond, and for NaN.
///
/// ```
/// use strew_core::table::from_grid_units;
///
/// assert_eq!(from_grid_units(-1.25), Some(-5 << 18));
/// assert_eq!(from_grid_units(127.0), None);
/// ```
#[must_use]
pub fn from_grid_units(value: f64) -> Option<i32> {
    let in_range = value > -MAX_DISPLACEMENT && value < MAX_DISPLACEMENT;
    in_range.then(|| libm::round(value * f64::from(1 << FRACTION_BITS)) as i32)
}
