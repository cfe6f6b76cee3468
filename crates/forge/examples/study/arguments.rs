//! Arguments. Flags are taken out first; what is left are words.

use std::{error::Error, path::Path, str::FromStr};

use strew_core::Table;
use strew_forge::read_table;

use crate::Outcome;

/// A value that is read from text.
pub trait Readable: FromStr<Err: Error + 'static> {}

impl<T: FromStr<Err: Error + 'static>> Readable for T {}

pub struct Arguments(Vec<String>);

impl Arguments {
    pub fn new(words: impl Iterator<Item = String>) -> Self {
        Self(words.collect())
    }

    /// Takes a flag without a value; whether it was there.
    pub fn has(&mut self, flag: &str) -> bool {
        let at = self.0.iter().position(|word| word == flag);
        at.map(|at| self.0.remove(at)).is_some()
    }

    /// Takes a flag and its value.
    pub fn after(&mut self, flag: &str) -> Option<String> {
        let at = self.0.iter().position(|word| word == flag)?;
        self.0.remove(at);
        (at < self.0.len()).then(|| self.0.remove(at))
    }

    /// Takes a flag and its value, which has a default.
    pub fn value<T: Readable>(&mut self, flag: &str, default: &str) -> Outcome<T> {
        Ok(self.after(flag).as_deref().unwrap_or(default).parse()?)
    }

    /// Takes a flag and its list, which has a default.
    pub fn list<T: Readable>(&mut self, flag: &str, default: &str) -> Outcome<Vec<T>> {
        let text = self.after(flag);
        let parts = text.as_deref().unwrap_or(default).split(',');
        Ok(parts.map(str::parse).collect::<Result<_, _>>()?)
    }

    /// Takes the next word.
    pub fn next(&mut self, name: &str) -> Outcome<String> {
        match self.0.first() {
            Some(word) if word.starts_with("--") => Err(format!("unknown flag {word}").into()),
            Some(_) => Ok(self.0.remove(0)),
            None => Err(format!("missing: {name}").into()),
        }
    }

    /// Takes the next word, the file of a table.
    pub fn table(&mut self) -> Outcome<Table> {
        Ok(read_table(Path::new(&self.next("TABLE")?))?)
    }

    /// All other words.
    pub fn rest(mut self) -> Outcome<Vec<String>> {
        (0..self.0.len()).map(|_| self.next("a word")).collect()
    }
}
