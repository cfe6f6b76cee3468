//! Lists that are counted while they are read, so that a long one takes no memory, and end once they are not
//! wanted any more.

use std::{cell::RefCell, fmt, marker::PhantomData, ops::RangeInclusive};

use serde::de::{Deserialize, Deserializer, Error as _, IgnoredAny, SeqAccess, Visitor};
use strew_core::server::Stop;

/// Reads a list of a number of elements, called `what`.
pub fn list<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
    range: RangeInclusive<usize>,
    what: &'static str,
) -> Result<Vec<T>, D::Error> {
    let elements = PhantomData;
    deserializer.deserialize_seq(List {
        range,
        what,
        elements,
    })
}

struct List<T> {
    range: RangeInclusive<usize>,
    what: &'static str,
    elements: PhantomData<T>,
}

impl<'de, T: Deserialize<'de>> Visitor<'de> for List<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an array of {}", self.what)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Vec<T>, A::Error> {
        let (least, most) = (*self.range.start(), *self.range.end());
        let what = self.what;
        let mut all = vec![];
        while all.len() < most {
            look(all.len()).map_err(A::Error::custom)?;
            match elements.next_element()? {
                Some(element) => all.push(element),
                None if all.len() < least => {
                    let count = all.len();
                    return Err(A::Error::custom(format!(
                        "{count} {what}, fewer than {least}"
                    )));
                }
                None => return Ok(all),
            }
        }
        let mut count = most;
        while elements.next_element::<IgnoredAny>()?.is_some() {
            look(count).map_err(A::Error::custom)?;
            count += 1;
        }
        if count > most {
            return Err(A::Error::custom(format!(
                "{count} {what}, more than {most}"
            )));
        }
        Ok(all)
    }
}

// Parsers call readers without a place for a flag, so the thread that reads has it.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reading_ends_when_it_is_not_wanted() {
        let stop = Stop::new();
        let read = || {
            let mut json = serde_json::Deserializer::from_str("[1, 2, 3]");
            until(&stop, || list::<_, u8>(&mut json, 0..=9, "numbers")).is_ok()
        };
        assert!(read());
        stop.raise();
        assert!(!read());
        // Whatever the thread reads next is wanted.
        assert!(
            list::<_, u8>(
                &mut serde_json::Deserializer::from_str("[1]"),
                0..=9,
                "numbers"
            )
            .is_ok()
        );
    }

    #[test]
    fn lists_are_as_long_as_they_may_be_and_faults_say_how_long_they_are() {
        let read = |text: &str| {
            let mut json = serde_json::Deserializer::from_str(text);
            let read: Result<Vec<u8>, _> = list(&mut json, 1..=3, "numbers");
            read.map_err(|error| error.to_string())
        };
        assert_eq!(read("[1, 2, 3]"), Ok(vec![1, 2, 3]));
        let fault = read("[1, 2, 3, {}, 5]").expect_err("too many");
        assert!(fault.starts_with("5 numbers, more than 3"), "{fault}");
        let fault = read("[]").expect_err("too few");
        assert!(fault.starts_with("0 numbers, fewer than 1"), "{fault}");
        let fault = read("{}").expect_err("no list");
        assert!(fault.contains("an array of numbers"), "{fault}");
    }
}
