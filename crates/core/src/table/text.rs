//! The text form in which tables are published: one vector a line, in grid units; row = interval of
//! dY, column = interval of dX.

use alloc::{format, string::String, vec::Vec};
use core::fmt;

use super::{MAX_DISPLACEMENT, Provenance, Table, from_grid_units, to_grid_units};
use crate::{
    error::{Error, ErrorKind, shown},
    map::Map,
};

impl Table {
    /// Writes n² lines of `x y`. The digits are the shortest that read back to the same vector.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_text(&self, out: &mut impl fmt::Write) -> fmt::Result {
        self.displacements()
            .iter()
            .try_for_each(|&[x, y]| writeln!(out, "{} {}", to_grid_units(x), to_grid_units(y)))
    }

    /// Reads n² lines of `x y` for a map, skipping blank ones. Vectors are rounded to the nearest
    /// fixed-point place, so the output of [`write_text`](Self::write_text) reads back exactly.
    ///
    /// # Errors
    /// [`ErrorKind::TableText`] naming the line that is wrong, or as [`new`](Self::new).
    ///
    /// ```
    /// use strew_core::{ErrorKind, Map, Table};
    ///
    /// let map = Map::new("sqrt(3)".parse()?, 0)?;
    /// let n = map.intervals();
    /// let table = Table::from_text(map.clone(), "mine", &"0.5 -0.25\n".repeat(n * n))?;
    /// assert_eq!(table.displacements()[0], [1 << 19, -1 << 18]);
    /// let error = Table::from_text(map, "mine", "0.5 north").unwrap_err();
    /// assert_eq!((error.kind(), error.field()), (ErrorKind::TableText, "line 1 of the text"));
    /// # Ok::<(), strew_core::Error>(())
    /// ```
    pub fn from_text(map: Map, profile: &str, text: &str) -> Result<Self, Error> {
        let blocks = map.intervals() * map.intervals();
        let mut vectors = Vec::with_capacity(blocks.min(text.len()));
        let lines = text
            .lines()
            .enumerate()
            .map(|(i, line)| (i + 1, line.trim()));
        for (number, line) in lines.filter(|(_, line)| !line.is_empty()) {
            if vectors.len() == blocks {
                let problem = format!("beyond the last of {blocks} vectors");
                return Err(wrong(number, problem));
            }
            let vector = read_vector(line).map_err(|problem| wrong(number, problem))?;
            vectors.push(vector);
        }
        if vectors.len() < blocks {
            let n = map.intervals();
            let problem = format!(
                "the text ends after {} of {n}² = {blocks} vectors",
                vectors.len()
            );
            return Err(wrong(text.lines().count(), problem));
        }
        let provenance = Provenance {
            optimizer: "imported".into(),
            ..Provenance::default()
        };
        Self::new(map, profile, vectors, provenance)
    }
}

/// The error of a line, counted from 1.
fn wrong(line: usize, problem: String) -> Error {
    let field = format!("line {line} of the text");
    Error::new(ErrorKind::TableText, field, "not valid", "").because(problem)
}

fn read_vector(line: &str) -> Result<[i32; 2], String> {
    let mut parts = line
        .split(|c: char| c.is_whitespace() || c == ',')
        .filter(|part| !part.is_empty());
    let mut next = |axis: &str| {
        let part = parts.next().ok_or_else(|| format!("{axis} is missing"))?;
        let shown = shown(part);
        let value: f64 = part
            .parse()
            .map_err(|_| format!("{axis} is `{shown}`, not a number"))?;
        from_grid_units(value).ok_or_else(|| {
            format!("{axis} is {shown}; allowed: less than {MAX_DISPLACEMENT} grid units")
        })
    };
    let vector = [next("x")?, next("y")?];
    match parts.next() {
        None => Ok(vector),
        Some(_) => Err("more than two numbers".into()),
    }
}

#[cfg(test)]
mod tests {
    use alloc::{string::String, vec::Vec};

    use super::*;

    fn map() -> Map {
        Map::new("sqrt(3)".parse().expect("valid"), 3).expect("small")
    }

    fn table() -> Table {
        let n = map().intervals() * map().intervals();
        let vectors: Vec<[i32; 2]> = (0..n as i32)
            .map(|i| [i.wrapping_mul(7_654_321) % (1 << 26), -3 * i])
            .collect();
        Table::new(map(), "blue", vectors, Provenance::default()).expect("valid")
    }

    fn text(table: &Table) -> String {
        let mut text = String::new();
        table.write_text(&mut text).expect("strings do not fail");
        text
    }

    #[test]
    fn text_reads_back_exactly() {
        let back = Table::from_text(map(), "blue", &text(&table())).expect("valid");
        assert_eq!(back.displacements(), table().displacements());
        assert_eq!(text(&back), text(&table()));
    }

    #[test]
    fn published_decimals_are_rounded_to_the_nearest_place() {
        let line = "  -1.25\t0.3333333333 \r\n\n";
        let n = map().intervals() * map().intervals();
        let read = Table::from_text(map(), "blue", &line.repeat(n)).expect("valid");
        assert_eq!(read.displacements()[0], [-5 << 18, 349_525]);
    }

    #[test]
    fn errors_name_the_line() {
        let good = text(&table());
        let lines = good.lines().count();
        for (bad, line, says) in [
            (good.replacen(' ', " x", 1), 1, "y is `x"),
            (good.replacen(' ', "", 1), 1, "missing"),
            (format!("1 2 3\n{good}"), 1, "more than two"),
            (format!("NaN 0\n{good}"), 1, "less than"),
            (format!("0 1e300\n{good}"), 1, "less than"),
            (format!("{good}0 0\n"), lines + 1, "beyond the last"),
            (
                good.lines().skip(2).map(|l| format!("{l}\n")).collect(),
                lines - 2,
                "ends after",
            ),
            (String::new(), 0, "ends after 0"),
        ] {
            let error = Table::from_text(map(), "blue", &bad).expect_err(says);
            assert_eq!(error.kind(), ErrorKind::TableText);
            assert_eq!(error.field(), format!("line {line} of the text"));
            assert!(error.problem().contains(says), "{error}");
        }
    }
}
