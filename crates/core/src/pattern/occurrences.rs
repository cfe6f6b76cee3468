//! The occurrences of an arrangement in a box of the grid: all of them, those from a place on, and the k-th.
//!
//! The order is that of the sampler, so everything before a place is three boxes, whose counts have closed
//! forms, and a place is found by its number in some hundred counts.

use alloc::vec::Vec;
use core::ops::Range;

use super::{Arrangement, AxisSet, Class};

/// The columns of a band. Occurrences are listed band by band, as the sampler lists points.
pub(super) const BAND: i64 = 1024;

impl Arrangement {
    /// The places of a box of the grid at which the arrangement occurs, in the order in which the sampler
    /// lists points: bands of 1024 columns that begin at multiples of 1024, ascending; in a band, rows; in
    /// a row, columns. Bands without occurrences are skipped.
    pub fn occurrences(
        &self,
        x: Range<i64>,
        y: Range<i64>,
    ) -> impl Iterator<Item = (i64, i64)> + use<> {
        let mut classes: Vec<[AxisSet; 2]> = Class::ALL.map(|class| self.axis_sets(class)).into();
        classes.retain(|[_, rows]| rows.first(y.start).is_some_and(|row| row < y.end));
        let mut next = x.start;
        let bands = core::iter::from_fn(move || {
            let columns = classes
                .iter()
                .filter_map(|[columns, _]| columns.first(next));
            let first = columns.min().filter(|&first| first < x.end)?;
            let end = (first.div_euclid(BAND))
                .saturating_add(1)
                .saturating_mul(BAND)
                .min(x.end);
            let band = next.max(first)..end;
            next = end;
            let mut here = classes.clone();
            here.retain(|[columns, _]| columns.first(band.start).is_some_and(|v| v < band.end));
            Some((here, band))
        });
        bands.flat_map(move |(classes, band)| {
            rows(&classes, y.clone())
                .flat_map(move |(columns, y)| columns.iter(band.clone()).map(move |x| (x, y)))
        })
    }

    /// The [occurrences](Self::occurrences) of a box from a place of the grid on, in the same order. The place
    /// need not be one of them.
    pub fn occurrences_from(
        &self,
        x: Range<i64>,
        y: Range<i64>,
        from: (i64, i64),
    ) -> impl Iterator<Item = (i64, i64)> + use<> {
        let band = band(from.0, &x);
        let row = from.1.clamp(y.start, y.end.max(y.start));
        let is_row = y.contains(&from.1);
        let here = if is_row { row..row + 1 } else { row..row };
        let next = if is_row { row + 1 } else { row };
        let columns = from.0.max(band.start)..band.end;
        let later = band.end..x.end;
        (self.occurrences(columns, here))
            .chain(self.occurrences(band, next..y.end))
            .chain(self.occurrences(later, y))
    }

    /// The number of [occurrences](Self::occurrences) of a box that come before a place of the grid, exactly.
    #[must_use]
    pub fn count_before(&self, x: Range<i64>, y: Range<i64>, place: (i64, i64)) -> u128 {
        let band = band(place.0, &x);
        let row = place.1.clamp(y.start, y.end.max(y.start));
        let in_row = if y.contains(&place.1) {
            self.count(
                band.start..place.0.clamp(band.start, band.end),
                row..row + 1,
            )
        } else {
            0
        };
        self.count(x.start..band.start, y.clone()) + self.count(band, y.start..row) + in_row
    }

    /// The occurrence of a box with a number, from 0, in the order of [`occurrences`](Self::occurrences), or `None`
    /// if the box has no more than that. Takes a few hundred counts, whatever the size of the box.
    ///
    /// ```
    /// use strew_core::{Pattern, pattern::Arrangement};
    ///
    /// let pair = Arrangement::new(Pattern::new("1.75".parse()?), &[(2, 0)])?;
    /// let side = 0..1 << 40;
    /// let place = pair.nth(side.clone(), side.clone(), 10_u128.pow(20)).expect("there are 5.7e22");
    /// assert_eq!(pair.count_before(side.clone(), side, place), 10_u128.pow(20));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn nth(&self, x: Range<i64>, y: Range<i64>, number: u128) -> Option<(i64, i64)> {
        if number >= self.count(x.clone(), y.clone()) {
            return None;
        }
        let start = |band: i64| band.saturating_mul(BAND).max(x.start);
        let bands = x.start.div_euclid(BAND)..=(x.end - 1).div_euclid(BAND);
        let before = |band: i64| self.count(x.start..start(band), y.clone());
        let band_number = last(*bands.start(), *bands.end(), |band| before(band) <= number);
        let band = band(start(band_number), &x);
        let rest = number - before(band_number);
        let below = |row: i64| self.count(band.clone(), y.start..row);
        let row = last(y.start, y.end - 1, |row| below(row) <= rest);
        let rest = usize::try_from(rest - below(row)).ok()?;
        self.occurrences(band, row..row + 1).nth(rest)
    }
}

/// The part of a range of columns in the band of a column.
fn band(column: i64, x: &Range<i64>) -> Range<i64> {
    let end = x.end.max(x.start);
    let start = column.div_euclid(BAND).saturating_mul(BAND);
    start.clamp(x.start, end)..start.saturating_add(BAND).clamp(x.start, end)
}

/// The last integer from `low` to `high` that fits, where all that fit come first and `low` does.
fn last(mut low: i64, mut high: i64, fits: impl Fn(i64) -> bool) -> i64 {
    while low < high {
        let middle = (i128::from(low) + i128::from(high) + 1).div_euclid(2) as i64;
        if fits(middle) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    low
}

/// The rows of some classes in a range, ascending, each with the columns of its class.
fn rows(
    classes: &[[AxisSet; 2]],
    range: Range<i64>,
) -> impl Iterator<Item = (AxisSet, i64)> + use<> {
    let mut classes: Vec<_> = classes
        .iter()
        .map(|&[columns, rows]| (columns, rows.iter(range.clone()).peekable()))
        .collect();
    core::iter::from_fn(move || {
        // A row has points of one class only.
        let next = |rows: &mut core::iter::Peekable<_>| rows.peek().copied();
        let (columns, rows) = classes
            .iter_mut()
            .filter_map(|(columns, rows)| next(rows).map(|row| (row, columns, rows)))
            .min_by_key(|&(row, ..)| row)
            .map(|(_, columns, rows)| (*columns, rows))?;
        Some((columns, rows.next()?))
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::pattern::Pattern;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn places_and_their_numbers_belong_together(
            alpha in proptest::sample::select(&["(5-sqrt(3))/2", "sqrt(3)", "1.3", "5/3"][..]),
            i in -7i64..=7, j in -7i64..=7, x0 in -3000i64..3000, y0: i16, w in 0i64..2500, h in 0i64..12,
            from in (-4000i64..7000, -20i64..40),
        ) {
            let pattern = Pattern::new(alpha.parse().expect("valid"));
            let found = Arrangement::new(pattern, &[(i, j)]).expect("small");
            let (x, y) = (x0..x0 + w, i64::from(y0)..i64::from(y0) + h);
            let all: Vec<_> = found.occurrences(x.clone(), y.clone()).collect();
            for number in [0, 1, all.len() / 2, all.len().saturating_sub(1), all.len()] {
                let place = found.nth(x.clone(), y.clone(), number as u128);
                prop_assert_eq!(place, all.get(number).copied());
            }
            // Also from places that are none, within and outside of the box.
            let from = (from.0, y.start + from.1 - 10);
            let order = |&(x, y): &(i64, i64)| (x.div_euclid(BAND), y, x);
            let first = all.iter().position(|place| order(place) >= order(&from)).unwrap_or(all.len());
            let rest: Vec<_> = found.occurrences_from(x.clone(), y.clone(), from).collect();
            prop_assert_eq!(&rest, &all[first..]);
            prop_assert_eq!(found.count_before(x, y, from), first as u128);
        }
    }
}
