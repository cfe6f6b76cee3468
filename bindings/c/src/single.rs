//! Single points: by id, and near a place.

use std::ffi::c_char;

use ::strew_plan::Found;
use serde_json::json;
use strew_error::Error;

use crate::{
    dimension::Dimension,
    failure::{Code, Failure, guarded},
    handles::{strew_bytes, strew_library},
    memory::{borrowed, listed, place, room, text},
};

/// A point of a set.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct strew_point {
    /// Its stable id, `x:y` in text, in space `x:y:z`. The third integer is 0 in the plane.
    pub id: [i64; 3],
    /// Its coordinate along x.
    pub x: f64,
    /// Its coordinate along y.
    pub y: f64,
    /// Its coordinate along z; 0 in the plane.
    pub z: f64,
    /// Its distance from the place whose neighbors were searched, else 0.
    pub distance: f64,
}

impl TryFrom<&Found> for strew_point {
    type Error = Error;

    fn try_from(found: &Found) -> Result<Self, Error> {
        let mut id = [0; 3];
        for (place, part) in id.iter_mut().zip(found.id.split(':')) {
            let part = part.parse();
            *place = part.map_err(|_| Error::Internal("an id that cannot be read"))?;
        }
        Ok(Self {
            id,
            x: found.x,
            y: found.y,
            z: found.z.unwrap_or(0.0),
            distance: found.distance.unwrap_or(0.0),
        })
    }
}

/// The point of an id, an integer of each axis. `axes` is 2 for the plane and 3 for space; `set` is the query string of
/// `GET /v1/points/{id}`, in space of `GET /v1/space/points/{id}`, such as `spacing=1&seed=7`.
///
/// Returns `STREW_NO_SUCH_POINT` if the set has no point with that id. `attributes`, unless it is null, receives the
/// point with its attributes as JSON.
///
/// # Safety
/// `library` is a library, `set` a text, `id` has `axes` integers, `found` is a place for a point, `attributes` null or a
/// place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_point_by_id(
    library: *const strew_library,
    axes: u32,
    set: *const c_char,
    id: *const i64,
    found: *mut strew_point,
    attributes: *mut *mut strew_bytes,
) -> Code {
    guarded(|| {
        let dimension = Dimension::of(axes)?;
        // SAFETY: as the caller promises.
        let (library, set, id, out) = unsafe {
            let library = borrowed(library, "library")?;
            let id = listed(id, dimension.axes(), "id")?;
            (library, text(set, "set")?, id, place(found, "found")?)
        };
        let there = dimension.point(&library.0, id, set)?;
        out.put(strew_point::try_from(&there)?);
        // SAFETY: as the caller promises.
        unsafe { documented(&json!(there), attributes) }
    })
}

/// The points nearest to a place, nearest first. `axes` is 2 for the plane and 3 for space; `query` is the query string of
/// `GET /v1/nearest`, such as `at=5,5&k=3&spacing=1&seed=7`, in space of `GET /v1/space/nearest`.
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
    axes: u32,
    query: *const c_char,
    found: *mut strew_point,
    capacity: usize,
    count: *mut usize,
    attributes: *mut *mut strew_bytes,
) -> Code {
    guarded(|| {
        let dimension = Dimension::of(axes)?;
        // SAFETY: as the caller promises.
        let (library, query) = unsafe { (borrowed(library, "library")?, text(query, "query")?) };
        let there = dimension.nearest(&library.0, query)?;
        // SAFETY: as the caller promises.
        let out = unsafe { room(found, there.len().min(capacity), "found")? };
        for (out, there) in out.iter_mut().zip(&there) {
            *out = strew_point::try_from(there)?;
        }
        if !count.is_null() {
            // SAFETY: as the caller promises.
            unsafe { place(count, "count")? }.put(there.len());
        }
        // SAFETY: as the caller promises.
        unsafe { documented(&json!(there), attributes) }
    })
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
