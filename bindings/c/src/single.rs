//! Single points: by id, and near a place.

use std::ffi::c_char;

use ::strew_plan::{Found, Library};
use serde_json::json;
use strew_core::PointId;
use strew_error::Error;

use crate::{
    failure::{Code, Failure, guarded},
    handles::{strew_bytes, strew_library},
    memory::{borrowed, place, room, text},
};

/// A point of a set.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct strew_point {
    /// Its stable id, `x:y` in text.
    pub id: [i64; 2],
    /// Its coordinate along x.
    pub x: f64,
    /// Its coordinate along y.
    pub y: f64,
    /// Its distance from the place whose neighbors were searched, else 0.
    pub distance: f64,
}

impl TryFrom<&Found> for strew_point {
    type Error = Error;

    fn try_from(found: &Found) -> Result<Self, Error> {
        let id = found.id.parse::<PointId>();
        let id = id.map_err(|_| Error::Internal("an id that cannot be read"))?;
        Ok(Self {
            id: [id.x, id.y],
            x: found.x,
            y: found.y,
            distance: found.distance.unwrap_or(0.0),
        })
    }
}

/// The point of an id. `set` is the query string of `GET /v1/points/{id}`, such as `spacing=1&seed=7`.
///
/// Returns `STREW_NO_SUCH_POINT` if the set has no point with that id. `attributes`, unless it is null, receives the
/// point with its attributes as JSON.
///
/// # Safety
/// `library` is a library, `set` a text, `found` a place for a point, `attributes` null or a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_point_by_id(
    library: *const strew_library,
    set: *const c_char,
    x: i64,
    y: i64,
    found: *mut strew_point,
    attributes: *mut *mut strew_bytes,
) -> Code {
    let id = PointId { x, y }.to_string();
    let find = |library: &Library, set: &str| library.point(&id, set);
    // SAFETY: as the caller promises.
    guarded(|| unsafe { by_id(library, set, found, attributes, find) })
}

/// The points nearest to a place, nearest first. `query` is the query string of `GET /v1/nearest`, such as
/// `at=5,5&k=3&spacing=1&seed=7`.
///
/// Up to `capacity` points are written, and the number of those found to `count`, unless that is null. `attributes`,
/// unless it is null, receives all points with their attributes as JSON.
///
/// # Safety
/// `library` is a library, `query` a text, `found` has room for `capacity` points, `count` is null or a place for a
/// number, `attributes` null or a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_nearest(
    library: *const strew_library,
    query: *const c_char,
    found: *mut strew_point,
    capacity: usize,
    count: *mut usize,
    attributes: *mut *mut strew_bytes,
) -> Code {
    let find = Library::nearest;
    // SAFETY: as the caller promises.
    guarded(|| unsafe { near(library, query, found, capacity, count, attributes, find) })
}

/// Writes the point that `find` finds in a set, of the plane or in space.
///
/// # Safety
/// As [`strew_point_by_id`].
pub unsafe fn by_id<P>(
    library: *const strew_library,
    set: *const c_char,
    found: *mut P,
    attributes: *mut *mut strew_bytes,
    find: impl FnOnce(&Library, &str) -> Result<Found, Error>,
) -> Result<(), Failure>
where
    P: for<'a> TryFrom<&'a Found, Error = Error>,
{
    // SAFETY: as the caller promises.
    let (library, set, out) = unsafe {
        let library = borrowed(library, "library")?;
        (library, text(set, "set")?, place(found, "found")?)
    };
    let there = find(&library.0, set)?;
    out.put(P::try_from(&there)?);
    // SAFETY: as the caller promises.
    unsafe { documented(&json!(there), attributes) }
}

/// Writes the points that `find` finds near a place, in the plane or in space.
///
/// # Safety
/// As [`strew_nearest`].
pub unsafe fn near<P>(
    library: *const strew_library,
    query: *const c_char,
    found: *mut P,
    capacity: usize,
    count: *mut usize,
    attributes: *mut *mut strew_bytes,
    find: impl FnOnce(&Library, &str) -> Result<Vec<Found>, Error>,
) -> Result<(), Failure>
where
    P: Copy + for<'a> TryFrom<&'a Found, Error = Error>,
{
    // SAFETY: as the caller promises.
    let (library, query) = unsafe { (borrowed(library, "library")?, text(query, "query")?) };
    let there = find(&library.0, query)?;
    let fitting = there.len().min(capacity);
    // SAFETY: as the caller promises.
    let out = unsafe { room(found, fitting, "found")? };
    for (out, there) in out.iter_mut().zip(&there) {
        *out = P::try_from(there)?;
    }
    if !count.is_null() {
        // SAFETY: as the caller promises.
        unsafe { place(count, "count")? }.put(there.len());
    }
    // SAFETY: as the caller promises.
    unsafe { documented(&json!(there), attributes) }
}

/// # Safety
/// `out` is null or a place for a pointer.
unsafe fn documented(value: &serde_json::Value, out: *mut *mut strew_bytes) -> Result<(), Failure> {
    if out.is_null() {
        return Ok(());
    }
    // SAFETY: as the caller promises.
    unsafe { strew_bytes::hand_over(value.to_string().into_bytes(), out) }
}
