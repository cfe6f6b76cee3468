//! The defaults of queries, and their upper limits.

/// The profile of a query that names none.
pub const DEFAULT_PROFILE: &str = "blue";
/// The α of a query that names none: the one whose pattern's spectrum is the most even.
pub const DEFAULT_ALPHA: &str = "(5-sqrt(3))/2";
pub const MOST_LAYERS: usize = 16;
/// The most layers that are alike, as features are: they differ in name, region, amount, seed and field alone, and
/// keep clear of no other.
pub const MOST_FEATURES: usize = 1000;
pub const MOST_REGIONS: usize = 1000;
pub const MOST_NAMES: usize = 64;
pub const MOST_PARTS: u64 = 10_000;

/// The most levels of regions in regions, and of collections in GeoJSON.
pub const MOST_LEVELS: usize = 8;
