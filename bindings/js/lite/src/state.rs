//! What the module holds between calls.

use alloc::vec::Vec;

use spin::Mutex;
use strew_core::{BoundAttributes, Plan, Table};

use crate::{describe::Described, output::Output};

/// Things by the numbers of their places. A number that is free is used again.
pub struct List<T>(Vec<Option<T>>);

impl<T> List<T> {
    /// Adds a thing; returns its number.
    pub fn add(&mut self, thing: T) -> i32 {
        let free = self.0.iter().position(Option::is_none);
        let place = free.unwrap_or_else(|| {
            self.0.push(None);
            self.0.len() - 1
        });
        self.0[place] = Some(thing);
        place as i32
    }

    /// A thing by its number.
    pub fn get(&self, number: u32) -> Option<&T> {
        self.0.get(number as usize)?.as_ref()
    }

    /// A thing by its number, to be changed.
    pub fn get_mut(&mut self, number: u32) -> Option<&mut T> {
        self.0.get_mut(number as usize)?.as_mut()
    }

    /// Frees a thing.
    pub fn remove(&mut self, number: u32) {
        if let Some(place) = self.0.get_mut(number as usize) {
            *place = None;
        }
    }
}

/// The points of an area.
pub struct Planned {
    /// The points.
    pub plan: Plan,
    /// Their attributes.
    pub bound: BoundAttributes,
    /// Whether `f64` coordinates are relative to the corner: those of a chunk are.
    pub relative: bool,
}

/// All that is held.
pub struct State {
    /// Bytes of the caller.
    pub input: Vec<u8>,
    /// The result of the last call.
    pub output: Output,
    /// Tables.
    pub tables: List<Table>,
    /// Sets of points.
    pub sets: List<Described>,
    /// Points of areas.
    pub plans: List<Planned>,
}

static STATE: Mutex<State> = Mutex::new(State {
    input: Vec::new(),
    output: Output::Words(Vec::new()),
    tables: List(Vec::new()),
    sets: List(Vec::new()),
    plans: List(Vec::new()),
});

/// Does something with all that is held.
pub fn with<T>(work: impl FnOnce(&mut State) -> T) -> T {
    work(&mut STATE.lock())
}
