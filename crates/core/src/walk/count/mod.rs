//! Exact counts without making points: `boxes` counts a box, all or most of it in closed form (`tally`
//! counts its columns and rows by block), `sifted` everything that has a sieve.

mod boxes;
mod sifted;
mod tally;

use core::ops::Range;

use super::scope::Scope;

/// The number of points of a scope with addresses in some columns and rows. Meaningless once the scope's
/// stop flag is raised.
pub(crate) fn count(scope: &Scope, columns: &Range<i64>, rows: &Range<i64>) -> u128 {
    let (lattice, stop) = (&scope.lattice, &scope.stop);
    let (x, y) = (scope.x.within(columns), scope.y.within(rows));
    let sieve = scope.sieve.as_ref();
    let all = if let Some(sieve) = sieve.filter(|sieve| !sieve.is_box) {
        sifted::count(lattice, sieve, [&x, &y], stop)
    } else if x.bounds.is_empty() || y.bounds.is_empty() {
        0
    } else if lattice.shears.is_some() {
        boxes::count_warped(lattice, [&x, &y], stop)
    } else {
        boxes::count(lattice, &x, &y)
    };
    // Counts that were stopped are too low.
    all.saturating_sub(sieve.map_or(0, |sieve| sieve.missing.count(&x.all, &y.all)))
}
