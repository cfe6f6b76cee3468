//! What is fuzzed: each subject takes any bytes, must not panic, and checks what it can of the answer.
//!
//! The same functions run under libFuzzer (`fuzz_targets/`) and, for a short while, as ordinary
//! tests (`tests/fuzz`).

#![allow(dead_code, reason = "each fuzz target runs one subject")]

pub mod address;
pub mod area;
pub mod body;
pub mod cursor;
pub mod import;
pub mod message;
mod protocols;
pub mod raster;
pub mod table;

/// A subject by its name, which is also that of its seeds' folder.
pub struct Subject {
    pub name: &'static str,
    pub run: fn(&[u8]),
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
