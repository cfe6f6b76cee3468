//! The price of making a point.

use strew_core::Region;
use strew_query::Set;

use super::layers::look;

/// The nanoseconds to copy and write a point.
pub(super) const POINT: f64 = 50.0;
/// Those to hash and write the value of an attribute.
const VALUE: f64 = 20.0;
/// Those of a point that is thinned out by its rank, and of one that is compared with a field.
const PASSED: f64 = 0.15;
pub(super) const LOOKED_AT: f64 = 30.0;
/// The most tests against other layers for each point that remains: points that are too near are tested as well.
const TESTED: f64 = 4.0;
/// The heights that a normal needs, on four sides.
const SLOPE: f64 = 4.0;

/// About how often an area is counted to find the spacing of a count; in a field less often.
const COUNTS: f64 = 32.0;
const COUNTS_IN_FIELD: f64 = 12.0;

/// About how often an area is counted to find the spacing of a count of a set.
pub const fn counts(set: &Set) -> f64 {
    match set.field {
        Some(_) => COUNTS_IN_FIELD,
        None => COUNTS,
    }
}

/// The time to make a point of a set, in nanoseconds, where testing a place against other layers takes `test` and
/// making one point looks at `looks` points.
pub fn point(set: &Set, looks: f64, test: f64, within: Region) -> f64 {
    let field = set.field.as_ref().map(|field| &field.spec);
    let passed = match field {
        Some(_) => {
            let look = look(field, within);
            looks * (LOOKED_AT + look)
        }
        None => looks * PASSED,
    };
    let varied = set.kinds.iter().flat_map(|kinds| &kinds.fields);
    let varied = look(varied.map(|(_, field)| &field.spec), within);
    let ground = set.terrain.as_ref().map_or(0.0, |terrain| {
        let is_sloped = terrain.has_normals || terrain.align.is_some();
        let looks = if is_sloped { 1.0 + SLOPE } else { 1.0 };
        looks * look([&terrain.field.spec], within)
    });
    let values = set.attributes.as_slice().len() as f64;
    POINT + VALUE * values + passed + varied + ground + test * looks.min(TESTED)
}

/// The nanoseconds to find what is left out of a box by its id, where a lattice unit is `unit` world units.
pub fn lacking<const D: usize>(set: &Set, unit: f64, within: &Region<D>) -> f64 {
    /// Those of looking whether one lies inside.
    const LACKED: f64 = 200.0;
    /// The lattice units that points are moved, at most.
    const MOVED: f64 = 64.0;
    let Some(except) = &set.except else {
        return 0.0;
    };
    let [start, end] = [
        within.min()[0] / unit - MOVED,
        within.max()[0] / unit + MOVED,
    ];
    except.within(&(start as i64..end as i64)) as f64 * LACKED
}
