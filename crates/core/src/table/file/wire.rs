//! Little-endian writing and checked reading of a section's bytes.

use alloc::{format, string::String, vec::Vec};

/// Appends values in the file's encoding.
#[derive(Default)]
pub(super) struct Writer {
    pub(super) bytes: Vec<u8>,
}

impl Writer {
    pub(super) fn u32(&mut self, value: u32) {
        self.bytes.extend(value.to_le_bytes());
    }

    pub(super) fn u64(&mut self, value: u64) {
        self.bytes.extend(value.to_le_bytes());
    }

    pub(super) fn f64(&mut self, value: f64) {
        self.bytes.extend(value.to_le_bytes());
    }

    pub(super) fn text(&mut self, value: &str) {
        self.length(value.len());
        self.bytes.extend(value.as_bytes());
    }

    /// A number of items; every list a table may hold is far below 2³².
    pub(super) fn length(&mut self, items: usize) {
        self.u32(items as u32);
    }
}

/// Takes values off the front of a section; what is wrong is said in words.
pub(super) struct Reader<'a> {
    rest: &'a [u8],
}

type Read<T> = Result<T, String>;

impl<'a> Reader<'a> {
    pub(super) const fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    pub(super) const fn remaining(&self) -> usize {
        self.rest.len()
    }

    pub(super) fn take(&mut self, bytes: usize, what: &str) -> Read<&'a [u8]> {
        let (taken, rest) = self
            .rest
            .split_at_checked(bytes)
            .ok_or_else(|| format!("{what} needs {bytes} bytes, {} are left", self.rest.len()))?;
        self.rest = rest;
        Ok(taken)
    }

    pub(super) fn array<const N: usize>(&mut self, what: &str) -> Read<[u8; N]> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, what)?);
        Ok(array)
    }

    pub(super) fn u32(&mut self, what: &str) -> Read<u32> {
        self.array(what).map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self, what: &str) -> Read<u64> {
        self.array(what).map(u64::from_le_bytes)
    }

    pub(super) fn f64(&mut self, what: &str) -> Read<f64> {
        self.array(what).map(f64::from_le_bytes)
    }

    pub(super) fn text(&mut self, what: &str) -> Read<String> {
        let length = self.u32(what)? as usize;
        let bytes = self.take(length, what)?;
        core::str::from_utf8(bytes)
            .map(Into::into)
            .map_err(|_| format!("{what} is not UTF-8"))
    }

    /// A list whose items take at least `least` bytes each, so that a wrong length never reserves
    /// more memory than the file has.
    pub(super) fn list<T>(
        &mut self,
        least: usize,
        what: &str,
        mut item: impl FnMut(&mut Self) -> Read<T>,
    ) -> Read<Vec<T>> {
        let length = self.u32(what)? as usize;
        if length > self.rest.len() / least {
            return Err(format!(
                "{what} states {length} items, too many for what is left"
            ));
        }
        (0..length).map(|_| item(self)).collect()
    }

    pub(super) fn end(&self, what: &str) -> Read<()> {
        match self.rest.len() {
            0 => Ok(()),
            left => Err(format!("{left} bytes are left after {what}")),
        }
    }
}
