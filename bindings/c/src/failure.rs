//! Errors: a code for programs and a message for people, kept for each thread.

use std::{
    any::Any,
    cell::RefCell,
    ffi::{CString, c_char},
    panic::{AssertUnwindSafe, catch_unwind},
};

use serde_json::json;
use strew_error::{Audience, Error, Fault, Kind};

/// Who reads errors.
pub const AUDIENCE: Audience = match cfg!(target_arch = "wasm32") {
    true => Audience::SCRIPT,
    false => Audience::C,
};

/// The result of a function.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// The call succeeded.
    Ok = 0,
    /// A query that is not valid.
    InvalidQuery = 1,
    /// More points than one answer may have.
    TooManyPoints = 2,
    /// Counting the points would take too long.
    TooManyRows = 3,
    /// Another table would answer than the one that the query pins.
    OtherTable = 4,
    /// A table that cannot be read.
    TableUnreadable = 5,
    /// The set has no point with that id.
    NoSuchPoint = 6,
    /// An argument that is not valid: a null pointer, text that is not UTF-8, an unknown column.
    InvalidArgument = 7,
    /// A buffer with too little room.
    BufferTooSmall = 8,
    /// A fault of the library itself. The handles of the call must not be used again.
    Internal = 9,
}

/// An error with its words.
#[derive(Debug)]
pub struct Failure {
    code: Code,
    kind: &'static str,
    message: String,
    faults: Vec<Fault>,
}

impl Failure {
    /// Something about an argument.
    pub fn argument(field: &str, detail: &str, allowed: &str) -> Self {
        let mut fault = Fault::missing(field, allowed);
        fault.detail = detail.into();
        Self {
            code: Code::InvalidArgument,
            kind: "invalid-argument",
            message: fault.to_string(),
            faults: vec![fault],
        }
    }

    /// A buffer for `capacity` numbers where `points` have `numbers`.
    pub fn room(capacity: usize, points: usize, numbers: usize) -> Self {
        let detail = format!("is less than the {points} points need");
        let fault = Fault::new("capacity", capacity, detail, format!("{numbers} or more"));
        Self::of(Code::BufferTooSmall, &fault.into())
    }

    /// The failure of a library that cannot be opened.
    pub fn unavailable(error: impl std::fmt::Display) -> Self {
        Self {
            code: Code::TableUnreadable,
            kind: Kind::TableUnreadable.slug(),
            message: error.to_string(),
            faults: vec![],
        }
    }

    fn of(code: Code, error: &Error) -> Self {
        Self {
            code,
            kind: error.kind().slug(),
            message: error.message_for(&AUDIENCE),
            faults: error.faults().to_vec(),
        }
    }

    fn panicked(panic: &(dyn Any + Send)) -> Self {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        Self {
            code: Code::Internal,
            kind: Kind::Internal.slug(),
            message: format!("a fault of the library: {}", text.unwrap_or("unknown")),
            faults: vec![],
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let code = match error.kind() {
            Kind::Invalid => Code::InvalidQuery,
            Kind::TooManyPoints => Code::TooManyPoints,
            Kind::TooManyRows => Code::TooManyRows,
            Kind::OtherTable => Code::OtherTable,
            Kind::TableUnreadable => Code::TableUnreadable,
            Kind::NoSuchPoint => Code::NoSuchPoint,
            _ => Code::Internal,
        };
        Self::of(code, &error)
    }
}

/// The texts of the last error of a thread.
#[derive(Default)]
struct LastError {
    kind: CString,
    message: CString,
    field: CString,
    document: CString,
}

thread_local! {
    static LAST: RefCell<LastError> = RefCell::default();
}

/// Does something, and keeps the words if it fails or panics.
pub fn guarded(work: impl FnOnce() -> Result<(), Failure>) -> Code {
    let done = catch_unwind(AssertUnwindSafe(work));
    match done.unwrap_or_else(|panic| Err(Failure::panicked(&*panic))) {
        Ok(()) => Code::Ok,
        Err(failure) => {
            // A thread that ends has no place for them any more.
            let _ = LAST.try_with(|last| *last.borrow_mut() = texts(&failure));
            failure.code
        }
    }
}

fn texts(failure: &Failure) -> LastError {
    // The texts have no zero bytes, but for ones that a query brought along.
    let text = |text: &str| CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default();
    let document = json!({
        "kind": failure.kind,
        "detail": failure.message,
        "errors": failure.faults,
    });
    let field = failure.faults.first().map_or("", |fault| &fault.field);
    LastError {
        kind: text(failure.kind),
        message: text(&failure.message),
        field: text(field),
        document: text(&document.to_string()),
    }
}

fn last(part: impl FnOnce(&LastError) -> &CString) -> *const c_char {
    let text = LAST.try_with(|last| part(&last.borrow()).as_ptr());
    text.unwrap_or(c"".as_ptr())
}

/// The words of the last error in the calling thread, those of REST: field, value, what is allowed.
///
/// Valid until the next call in this thread that fails. Empty if none has failed.
#[unsafe(no_mangle)]
pub extern "C" fn strew_error_message() -> *const c_char {
    last(|texts| &texts.message)
}

/// The kind of the last error in the calling thread, as in the problem types of REST: `invalid-query`, ...
///
/// Valid as long as `strew_error_message`.
#[unsafe(no_mangle)]
pub extern "C" fn strew_error_kind() -> *const c_char {
    last(|texts| &texts.kind)
}

/// The field of the query, or the argument, that is wrong; of several the first. Empty if the error has none.
///
/// Valid as long as `strew_error_message`.
#[unsafe(no_mangle)]
pub extern "C" fn strew_error_field() -> *const c_char {
    last(|texts| &texts.field)
}

/// The last error in the calling thread as JSON: `kind`, `detail`, and `errors`, a list with the `field`, `value`,
/// `detail` and `allowed` of everything that is wrong.
///
/// Valid as long as `strew_error_message`.
#[unsafe(no_mangle)]
pub extern "C" fn strew_error_document() -> *const c_char {
    last(|texts| &texts.document)
}
