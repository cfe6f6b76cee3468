//! Columns as an Arrow stream, by the Arrow C data and stream interfaces.
//!
//! <https://arrow.apache.org/docs/format/CStreamInterface.html>. The columns are those of the daemon's Arrow
//! answers. Numbers and indices that no layer lacks are handed over without a copy; ids become text, and
//! coordinates columns of their own, a batch at a time.
//!
//! A reader owns what it is handed until it calls `release`, from any thread. Everything it may look at hangs on
//! `private_data`, which `release` drops.

use std::{
    collections::BTreeMap,
    ffi::{CString, c_char, c_int, c_void},
    fmt::Write as _,
    ptr,
    sync::Arc,
};

use strew_plan::{
    Columns,
    library::{Further, FurtherValues},
};

/// Rows of a batch: their ids fit 32-bit offsets.
const BATCH: usize = 1 << 20;
/// The flag of columns that may lack values.
const NULLABLE: i64 = 2;

/// `struct ArrowSchema`.
#[repr(C)]
pub struct Schema {
    format: *const c_char,
    name: *const c_char,
    metadata: *const c_char,
    flags: i64,
    n_children: i64,
    children: *mut *mut Schema,
    dictionary: *mut Schema,
    release: Option<unsafe extern "C" fn(*mut Schema)>,
    private_data: *mut c_void,
}

/// `struct ArrowArray`.
#[repr(C)]
pub struct Array {
    length: i64,
    null_count: i64,
    offset: i64,
    n_buffers: i64,
    n_children: i64,
    buffers: *mut *const c_void,
    children: *mut *mut Array,
    dictionary: *mut Array,
    release: Option<unsafe extern "C" fn(*mut Array)>,
    private_data: *mut c_void,
}

/// `struct ArrowArrayStream`.
#[repr(C)]
pub struct Stream {
    get_schema: Option<unsafe extern "C" fn(*mut Stream, *mut Schema) -> c_int>,
    get_next: Option<unsafe extern "C" fn(*mut Stream, *mut Array) -> c_int>,
    get_last_error: Option<unsafe extern "C" fn(*mut Stream) -> *const c_char>,
    release: Option<unsafe extern "C" fn(*mut Stream)>,
    private_data: *mut c_void,
}

// SAFETY: what a stream points to is an `Arc` and plain memory of its own, and has no thread.
unsafe impl Send for Stream {}

/// The batches that a stream has still to hand over.
struct Source {
    columns: Arc<Columns>,
    metadata: BTreeMap<String, String>,
    next: usize,
    is_over: bool,
}

impl Stream {
    /// The stream of some columns.
    pub fn new(columns: Arc<Columns>, metadata: BTreeMap<String, String>) -> Self {
        let source = Source {
            columns,
            metadata,
            next: 0,
            is_over: false,
        };
        Self {
            get_schema: Some(get_schema),
            get_next: Some(get_next),
            get_last_error: Some(get_last_error),
            release: Some(release_stream),
            private_data: Box::into_raw(Box::new(source)).cast(),
        }
    }
}

impl Drop for Stream {
    /// A stream that no reader took. One that was moved out has no `release` any more.
    fn drop(&mut self) {
        if let Some(release) = self.release {
            // SAFETY: it was not released yet, and is not used afterwards.
            unsafe { release(self) }
        }
    }
}

unsafe extern "C" fn get_schema(stream: *mut Stream, out: *mut Schema) -> c_int {
    // SAFETY: a reader passes a stream that it has not released, and room for a schema.
    unsafe {
        let source = &*(*stream).private_data.cast::<Source>();
        out.write(schema(source));
    }
    0
}

unsafe extern "C" fn get_next(stream: *mut Stream, out: *mut Array) -> c_int {
    // SAFETY: a reader passes a stream that it has not released, from one thread at a time, and room for an array.
    unsafe {
        let source = &mut *(*stream).private_data.cast::<Source>();
        out.write(source.next_batch());
    }
    0
}

/// Nothing fails.
unsafe extern "C" fn get_last_error(_: *mut Stream) -> *const c_char {
    ptr::null()
}

unsafe extern "C" fn release_stream(stream: *mut Stream) {
    // SAFETY: called once for a stream, whose private data is a box of `Stream::new`.
    unsafe {
        (*stream).release = None;
        drop(Box::from_raw((*stream).private_data.cast::<Source>()));
    }
}

/// The memory that a schema points to.
struct SchemaOwner {
    _format: CString,
    _name: CString,
    _metadata: Option<Vec<u8>>,
    children: Vec<*mut Schema>,
    dictionary: *mut Schema,
}

/// A field, or the schema of a stream.
fn field(
    format: &str,
    name: &str,
    is_optional: bool,
    children: Vec<Schema>,
    dictionary: Option<Schema>,
    metadata: Option<Vec<u8>>,
) -> Schema {
    let text = |text: &str| CString::new(text).unwrap_or_default();
    let boxed = |schema| Box::into_raw(Box::new(schema));
    let mut owner = Box::new(SchemaOwner {
        _format: text(format),
        _name: text(name),
        _metadata: metadata,
        children: children.into_iter().map(boxed).collect(),
        dictionary: dictionary.map_or(ptr::null_mut(), boxed),
    });
    let metadata = owner._metadata.as_ref();
    Schema {
        format: owner._format.as_ptr(),
        name: owner._name.as_ptr(),
        metadata: metadata.map_or(ptr::null(), |bytes| bytes.as_ptr().cast()),
        flags: if is_optional { NULLABLE } else { 0 },
        n_children: owner.children.len() as i64,
        children: owner.children.as_mut_ptr(),
        dictionary: owner.dictionary,
        release: Some(release_schema),
        private_data: Box::into_raw(owner).cast(),
    }
}

unsafe extern "C" fn release_schema(schema: *mut Schema) {
    // SAFETY: called once for a schema of `field`. Children that a reader took have no `release` any more.
    unsafe {
        (*schema).release = None;
        let owner = Box::from_raw((*schema).private_data.cast::<SchemaOwner>());
        for child in owner.children.iter().chain([&owner.dictionary]) {
            if !child.is_null() {
                let mut child = Box::from_raw(*child);
                if let Some(release) = child.release {
                    release(&raw mut *child);
                }
            }
        }
    }
}

fn schema(source: &Source) -> Schema {
    let plain = |name, format| field(format, name, false, vec![], None, None);
    let axes = ["x", "y", "z"].into_iter().take(source.columns.axes);
    let mut children = vec![plain("id", "u")];
    children.extend(axes.map(|axis| plain(axis, "g")));
    for Further {
        name,
        is_optional,
        values,
    } in &source.columns.further
    {
        children.push(match values {
            FurtherValues::Numbers(_) => field("g", name, *is_optional, vec![], None, None),
            FurtherValues::Names(..) => {
                let names = field("u", "", false, vec![], None, None);
                field("i", name, *is_optional, vec![], Some(names), None)
            }
        });
    }
    field(
        "+s",
        "",
        false,
        children,
        None,
        Some(pairs(&source.metadata)),
    )
}

/// Metadata: a count, then for each pair the lengths and bytes of its key and value.
fn pairs(metadata: &BTreeMap<String, String>) -> Vec<u8> {
    let number = |length: usize| i32::try_from(length).unwrap_or(0).to_ne_bytes();
    let mut bytes = number(metadata.len()).to_vec();
    for text in metadata.iter().flat_map(|(key, value)| [key, value]) {
        bytes.extend(number(text.len()));
        bytes.extend(text.as_bytes());
    }
    bytes
}

/// Memory that an array points to.
#[expect(dead_code, reason = "held until the array is released")]
enum Memory {
    Shared(Arc<Columns>),
    Bytes(Vec<u8>),
    Offsets(Vec<i32>),
    Numbers(Vec<f64>),
}

/// The memory that an array points to.
struct ArrayOwner {
    _memory: Vec<Memory>,
    buffers: Vec<*const c_void>,
    children: Vec<*mut Array>,
    dictionary: *mut Array,
}

/// An array over buffers, the first of which is the validity, or null.
fn array(
    length: usize,
    null_count: usize,
    buffers: Vec<*const c_void>,
    memory: Vec<Memory>,
    children: Vec<Array>,
    dictionary: Option<Array>,
) -> Array {
    let boxed = |array| Box::into_raw(Box::new(array));
    let mut owner = Box::new(ArrayOwner {
        _memory: memory,
        buffers,
        children: children.into_iter().map(boxed).collect(),
        dictionary: dictionary.map_or(ptr::null_mut(), boxed),
    });
    Array {
        length: length as i64,
        null_count: null_count as i64,
        offset: 0,
        n_buffers: owner.buffers.len() as i64,
        n_children: owner.children.len() as i64,
        buffers: owner.buffers.as_mut_ptr(),
        children: owner.children.as_mut_ptr(),
        dictionary: owner.dictionary,
        release: Some(release_array),
        private_data: Box::into_raw(owner).cast(),
    }
}

unsafe extern "C" fn release_array(array: *mut Array) {
    // SAFETY: called once for an array of `array`. Children that a reader took have no `release` any more.
    unsafe {
        (*array).release = None;
        let owner = Box::from_raw((*array).private_data.cast::<ArrayOwner>());
        for child in owner.children.iter().chain([&owner.dictionary]) {
            if !child.is_null() {
                let mut child = Box::from_raw(*child);
                if let Some(release) = child.release {
                    release(&raw mut *child);
                }
            }
        }
    }
}

/// An array that says that a stream is over.
const fn over() -> Array {
    Array {
        length: 0,
        null_count: 0,
        offset: 0,
        n_buffers: 0,
        n_children: 0,
        buffers: ptr::null_mut(),
        children: ptr::null_mut(),
        dictionary: ptr::null_mut(),
        release: None,
        private_data: ptr::null_mut(),
    }
}

impl Source {
    /// The next rows; at least one batch, so that names are known without rows.
    fn next_batch(&mut self) -> Array {
        let (first, count) = (self.next, self.columns.len());
        if self.is_over {
            return over();
        }
        let end = (first + BATCH).min(count);
        (self.next, self.is_over) = (end, end == count);
        let mut children = vec![self.ids(first, end)];
        let axes = 0..self.columns.axes;
        children.extend(axes.map(|axis| self.axis(axis, first, end)));
        for column in &self.columns.further {
            children.push(self.further(column, first, end));
        }
        array(end - first, 0, vec![ptr::null()], vec![], children, None)
    }

    fn ids(&self, first: usize, end: usize) -> Array {
        let mut text = String::with_capacity((end - first) * 12);
        let mut offsets = Vec::with_capacity(end - first + 1);
        offsets.push(0);
        let axes = self.columns.axes;
        for id in self.columns.ids[axes * first..axes * end].chunks(axes) {
            for (i, part) in id.iter().enumerate() {
                // Writing to memory cannot fail.
                let _ = write!(text, "{}{part}", if i == 0 { "" } else { ":" });
            }
            offsets.push(i32::try_from(text.len()).unwrap_or(i32::MAX));
        }
        texts(offsets, text.into_bytes())
    }

    fn axis(&self, axis: usize, first: usize, end: usize) -> Array {
        let axes = self.columns.axes;
        let at = self.columns.at[axes * first..axes * end].iter();
        let numbers: Vec<f64> = at.skip(axis).step_by(axes).copied().collect();
        let buffers = vec![ptr::null(), numbers.as_ptr().cast()];
        array(
            end - first,
            0,
            buffers,
            vec![Memory::Numbers(numbers)],
            vec![],
            None,
        )
    }

    fn further(&self, column: &Further, first: usize, end: usize) -> Array {
        let length = end - first;
        let (values, is_there, dictionary): (*const c_void, Vec<bool>, _) = match &column.values {
            FurtherValues::Numbers(all) => {
                let values = &all[first..end];
                let is_there = values.iter().map(|v| !v.is_nan());
                (values.as_ptr().cast(), is_there.collect(), None)
            }
            FurtherValues::Names(names, all) => {
                let values = &all[first..end];
                let is_there = values.iter().map(|index| *index >= 0);
                (
                    values.as_ptr().cast(),
                    is_there.collect(),
                    Some(listed(names)),
                )
            }
        };
        let null_count = is_there.iter().filter(|is_there| !**is_there).count();
        let mut memory = vec![Memory::Shared(self.columns.clone())];
        let mut validity: *const c_void = ptr::null();
        if null_count > 0 {
            let mut bits = vec![0_u8; length.div_ceil(8)];
            for (i, _) in is_there
                .iter()
                .enumerate()
                .filter(|(_, is_there)| **is_there)
            {
                bits[i / 8] |= 1 << (i % 8);
            }
            validity = bits.as_ptr().cast();
            memory.push(Memory::Bytes(bits));
        }
        array(
            length,
            null_count,
            vec![validity, values],
            memory,
            vec![],
            dictionary,
        )
    }
}

/// The names of a dictionary.
fn listed(names: &[String]) -> Array {
    let mut text = vec![];
    let mut offsets = vec![0];
    for name in names {
        text.extend_from_slice(name.as_bytes());
        offsets.push(i32::try_from(text.len()).unwrap_or(i32::MAX));
    }
    texts(offsets, text)
}

fn texts(offsets: Vec<i32>, text: Vec<u8>) -> Array {
    let buffers = vec![ptr::null(), offsets.as_ptr().cast(), text.as_ptr().cast()];
    let length = offsets.len() - 1;
    array(
        length,
        0,
        buffers,
        vec![Memory::Offsets(offsets), Memory::Bytes(text)],
        vec![],
        None,
    )
}
