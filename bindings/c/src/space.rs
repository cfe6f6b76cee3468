//! Points in space: planned, written into buffers as triples, and single ones.
//!
//! Counts, columns, documents and parts are those of `plan`, which takes plans of both kinds.

use std::ffi::c_char;

use ::strew_plan::{Found, Library};
use strew_core::space::PointId;
use strew_error::Error;
use strew_query::{RegionDraft, ShapeDraft};

use crate::{
    coordinates::{fill, fill_f32, fill_ids, origin_of},
    failure::{Code, guarded},
    handles::{strew_bytes, strew_library, strew_plan},
    plan::planned,
    single::{by_id, near},
};

/// The number of coordinates in space.
const AXES: usize = 3;

/// Plans a query in space and counts its points. Free the plan with `strew_plan_free`.
///
/// `query` is the JSON body of `POST /v1/space/points`, or the query string of `GET /v1/space/points`:
/// `ball=5,5,5,3&spacing=1&seed=7`.
///
/// Calls that begin with `strew_space_` write its coordinates, its ids and its origin. Counts, columns, documents and
/// parts come from the calls that plans of the plane have.
///
/// # Safety
/// `library` is a library, `query` a text, `plan` a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_space_plan_query(
    library: *const strew_library,
    query: *const c_char,
    plan: *mut *mut strew_plan,
) -> Code {
    // SAFETY: as the caller promises.
    guarded(|| unsafe { planned(library, query, plan, Library::read_in_space) })
}

/// Plans the points of a chunk of space, the cube of the world grid with this size and this place along x, y and z.
/// Coordinates are relative to its corner (`strew_space_origin`). Neighbors share no point and lose none.
///
/// `query` is as in `strew_space_plan_query`, without a region: one text serves all chunks.
///
/// # Safety
/// As `strew_space_plan_query`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_space_plan_chunk(
    library: *const strew_library,
    query: *const c_char,
    size: f64,
    x: i64,
    y: i64,
    z: i64,
    plan: *mut *mut strew_plan,
) -> Code {
    let read = |text: &str| {
        Ok(Library::read_in_space(text)?.within(Ok(RegionDraft {
            path: "chunk".into(),
            shape: ShapeDraft::Cube(size, [x, y, z]),
        })))
    };
    // SAFETY: as the caller promises.
    guarded(|| unsafe { planned(library, query, plan, read) })
}

/// The place that the `f64` coordinates are relative to: the corner of a chunk, else the origin of the world.
///
/// Returns `STREW_INVALID_ARGUMENT` for a plan of the plane, as all calls for space do.
///
/// # Safety
/// `plan` is a plan, `origin` has room for three numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_space_origin(plan: *const strew_plan, origin: *mut f64) -> Code {
    // SAFETY: as the caller promises.
    guarded(|| unsafe { origin_of::<AXES>(plan, origin) })
}

/// Writes the coordinates: x, y and z by turns, for each point, in the fixed order of the query.
///
/// `capacity` is the number of points that `xyz` has room for; `STREW_BUFFER_TOO_SMALL` if it is too little. No
/// other memory is needed. Large answers are made on all cores.
///
/// # Safety
/// `plan` is a plan, `xyz` has room for 3 * `capacity` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_space_fill_xyz(
    plan: *const strew_plan,
    xyz: *mut f64,
    capacity: usize,
) -> Code {
    // SAFETY: as the caller promises.
    guarded(|| unsafe { fill::<AXES>(plan, xyz, capacity, "xyz") })
}

/// Writes the coordinates as `f32`, relative to the lower corner of the region, which is written to `origin` unless
/// that is null.
///
/// # Safety
/// `plan` is a plan, `xyz` has room for 3 * `capacity` numbers, `origin` is null or has room for three.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_space_fill_xyz_f32(
    plan: *const strew_plan,
    xyz: *mut f32,
    capacity: usize,
    origin: *mut f64,
) -> Code {
    // SAFETY: as the caller promises.
    guarded(|| unsafe { fill_f32::<AXES>(plan, xyz, capacity, origin, "xyz") })
}

/// Writes the stable ids: three integers for each point, which are `x:y:z` in text.
///
/// The first call that needs ids or a column makes all of them; they stay in memory until the plan is freed.
///
/// # Safety
/// `plan` is a plan, `ids` has room for 3 * `capacity` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_space_fill_ids(
    plan: *const strew_plan,
    ids: *mut i64,
    capacity: usize,
) -> Code {
    // SAFETY: as the caller promises.
    guarded(|| unsafe { fill_ids::<AXES>(plan, ids, capacity) })
}

/// A point in space.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct strew_space_point {
    /// Its stable id, `x:y:z` in text.
    pub id: [i64; 3],
    /// Its coordinate along x.
    pub x: f64,
    /// Its coordinate along y.
    pub y: f64,
    /// Its coordinate along z.
    pub z: f64,
    /// Its distance from the place whose neighbors were searched, else 0.
    pub distance: f64,
}

impl TryFrom<&Found> for strew_space_point {
    type Error = Error;

    fn try_from(found: &Found) -> Result<Self, Error> {
        let id = found.id.parse::<PointId>();
        let id = id.map_err(|_| Error::Internal("an id that cannot be read"))?;
        Ok(Self {
            id: [id.x, id.y, id.z],
            x: found.x,
            y: found.y,
            z: found.z.unwrap_or(0.0),
            distance: found.distance.unwrap_or(0.0),
        })
    }
}

/// The point in space of an id. `set` is the query string of `GET /v1/space/points/{id}`, such as
/// `spacing=1&seed=7`.
///
/// Returns `STREW_NO_SUCH_POINT` if the set has no point with that id. `attributes`, unless it is null, receives the
/// point with its attributes as JSON.
///
/// # Safety
/// `library` is a library, `set` a text, `found` a place for a point, `attributes` null or a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_space_point_by_id(
    library: *const strew_library,
    set: *const c_char,
    x: i64,
    y: i64,
    z: i64,
    found: *mut strew_space_point,
    attributes: *mut *mut strew_bytes,
) -> Code {
    let id = PointId { x, y, z }.to_string();
    let find = |library: &Library, set: &str| library.point_in_space(&id, set);
    // SAFETY: as the caller promises.
    guarded(|| unsafe { by_id(library, set, found, attributes, find) })
}

/// The points in space nearest to a place, nearest first. `query` is the query string of `GET /v1/space/nearest`,
/// such as `at=5,5,5&k=3&spacing=1&seed=7`.
///
/// Up to `capacity` points are written, and the number of those found to `count`, unless that is null. `attributes`,
/// unless it is null, receives all points with their attributes as JSON.
///
/// # Safety
/// `library` is a library, `query` a text, `found` has room for `capacity` points, `count` is null or a place for a
/// number, `attributes` null or a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_space_nearest(
    library: *const strew_library,
    query: *const c_char,
    found: *mut strew_space_point,
    capacity: usize,
    count: *mut usize,
    attributes: *mut *mut strew_bytes,
) -> Code {
    let find = Library::nearest_in_space;
    // SAFETY: as the caller promises.
    guarded(|| unsafe { near(library, query, found, capacity, count, attributes, find) })
}
