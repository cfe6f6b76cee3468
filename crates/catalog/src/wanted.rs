//! Whether what is read is still wanted: readers of long lists look now and then, wherever they are called from.
//!
//! Parsers call readers without a place for a flag, so the thread that reads has it.

use std::cell::RefCell;

use strew_core::server::Stop;

thread_local! {
    static STOP: RefCell<Stop> = const { RefCell::new(Stop::NEVER) };
}

/// Elements of a list between two looks: some ten microseconds.
const OFTEN: usize = 256;

/// Runs a reader, which ends with an error once the flag is raised.
pub fn until<T>(stop: &Stop, read: impl FnOnce() -> T) -> T {
    struct Before(Stop);

    impl Drop for Before {
        fn drop(&mut self) {
            STOP.replace(std::mem::take(&mut self.0));
        }
    }

    let _before = Before(STOP.replace(stop.clone()));
    read()
}

/// Looks before every few elements of a list.
pub(crate) fn look(element: usize) -> Result<(), &'static str> {
    if !element.is_multiple_of(OFTEN) {
        return Ok(());
    }
    let stop = STOP.with_borrow(Stop::clone);
    match stop.is_raised() {
        true => Err("not wanted any more"),
        false => Ok(()),
    }
}
