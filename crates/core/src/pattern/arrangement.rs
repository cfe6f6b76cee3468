//! Arrangements: which finite sets of offsets occur in a pattern, where, and how often.
//!
//! An offset o moves the index of every point by the same shift. So p + o is a point for all offsets o iff
//! the index of p lies in a rectangle: the set region less the extent of the shifts. Everything about an
//! arrangement follows from that rectangle, its *margin*. It is a product of intervals like the set region
//! itself, and occurrences are counted and listed the way points are.

use alloc::vec::Vec;
use core::ops::{Range, RangeInclusive};

use super::{Axis, AxisSet, Class, Pattern};
use crate::error::{Error, ErrorKind};

/// A finite set of grid offsets, seen in one pattern. It *occurs* at a point p if p + o is a point for
/// every offset o. The offset (0, 0), p itself, is implied.
///
/// It occurs somewhere iff the image of its offsets in index space fits the set region (Ahmed, Huang,
/// Deussen 2015), and the area of the margin that is left is the density of its occurrences. Both hold
/// exactly for the α of the pattern, as [rounded](crate::Alpha) to a multiple of 2⁻⁶³.
///
/// ```
/// use strew_core::{Pattern, pattern::Arrangement};
///
/// let pattern = Pattern::new("sqrt(3)".parse()?);
/// let three = Arrangement::new(pattern, &[(2, 0), (1, 2)])?;
/// assert!(three.exists());
/// // 13 billion occurrences in a square with a side of a million, counted without listing them.
/// let side = 0..1_000_000;
/// let counted = three.count(side.clone(), side.clone()) as f64;
/// assert!((counted / 1e12 - three.density()).abs() < 1e-7);
/// for (x, y) in three.occurrences(side.clone(), side).take(100) {
///     assert!([(x, y), (x + 2, y), (x + 1, y + 2)].iter().all(|&(x, y)| pattern.contains(x, y)));
/// }
/// // No point has a neighbor beside it.
/// assert!(!Arrangement::new(pattern, &[(1, 0)])?.exists());
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arrangement {
    pattern: Pattern,
    offsets: Vec<(i64, i64)>,
    /// The least and the greatest shift along each axis; they include 0.
    image: [RangeInclusive<i64>; 2],
}

impl Arrangement {
    /// The greatest number of offsets.
    pub const MAX_OFFSETS: usize = 65_536;
    /// The greatest distance of an offset along either axis, in grid units.
    pub const MAX_OFFSET: i64 = 1 << 52;

    /// The arrangement of `offsets`, in grid units, in a pattern. Offsets may repeat.
    ///
    /// # Errors
    /// [`ErrorKind::Arrangement`] for more than [`MAX_OFFSETS`](Self::MAX_OFFSETS) offsets, and for one
    /// beyond ±[`MAX_OFFSET`](Self::MAX_OFFSET), whose position is in the [field](Error::field).
    pub fn new(pattern: Pattern, offsets: &[(i64, i64)]) -> Result<Self, Error> {
        if offsets.len() > Self::MAX_OFFSETS {
            let value = alloc::format!("a list of {}", offsets.len());
            let allowed = alloc::format!("a list of at most {} offsets", Self::MAX_OFFSETS);
            let error = Error::new(ErrorKind::Arrangement, "offsets", value, allowed);
            return Err(error.with_limit(Self::MAX_OFFSETS as f64));
        }
        for (i, &(x, y)) in offsets.iter().enumerate() {
            if x.unsigned_abs().max(y.unsigned_abs()) > Self::MAX_OFFSET as u64 {
                let allowed = alloc::format!("two integers within ±{}", Self::MAX_OFFSET);
                let (field, value) = (alloc::format!("offsets[{i}]"), alloc::format!("[{x}, {y}]"));
                let error = Error::new(ErrorKind::Arrangement, field, value, allowed);
                return Err(error.with_limit(Self::MAX_OFFSET as f64));
            }
        }
        Ok(Self::small(pattern, offsets.to_vec()))
    }

    /// The arrangement of offsets that are known to be within the limits.
    pub(crate) fn small(pattern: Pattern, offsets: Vec<(i64, i64)>) -> Self {
        let mut image = [0..=0, 0..=0];
        for &offset in &offsets {
            for (image, shift) in image.iter_mut().zip(shift(pattern, offset)) {
                *image = shift.min(*image.start())..=shift.max(*image.end());
            }
        }
        Self {
            pattern,
            offsets,
            image,
        }
    }

    /// The pattern in which the arrangement is seen.
    #[must_use]
    pub const fn pattern(&self) -> Pattern {
        self.pattern
    }

    /// The offsets, as they were listed.
    #[must_use]
    pub fn offsets(&self) -> &[(i64, i64)] {
        &self.offsets
    }

    /// The shift of each offset in index space: how far its point lies from p there, in units of 2⁻⁶⁴, from
    /// −½ to ½.
    pub fn shifts(&self) -> impl Iterator<Item = [i64; 2]> {
        self.offsets.iter().map(|&o| shift(self.pattern, o))
    }

    /// The image of the arrangement in index space: the least rectangle around its shifts and 0, as the
    /// ranges of dX and dY, in units of 2⁻⁶⁴.
    #[must_use]
    pub fn image(&self) -> [RangeInclusive<i64>; 2] {
        self.image.clone()
    }

    /// The margin: where the index of a point lies at which the arrangement occurs, as the ranges of dX and
    /// dY, in units of 2⁻⁶⁴. `None` if the image does not fit the set region.
    ///
    /// ```
    /// use strew_core::{Pattern, pattern::Arrangement};
    ///
    /// let pair = Arrangement::new(Pattern::new("1.75".parse()?), &[(2, 0)])?;
    /// // (αx + y)/2 = 1.75, a quarter less than 2.
    /// assert_eq!(pair.image(), [-(1 << 62)..=0, 0..=0]);
    /// // The set region is [0, 3/8)². The shift of dX by −¼ leaves [¼, 3/8).
    /// assert_eq!(pair.margin(), Some([1 << 62..3 << 61, 0..3 << 61]));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn margin(&self) -> Option<[Range<u64>; 2]> {
        let side = self.pattern.alpha().set_side();
        let [x, y] = self.image().map(|image| {
            let (low, high) = (image.start().unsigned_abs(), image.end().unsigned_abs());
            // Shifts reach from −2⁶³ to 2⁶³, and the side is below 2⁶³.
            low..side.saturating_sub(high)
        });
        (!x.is_empty() && !y.is_empty()).then_some([x, y])
    }

    /// Whether the arrangement occurs anywhere, which it does iff its image fits the set region.
    #[must_use]
    pub fn exists(&self) -> bool {
        self.margin().is_some()
    }

    /// The number of occurrences for each grid point of the plane, times 2¹²⁸: the area of the margin,
    /// exactly.
    #[must_use]
    pub fn area(&self) -> u128 {
        self.margin().map_or(0, |[x, y]| {
            u128::from(x.end - x.start) * u128::from(y.end - y.start)
        })
    }

    /// The number of occurrences for each grid point of the plane: [`area`](Self::area) as the nearest `f64`.
    #[must_use]
    pub fn density(&self) -> f64 {
        const UNIT: f64 = 1.0 / 18_446_744_073_709_551_616.0;
        self.area() as f64 * UNIT * UNIT
    }

    /// The share of points at which the arrangement occurs, from 0 to 1.
    #[must_use]
    pub fn frequency(&self) -> f64 {
        let side = self.pattern.alpha().set_side();
        self.area() as f64 / (u128::from(side) * u128::from(side)) as f64
    }

    /// Whether the arrangement occurs at a place of the grid.
    #[must_use]
    pub fn occurs_at(&self, x: i64, y: i64) -> bool {
        let (dx, dy) = self.pattern.index(x, y);
        self.margin()
            .is_some_and(|margin| margin[0].contains(&dx) && margin[1].contains(&dy))
    }

    /// The columns and rows of a class whose products are the occurrences.
    pub(super) fn axis_sets(&self, class: Class) -> [AxisSet; 2] {
        let [x, y] = self.margin().unwrap_or_default();
        [
            self.pattern.axis_subset(Axis::X, class, x),
            self.pattern.axis_subset(Axis::Y, class, y),
        ]
    }

    /// The number of occurrences at the places of a box of the grid, exactly: eight floor sums, whatever the
    /// size of the box. An inverted range is empty.
    #[must_use]
    pub fn count(&self, x: Range<i64>, y: Range<i64>) -> u128 {
        let of_class = |class| {
            let [columns, rows] = self.axis_sets(class);
            u128::from(columns.count(x.clone())) * u128::from(rows.count(y.clone()))
        };
        Class::ALL.into_iter().map(of_class).sum()
    }
}

/// The shift of an offset in index space, in units of 2⁻⁶⁴, taken with a sign: a shift beyond ±t, which is
/// less than ½, never fits.
fn shift(pattern: Pattern, (x, y): (i64, i64)) -> [i64; 2] {
    let (dx, dy) = Pattern::new(pattern.alpha()).index(x, y);
    [dx as i64, dy as i64]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        Alpha,
        pattern::{IndexOrigin, occurrences::BAND},
    };

    const TEXTS: &[&str] = &[
        "(5-sqrt(3))/2",
        "sqrt(3)",
        "(1+sqrt(5))/2",
        "1.3",
        "1.97",
        "5/3",
        "3/2",
    ];

    fn alphas() -> impl Strategy<Value = Alpha> {
        proptest::sample::select(TEXTS).prop_map(|text| text.parse().expect("valid"))
    }

    fn offsets(most: usize) -> impl Strategy<Value = Vec<(i64, i64)>> {
        proptest::collection::vec((-7i64..=7, -7i64..=7), 0..most)
    }

    /// The places of a box at which all offsets are points, in order, from membership alone.
    fn by_search(
        pattern: Pattern,
        offsets: &[(i64, i64)],
        x: Range<i64>,
        y: Range<i64>,
    ) -> Vec<(i64, i64)> {
        let mut found: Vec<_> = y
            .flat_map(|y| x.clone().map(move |x| (x, y)))
            .filter(|&(x, y)| {
                let all = offsets.iter().chain([&(0, 0)]);
                all.copied().all(|(i, j)| pattern.contains(x + i, y + j))
            })
            .collect();
        found.sort_by_key(|&(x, y)| (x.div_euclid(BAND), y, x));
        found
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn occurrences_are_those_of_a_search(
            alpha in alphas(), offsets in offsets(4), ox: u64, oy: u64,
            x0 in -5000i64..5000, y0: i32, w in 0i64..1400, h in 0i64..40,
        ) {
            let pattern = Pattern::with_origin(alpha, IndexOrigin { x: ox, y: oy });
            let arrangement = Arrangement::new(pattern, &offsets).expect("small");
            let (x, y) = (x0..x0 + w, i64::from(y0)..i64::from(y0) + h);
            let expected = by_search(pattern, &offsets, x.clone(), y.clone());
            prop_assert_eq!(arrangement.count(x.clone(), y.clone()), expected.len() as u128);
            prop_assert!(expected.iter().all(|&(x, y)| arrangement.occurs_at(x, y)));
            prop_assert_eq!(arrangement.occurrences(x, y).collect::<Vec<_>>(), expected);
            prop_assert!(!offsets.is_empty() || arrangement.frequency() == 1.0);
        }

        #[test]
        fn it_occurs_somewhere_iff_its_image_fits(alpha in alphas(), offsets in offsets(5), ox: u64, oy: u64) {
            let pattern = Pattern::with_origin(alpha, IndexOrigin { x: ox, y: oy });
            let arrangement = Arrangement::new(pattern, &offsets).expect("small");
            let side = i128::from(alpha.set_side());
            let fits = arrangement
                .image()
                .iter()
                .all(|range| i128::from(*range.end()) - i128::from(*range.start()) < side);
            prop_assert_eq!(arrangement.exists(), fits);
            let everywhere = -i64::MAX / 2..i64::MAX / 2;
            match arrangement.occurrences(0..i64::MAX, everywhere.clone()).next() {
                Some((x, y)) => {
                    prop_assert!(fits);
                    prop_assert!(offsets.iter().all(|(i, j)| pattern.contains(x + i, y + j)));
                }
                // Coordinates of 63 bits cannot visit every place of a torus of 2⁶⁴ units.
                None => {
                    let narrowest = arrangement.margin().map(|margin| margin.map(|r| r.end - r.start));
                    prop_assert!(narrowest.is_none_or(|sides| sides[0].min(sides[1]) < 1 << 24));
                }
            }
        }

        #[test]
        fn the_count_in_a_large_box_is_its_area_times_the_density(alpha in alphas(), offsets in offsets(4)) {
            let arrangement = Arrangement::new(Pattern::new(alpha), &offsets).expect("small");
            let side = 1i64 << 44;
            let counted = arrangement.count(-side..side, -side..side) as f64;
            let density = counted / (2.0 * side as f64).powi(2);
            prop_assert!((density - arrangement.density()).abs() < 1e-12);
        }
    }

    #[test]
    fn arrangements_beyond_the_limits_are_refused() {
        let pattern = Pattern::new("sqrt(3)".parse().expect("valid"));
        let many = vec![(2, 2); Arrangement::MAX_OFFSETS + 1];
        let error = Arrangement::new(pattern, &many).expect_err("too many");
        assert_eq!(error.kind(), ErrorKind::Arrangement);
        assert_eq!(
            error.to_string(),
            "offsets is a list of 65537; it must be a list of at most 65536 offsets"
        );
        assert!(Arrangement::new(pattern, &many[1..]).is_ok());
        let error = Arrangement::new(pattern, &[(0, i64::MIN)]).expect_err("too far");
        assert_eq!(error.field(), "offsets[0]");
    }
}
