//! What is fuzzed: each subject takes any bytes, must not panic, and checks what it can of the answer. What it
//! takes of memory and of the processor is bounded (`bounds.rs`).
//!
//! The same functions run under libFuzzer (`fuzz_targets/`) and, for a short while, as ordinary
//! tests (`tests/fuzz`).

#![allow(dead_code, reason = "each fuzz target runs one subject")]

pub mod address;
pub mod area;
pub mod body;
pub mod bounds;
pub mod cursor;
pub mod import;
pub mod message;
mod protocols;
pub mod raster;
pub mod table;

/// A subject by its name, which is also that of its seeds' folder.
pub struct Subject {
    pub name: &'static str,
    run: fn(&[u8]),
}

impl Subject {
    /// Runs it on an input, which may not take too much.
    pub fn check(&self, data: &[u8]) {
        bounds::within(self.name, self.run, data);
    }
}

/// Runs the subject with a name.
pub fn check(name: &str, data: &[u8]) {
    let subject = SUBJECTS.iter().find(|subject| subject.name == name);
    subject.expect("a subject").check(data);
}

pub const SUBJECTS: [Subject; 8] = [
    Subject {
        name: "address",
        run: address::run,
    },
    Subject {
        name: "area",
        run: area::run,
    },
    Subject {
        name: "body",
        run: body::run,
    },
    Subject {
        name: "cursor",
        run: cursor::run,
    },
    Subject {
        name: "import",
        run: import::run,
    },
    Subject {
        name: "message",
        run: message::run,
    },
    Subject {
        name: "raster",
        run: raster::run,
    },
    Subject {
        name: "table",
        run: table::run,
    },
];
