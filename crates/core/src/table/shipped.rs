//! The tables built into this crate (feature `tables`).

use super::{Shares, Table, TableOf, Vector};
use crate::{error::Error, once::Once};

/// The file of the default table: profile `blue`, α = (5−√3)/2, R = 100.
///
/// ```
/// use strew_core::{PointSet, Table, table::BLUE};
///
/// let table = Table::from_bytes(BLUE)?;
/// assert_eq!(table.map().intervals(), 129);
/// let set = PointSet::blue();
/// assert_eq!((set.table(), table.profile()), (&table, "blue"));
/// // No two points are nearer than this many mean spacings.
/// assert!(set.least_distance() > 0.7);
/// # Ok::<(), strew_core::Error>(())
/// ```
pub const BLUE: &[u8] = include_bytes!("../../tables/blue-5-sqrt3-over-2-m.strew");

/// The default table.
pub(crate) fn blue() -> Table {
    static READ: Once<Table> = Once::new();
    READ.get_or(|| shipped(BLUE))
}

/// A table built into the crate.
pub(crate) fn shipped<V: Vector>(file: &[u8]) -> TableOf<V> {
    // A test reads each.
    TableOf::from_bytes(file)
        .unwrap_or_else(|error| unreachable!("the table built into the crate is valid: {error}"))
}

/// A file from which a table follows, beside the default one.
struct BuiltIn {
    shares: &'static str,
    name: &'static str,
    file: &'static [u8],
}

/// The entry of a file.
#[allow(unused_macros, reason = "each use needs a feature")]
macro_rules! built_in {
    ($shares:literal, $folder:literal, $name:literal) => {
        BuiltIn {
            shares: $shares,
            name: $name,
            file: include_bytes!(concat!("../../tables/", $folder, "/", $name)),
        }
    };
}

/// Labels of the default table, by a feature each.
const EVEN: &[BuiltIn] = &[
    #[cfg(feature = "even-1-1")]
    built_in!("1:1", "even", "blue-5-sqrt3-over-2-m-1-1.labels"),
    #[cfg(feature = "even-1-3")]
    built_in!("1:3", "even", "blue-5-sqrt3-over-2-m-1-3.labels"),
    #[cfg(feature = "even-1-1-2")]
    built_in!("1:1:2", "even", "blue-5-sqrt3-over-2-m-1-1-2.labels"),
    #[cfg(feature = "even-1-3-10")]
    built_in!("1:3:10", "even", "blue-5-sqrt3-over-2-m-1-3-10.labels"),
];

/// Joint tables made of the default one, by a feature each.
const JOINT: &[BuiltIn] = &[
    #[cfg(feature = "joint-1-1")]
    built_in!("1:1", "joint", "blue-5-sqrt3-over-2-m-mix-1-1.strew"),
    #[cfg(feature = "joint-1-3")]
    built_in!("1:3", "joint", "blue-5-sqrt3-over-2-m-mix-1-3.strew"),
    #[cfg(feature = "joint-1-1-2")]
    built_in!("1:1:2", "joint", "blue-5-sqrt3-over-2-m-mix-1-1-2.strew"),
    #[cfg(feature = "joint-1-3-10")]
    built_in!("1:3:10", "joint", "blue-5-sqrt3-over-2-m-mix-1-3-10.strew"),
];

/// A table that was made once.
type Made = Once<Result<Table, Error>>;

/// The most entries of a list.
const MOST: usize = 4;

/// The table of some shares, by the list of files and the tables that were made of them.
fn made(
    list: &[BuiltIn],
    made: &[Made; MOST],
    shares: &Shares,
    make: impl FnOnce(&[u8]) -> Result<Table, Error>,
) -> Option<Table> {
    let is_wanted = |entry: &BuiltIn| entry.shares.parse().as_ref() == Ok(shares);
    let at = list.iter().position(is_wanted)?;
    // A test reads all of them.
    made[at].get_or(|| make(list[at].file)).ok()
}

/// The files of the joint tables built into the crate (features `joint-…`), by their names.
///
/// ```
/// use strew_core::{Table, table::joint_files};
///
/// for (name, file) in joint_files() {
///     let shares = Table::from_bytes(file)?.mix().expect("kinds").shares().to_string();
///     assert!(name.ends_with(&format!("-mix-{}.strew", shares.replace(':', "-"))));
/// }
/// # Ok::<(), strew_core::Error>(())
/// ```
pub fn joint_files() -> impl Iterator<Item = (&'static str, &'static [u8])> {
    JOINT.iter().map(|entry| (entry.name, entry.file))
}

impl Table {
    /// This table with evenly spread kinds, if it is the [default](BLUE) one and labels of these shares are built in
    /// (features `even-…`).
    ///
    /// ```
    /// use strew_core::{PointSet, Table};
    ///
    /// let (blue, shares) = (PointSet::blue().table().clone(), "1:3".parse()?);
    /// if let Some(even) = blue.built_in_even(&shares) {
    ///     assert_eq!(even.displacements(), blue.displacements());
    ///     assert_eq!(even.mix().expect("kinds").shares(), &shares);
    /// }
    /// assert_eq!(blue.built_in_even(&"1:4".parse()?), None);
    /// let other = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
    /// assert_eq!(other.built_in_even(&shares), None);
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    #[must_use]
    pub fn built_in_even(&self, shares: &Shares) -> Option<Self> {
        static READ: [Made; MOST] = [const { Once::new() }; MOST];
        let labels = |file: &[u8]| self.with_labels(file);
        self.is_default()
            .then(|| made(EVEN, &READ, shares, labels))?
    }

    /// The joint table of these shares, if this is the default table and that one is built in.
    pub(crate) fn built_in_joint(&self, shares: &Shares) -> Option<Self> {
        static READ: [Made; MOST] = [const { Once::new() }; MOST];
        self.is_default()
            .then(|| made(JOINT, &READ, shares, Self::from_bytes))?
    }

    /// Whether this is the default table.
    pub(crate) fn is_default(&self) -> bool {
        BLUE.last_chunk() == Some(self.digest().as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_is_built_in_is_read() {
        let table = blue();
        assert!(table.is_default());
        for entry in EVEN {
            let shares = entry.shares.parse().expect("shares");
            let even = table.built_in_even(&shares).expect("valid");
            assert_eq!(even.mix().map(|mix| mix.shares()), Some(&shares));
        }
        for entry in JOINT {
            let shares = entry.shares.parse().expect("shares");
            let joint = table.built_in_joint(&shares).expect("valid");
            assert_eq!(joint.mix().map(|mix| mix.shares()), Some(&shares));
        }
    }
}
