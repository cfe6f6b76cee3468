//! Memory for callers of the WebAssembly module, who have none of their own: `bindings/js`.

use std::{
    alloc::{Layout, alloc, dealloc},
    ptr,
};

/// The alignment of buffers, enough for any number.
const ALIGNMENT: usize = 8;

/// Room for some bytes, or null. Its caller releases it with the same size.
#[unsafe(no_mangle)]
pub extern "C" fn strew_allocate(bytes: usize) -> *mut u8 {
    match Layout::from_size_align(bytes.max(1), ALIGNMENT) {
        // SAFETY: the size is not zero.
        Ok(layout) => unsafe { alloc(layout) },
        Err(_) => ptr::null_mut(),
    }
}

/// Releases room.
///
/// # Safety
/// `room` is of `strew_allocate` with this size, and not released yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_release(room: *mut u8, bytes: usize) {
    if let Ok(layout) = Layout::from_size_align(bytes.max(1), ALIGNMENT) {
        // SAFETY: as the caller promises.
        unsafe { dealloc(room, layout) }
    }
}
