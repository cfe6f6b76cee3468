//! A look at the bytes of a message before it is decoded: what it repeats is counted against its limits, and
//! what it takes in memory is known. Nothing is allocated for a message that is in order.
//!
//! An empty layer is 2 bytes on the wire and 2 kB in memory, and a decoder joins messages that occur twice where
//! the contract has one. So the limits of a query, which is checked once it is read, would come too late.

use prost::Message;
use strew_config::Limits;
use strew_error::{Error, Fault};

use super::{
    super::proto,
    most::{self, Among, Limit, Most, TALLIES, Tally},
};

/// A message that the contract has as a request.
pub trait Shaped: Message + Default + 'static {
    /// Its place among the shapes.
    const SHAPE: usize;
}

/// A message of the contract.
#[derive(Debug)]
pub(super) struct Shape {
    /// Its size in memory.
    pub(super) bytes: usize,
    /// Whether it is a `Field`, whose parts are counted together.
    pub(super) is_field: bool,
    pub(super) fields: &'static [Field],
}

/// A field of a message.
#[derive(Debug)]
pub(super) struct Field {
    pub(super) number: u32,
    pub(super) name: &'static str,
    pub(super) kind: Kind,
    pub(super) most: Most,
}

/// The content of a field, as far as it takes memory of its own.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// Text.
    Text,
    /// Bytes, which are pixels wherever a request has them.
    Pixels,
    /// A message, by its number in [`SHAPES`].
    Message(usize),
}

// Made from the contract: `SHAPES`, the messages that requests are made of; requests, which are [`Shaped`], come first.
include!("../generated/shapes.rs");

/// The price of a message.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Cost {
    /// The bytes of memory once it is decoded.
    pub(super) memory: usize,
    /// The bytes of pictures and of floats in it.
    pub(super) pixels: usize,
}

/// Walks over the message of a shape.
///
/// # Errors
/// [`Error::Invalid`] with the path of a field that occurs too often, or for bytes that are no message.
pub(super) fn cost(shape: usize, bytes: &[u8], limits: &Limits) -> Result<Cost, Error> {
    let mut walk = Walk::new(Some(limits));
    walk.cost.memory = SHAPES[shape].bytes;
    let found = walk.message(shape, bytes, 0);
    let (path, most, count) = match found {
        Ok(()) => return Ok(walk.cost),
        Err(Stopped::NoMessage) => return Err(no_message("its fields do not end where it ends")),
        Err(Stopped::TooDeep) => return Err(no_message("nested too deeply")),
        Err(Stopped::TooMany { path, most, count }) => (path, most, count),
    };
    let count = match most.among {
        Among::List => count,
        Among::Request(tally) | Among::Field(tally) => {
            let mut all = Walk::new(None);
            // Its end may not be a message.
            let _ = all.message(shape, bytes, 0);
            all.greatest[tally as usize].max(count)
        }
    };
    let limit = most.limit.of(limits);
    let value = format!("{count} {}", most.what);
    let (detail, allowed): (String, String) = match (most.among, most.limit) {
        (_, Limit::Vertices) => (
            format!(
                "the regions of the query have too many {} in all",
                most.what
            ),
            format!("at most {limit}"),
        ),
        _ if most.is_once() => ("occurs several times".into(), "at most one".into()),
        _ => (
            format!("too many {}", most.what),
            format!("at most {limit} {}", most.what),
        ),
    };
    Err(Fault::new(&path, value, detail, allowed).into())
}

/// The fault of bytes that are no message.
pub(in crate::grpc) fn no_message(detail: &str) -> Error {
    Fault::new("message", "", detail, "one whole message of the contract").into()
}

/// The greatest depth of messages in one another; the decoder has the same limit.
const DEEPEST: usize = 100;

enum Stopped {
    NoMessage,
    TooDeep,
    TooMany {
        path: String,
        most: Most,
        count: usize,
    },
}

struct Walk<'a> {
    /// Without limits everything is only counted.
    limits: Option<&'a Limits>,
    cost: Cost,
    tallies: [usize; TALLIES],
    greatest: [usize; TALLIES],
    /// Whether what is looked at lies in a field.
    in_field: bool,
}

impl<'a> Walk<'a> {
    fn new(limits: Option<&'a Limits>) -> Self {
        Self {
            limits,
            cost: Cost::default(),
            tallies: [0; TALLIES],
            greatest: [0; TALLIES],
            in_field: false,
        }
    }

    fn message(&mut self, shape: usize, bytes: &[u8], depth: usize) -> Result<(), Stopped> {
        if depth > DEEPEST {
            return Err(Stopped::TooDeep);
        }
        let shape = &SHAPES[shape];
        let is_root = shape.is_field && !self.in_field;
        if is_root {
            self.in_field = true;
            for tally in [Tally::Parts, Tally::Marks] {
                self.tallies[tally as usize] = 0;
            }
        }
        let walked = self.fields(shape, bytes, depth);
        if is_root {
            self.in_field = false;
        }
        walked
    }

    fn fields(&mut self, shape: &Shape, mut rest: &[u8], depth: usize) -> Result<(), Stopped> {
        let mut counts = [0; MOST_FIELDS];
        let bytes = rest;
        while !rest.is_empty() {
            let (number, value) = next(&mut rest).ok_or(Stopped::NoMessage)?;
            let place = shape.fields.iter().position(|field| field.number == number);
            // Decoders skip what they do not know, and refuse what is of another type.
            let (Some(place), Value::Bytes(value)) = (place, value) else {
                continue;
            };
            let field = &shape.fields[place];
            counts[place] += 1;
            self.count(field, counts[place], bytes)?;
            match field.kind {
                Kind::Text => self.cost.memory += 2 * size_of::<String>() + value.len(),
                Kind::Pixels => self.cost.pixels += value.len(),
                Kind::Message(inner) => {
                    // Vectors begin with room for four, and have twice the room at most.
                    let room = if counts[place] == 1 { 4 } else { 2 };
                    self.cost.memory += room * SHAPES[inner].bytes;
                    self.message(inner, value, depth + 1)
                        .map_err(|stopped| within(stopped, field, counts[place] - 1))?;
                }
            }
        }
        Ok(())
    }

    /// Checks a field that occurs again, `count` times so far in its list; `bytes` are those of the message
    /// with the list.
    fn count(&mut self, field: &Field, count: usize, bytes: &[u8]) -> Result<(), Stopped> {
        let most = field.most;
        let so_far = match most.among {
            // A text that comes again takes the place of the first one.
            Among::List if most.is_once() && !matches!(field.kind, Kind::Message(_)) => 1,
            Among::List => count,
            Among::Request(tally) | Among::Field(tally) => {
                let tally = tally as usize;
                self.tallies[tally] += 1;
                self.greatest[tally] = self.greatest[tally].max(self.tallies[tally]);
                self.tallies[tally]
            }
        };
        if self
            .limits
            .is_none_or(|limits| so_far <= most.limit.of(limits))
        {
            return Ok(());
        }
        Err(Stopped::TooMany {
            path: field.name.into(),
            most,
            count: match most.among {
                Among::List => occurrences(field, bytes),
                _ => so_far,
            },
        })
    }
}

/// Puts the field that holds it before a path.
fn within(stopped: Stopped, field: &Field, index: usize) -> Stopped {
    match stopped {
        Stopped::TooMany { path, most, count } => Stopped::TooMany {
            path: match field.most.is_once() {
                true => format!("{}.{path}", field.name),
                false => format!("{}[{index}].{path}", field.name),
            },
            most,
            count,
        },
        other => other,
    }
}

/// The number of times that a field occurs in a message.
fn occurrences(field: &Field, mut rest: &[u8]) -> usize {
    let fields = std::iter::from_fn(|| next(&mut rest));
    fields.filter(|(number, _)| *number == field.number).count()
}

#[derive(Clone, Copy)]
enum Value<'a> {
    Number,
    Bytes(&'a [u8]),
}

/// The next field of a message: its number and its value. Nothing if there is no whole one.
fn next<'a>(rest: &mut &'a [u8]) -> Option<(u32, Value<'a>)> {
    let key = varint(rest)?;
    let number = u32::try_from(key >> 3).ok()?;
    let value = match key & 7 {
        0 => varint(rest).map(|_| Value::Number)?,
        1 => take(rest, 8).map(|_| Value::Number)?,
        2 => {
            let length = usize::try_from(varint(rest)?).ok()?;
            Value::Bytes(take(rest, length)?)
        }
        // Groups are of no use here. What is in one that is unknown follows as fields.
        3 | 4 => Value::Number,
        5 => take(rest, 4).map(|_| Value::Number)?,
        _ => return None,
    };
    Some((number, value))
}

fn take<'a>(rest: &mut &'a [u8], length: usize) -> Option<&'a [u8]> {
    let (taken, left) = rest.split_at_checked(length)?;
    *rest = left;
    Some(taken)
}

fn varint(rest: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let (&byte, left) = rest.split_first()?;
        *rest = left;
        value |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Some(value);
        }
    }
    None
}
