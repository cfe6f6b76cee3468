//! Collecting everything that is wrong with a query.

use crate::service::{Error, Fault};

/// No more faults are reported: an error is to be read.
pub(super) const MOST: usize = 16;

/// The faults found so far. A field is faulted once.
#[derive(Debug, Default)]
pub(super) struct Faults(Vec<Fault>);

impl Faults {
    pub(super) const fn new(found: Vec<Fault>) -> Self {
        Self(found)
    }

    pub(super) fn add(&mut self, fault: Fault) {
        // Of several ways to say the same, what is wrong with one is enough.
        let same = |known: &Fault| known.field == fault.field || same_matter(known, &fault);
        if !self.0.iter().any(same) && self.0.len() < MOST {
            self.0.push(fault);
        }
    }

    /// The value, or a note of what is wrong.
    pub(super) fn take<T>(&mut self, result: Result<T, Fault>) -> Option<T> {
        result.map_err(|fault| self.add(fault)).ok()
    }

    /// The same with several faults.
    pub(super) fn take_all<T>(&mut self, result: Result<T, Vec<Fault>>) -> Option<T> {
        let note = |faults: Vec<Fault>| faults.into_iter().for_each(|fault| self.add(fault));
        result.map_err(note).ok()
    }

    pub(super) const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn into_error(self) -> Error {
        Error::Invalid(self.0)
    }

    pub(super) fn into_inner(self) -> Vec<Fault> {
        self.0
    }
}

/// Whether two fields are two ways to say how many points there are, or where, in the same layer.
fn same_matter(a: &Fault, b: &Fault) -> bool {
    const MATTERS: [&[&str]; 2] = [
        &["density", "spacing", "min_distance", "count", "layers"],
        &["region", "bbox", "circle", "polygon", "chunk"],
    ];
    let split = |fault: &Fault| {
        let (path, name) = fault.field.rsplit_once('.').unwrap_or(("", &fault.field));
        let matter = MATTERS.iter().position(|names| names.contains(&name))?;
        Some((path.to_owned(), matter))
    };
    split(a).is_some_and(|a| Some(a) == split(b))
}
