//! Studies: what the documentation reports of points, measured and drawn again.
//!
//! `cargo run --release -p strew-forge --example study -- SUBCOMMAND …`. Without a subcommand it prints them all, with
//! their arguments. Figures are printed as tables in Markdown. Lists have commas: `--seeds 11,29`.

mod cases;
mod comparison;
mod darts;
mod figures;
mod ground;
mod local;
mod masks;
mod paint;
mod pictures;
mod settled;
mod stipple;
mod varying;

use std::{env, error::Error, path::Path, str::FromStr};

use strew_core::Table;
use strew_forge::read_table;

/// The result of a study.
type Outcome<T = ()> = Result<T, Box<dyn Error>>;

const USAGE: &str = "\
comparison
masks TABLE [PICTURE.png]
settled TABLE [--sets NAME | --share SHARE] [--steps 0,1,2,3,4] [--seeds 11,29,58] [--points 50000]
    [--at 7300000,-5100000] [--mix SHARES]
stipple [--steps 0,2,3,4] [--points 5000] [--seeds 1,2,3,4,5] [--draw FOLDER]
varying TABLE
wei [--points 7000] [SHARES…]";

fn main() -> Outcome {
    let mut arguments = Arguments(env::args().skip(1).collect());
    let study = match arguments.next("SUBCOMMAND").unwrap_or_default().as_str() {
        "comparison" => comparison::study,
        "masks" => masks::study,
        "settled" => settled::study,
        "stipple" => stipple::study,
        "varying" => varying::study,
        "wei" => darts::study,
        _ => {
            println!("{USAGE}");
            return Err("which study?".into());
        }
    };
    study(arguments)
}

/// A value that is read from text.
pub trait Readable: FromStr<Err: Error + 'static> {}

impl<T: FromStr<Err: Error + 'static>> Readable for T {}

/// Flags are taken out first; what is left are words.
pub struct Arguments(Vec<String>);

impl Arguments {
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
