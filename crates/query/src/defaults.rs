//! The defaults of queries, and their upper limits.

/// The profile of a query that names none.
pub const DEFAULT_PROFILE: &str = "blue";
/// The α of a query that names none: the one whose pattern's spectrum is the most even.
pub const DEFAULT_ALPHA: &str = "(5-sqrt(3))/2";
/// The most layers of a query.
pub const MOST_LAYERS: usize = 16;
/// The most layers that are alike, as features are: they differ in name, region, amount, seed and field alone, and
/// keep clear of no other.
pub const MOST_FEATURES: usize = 1000;
/// The most regions that lists of regions have in one query.
pub const MOST_REGIONS: usize = 1000;
/// The most names in a list, such as attributes.
pub const MOST_NAMES: usize = 64;
/// The most parts that a query is split into.
pub const MOST_PARTS: u64 = 10_000;

/// The most levels of regions in regions, and of collections in GeoJSON.
pub const MOST_LEVELS: usize = 8;
