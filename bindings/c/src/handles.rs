//! Handles: a library, planned queries, and bytes.

#![expect(non_camel_case_types, reason = "the names of C")]

#[cfg(not(target_arch = "wasm32"))]
use std::path::Path;
use std::{
    ffi::c_char,
    ptr,
    sync::{Arc, OnceLock},
};

use ::strew_plan::{Columns, Library, Planned};
use strew_encode::Crs;

use crate::{
    failure::{AUDIENCE, Code, Failure, guarded},
    memory::{borrowed, listed, place, text},
};

/// Tables and limits, with which queries are answered. Threads may share one.
pub struct strew_library(pub(crate) Arc<Library>);

/// A planned query: counted exactly, its points are made when a buffer is filled. Threads may share one.
pub struct strew_plan {
    pub(crate) library: Arc<Library>,
    pub(crate) planned: Planned,
    /// The plane that it is in, which documents state.
    pub(crate) plane: Option<Crs>,
    /// All columns, made when ids or a further column are first requested.
    pub(crate) columns: OnceLock<Columns>,
}

/// Bytes that the library has allocated.
pub struct strew_bytes(pub(crate) Vec<u8>);

/// The version of the library, such as `0.1.0`.
#[unsafe(no_mangle)]
pub extern "C" fn strew_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// Opens a library of the built-in tables. Free it with `strew_library_free`.
///
/// `folder`, unless it is null, is a folder of table files (`.strew`), which replace built-in ones of the same
/// profile, alpha and map.
///
/// Returns `STREW_TABLE_UNREADABLE` if a file of the folder is no table.
///
/// # Safety
/// `folder` is null or a text; `library` is a place for a pointer.
#[cfg(not(target_arch = "wasm32"))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_library_open(
    folder: *const c_char,
    library: *mut *mut strew_library,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let (out, folder) = unsafe {
            let folder = (!folder.is_null()).then(|| text(folder, "folder"));
            (place(library, "library")?, folder.transpose()?)
        };
        let opened = Library::open(folder.map(Path::new))
            .map_err(Failure::unavailable)?
            .for_audience(&AUDIENCE);
        out.put(Box::into_raw(Box::new(strew_library(Arc::new(opened)))));
        Ok(())
    })
}

/// Opens a library of the tables that the caller has in memory, and no others, without built-in fields. The files
/// are copied. Free it with `strew_library_free`.
///
/// Returns `STREW_TABLE_UNREADABLE` if one is no table.
///
/// # Safety
/// `files` are `count` pointers to files of `lengths` bytes; `library` is a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_library_of_tables(
    files: *const *const u8,
    lengths: *const usize,
    count: usize,
    library: *mut *mut strew_library,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let (out, files, lengths) = unsafe {
            let files = listed(files, count, "files")?;
            let lengths = listed(lengths, count, "lengths")?;
            (place(library, "library")?, files, lengths)
        };
        // SAFETY: as the caller promises.
        let copied = files
            .iter()
            .zip(lengths)
            .map(|(&file, &length)| unsafe { listed(file, length, "files").map(<[u8]>::to_vec) });
        let copied = copied.collect::<Result<Vec<_>, _>>()?;
        let opened = Library::of_tables(copied)
            .map_err(Failure::unavailable)?
            .for_audience(&AUDIENCE);
        out.put(Box::into_raw(Box::new(strew_library(Arc::new(opened)))));
        Ok(())
    })
}

/// Frees a library. Its plans stay valid. Null is allowed.
///
/// # Safety
/// `library` is null or a library that is not freed yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_library_free(library: *mut strew_library) {
    // SAFETY: as the caller promises.
    unsafe { free(library) }
}

/// Frees a plan. Null is allowed.
///
/// # Safety
/// `plan` is null or a plan that is not freed yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_free(plan: *mut strew_plan) {
    // SAFETY: as the caller promises.
    unsafe { free(plan) }
}

/// Frees bytes. Null is allowed.
///
/// # Safety
/// `bytes` is null or bytes that are not freed yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_bytes_free(bytes: *mut strew_bytes) {
    // SAFETY: as the caller promises.
    unsafe { free(bytes) }
}

/// The first of some bytes. After the last one stands a zero, so text can be read as such. Null for null.
///
/// # Safety
/// `bytes` is null or bytes that are not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_bytes_data(bytes: *const strew_bytes) -> *const c_char {
    // SAFETY: as the caller promises.
    let bytes = unsafe { bytes.as_ref() };
    bytes.map_or(ptr::null(), |bytes| bytes.0.as_ptr().cast())
}

/// The number of bytes, without the zero after them. 0 for null.
///
/// # Safety
/// `bytes` is null or bytes that are not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_bytes_length(bytes: *const strew_bytes) -> usize {
    // SAFETY: as the caller promises.
    let bytes = unsafe { bytes.as_ref() };
    bytes.map_or(0, |bytes| bytes.0.len() - 1)
}

/// # Safety
/// `handle` is null or a box that is not freed yet.
unsafe fn free<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: as the caller promises.
        let handle = unsafe { Box::from_raw(handle) };
        // A panic while something is dropped ends here.
        guarded(|| {
            drop(handle);
            Ok(())
        });
    }
}

impl strew_bytes {
    /// Hands bytes to the caller.
    ///
    /// # Safety
    /// `out` is null or a place for a pointer.
    pub(crate) unsafe fn hand_over(
        mut content: Vec<u8>,
        out: *mut *mut Self,
    ) -> Result<(), Failure> {
        content.push(0);
        // SAFETY: as the caller promises.
        let out = unsafe { place(out, "bytes")? };
        out.put(Box::into_raw(Box::new(Self(content))));
        Ok(())
    }
}

/// Holds a field, a body of `POST /v1/fields`, and returns the name by which queries name it, as text.
///
/// # Safety
/// `library` is a library, `body` a text, `name` a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_library_hold_field(
    library: *const strew_library,
    body: *const c_char,
    name: *mut *mut strew_bytes,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        unsafe {
            let library = borrowed(library, "library")?;
            let held = library.0.hold_field(text(body, "body")?)?;
            strew_bytes::hand_over(held.into_bytes(), name)
        }
    })
}
