//! The caller's memory: checked for null, then read or written.

use std::{
    ffi::{CStr, c_char},
    slice,
};

use crate::failure::Failure;

fn null(name: &str) -> Failure {
    Failure::argument(name, "null", "a pointer that is not null")
}

/// A handle that the caller holds.
///
/// # Safety
/// Unless it is null, it is a handle of this library that is not freed.
pub unsafe fn borrowed<'a, T>(handle: *const T, name: &str) -> Result<&'a T, Failure> {
    // SAFETY: as the caller promises.
    unsafe { handle.as_ref() }.ok_or_else(|| null(name))
}

/// A text of the caller.
///
/// # Safety
/// Unless it is null, it is a text that ends with a zero byte.
pub unsafe fn text<'a>(text: *const c_char, name: &str) -> Result<&'a str, Failure> {
    if text.is_null() {
        return Err(null(name));
    }
    // SAFETY: as the caller promises.
    let text = unsafe { CStr::from_ptr(text) };
    let text = text.to_str();
    text.map_err(|_| Failure::argument(name, "not UTF-8", "text in UTF-8"))
}

/// The caller's place for a result.
///
/// # Safety
/// Unless it is null, it is a place for a `T`, which may be uninitialized.
pub unsafe fn place<'a, T>(place: *mut T, name: &str) -> Result<Place<'a, T>, Failure> {
    // SAFETY: as the caller promises; uninitialized places are only written.
    let place = unsafe { place.cast::<std::mem::MaybeUninit<T>>().as_mut() };
    Ok(Place(place.ok_or_else(|| null(name))?))
}

/// A place that is written once.
pub struct Place<'a, T>(&'a mut std::mem::MaybeUninit<T>);

impl<T> Place<'_, T> {
    pub fn put(self, value: T) {
        self.0.write(value);
    }
}

/// Values of the caller.
///
/// # Safety
/// Unless it is null, it points to `count` values.
pub unsafe fn listed<'a, T>(
    values: *const T,
    count: usize,
    name: &str,
) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    if values.is_null() {
        return Err(null(name));
    }
    // SAFETY: as the caller promises.
    Ok(unsafe { slice::from_raw_parts(values, count) })
}

/// A buffer of the caller.
///
/// # Safety
/// Unless it is null, it has room for `count` plain numbers, of any bits, which nothing else uses meanwhile.
pub unsafe fn room<'a, T: Copy>(
    buffer: *mut T,
    count: usize,
    name: &str,
) -> Result<&'a mut [T], Failure> {
    if count == 0 {
        return Ok(&mut []);
    }
    if buffer.is_null() {
        return Err(null(name));
    }
    // SAFETY: as the caller promises.
    Ok(unsafe { slice::from_raw_parts_mut(buffer, count) })
}
