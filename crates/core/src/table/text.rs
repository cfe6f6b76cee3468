//! The published text form of a table: one vector a line, in grid units.

use core::fmt;

use super::{Table, to_grid_units};

impl Table {
    /// Writes n² lines of `x y` in grid units; row = interval of dY, column = interval of dX. The
    /// digits are the shortest that read back to the same vector.
    ///
    /// # Errors
    /// Whatever `out` answers.
    pub fn write_text(&self, out: &mut impl fmt::Write) -> fmt::Result {
        self.displacements
            .iter()
            .try_for_each(|&[x, y]| writeln!(out, "{} {}", to_grid_units(x), to_grid_units(y)))
    }
}

#[cfg(test)]
mod tests {
    use alloc::{string::String, vec::Vec};

    use crate::table::{Provenance, Table, from_grid_units};

    #[test]
    fn text_reads_back_exactly() {
        let map = crate::Map::new("sqrt(3)".parse().expect("valid"), 3).expect("small");
        let n = map.intervals() * map.intervals();
        let vectors: Vec<[i32; 2]> = (0..n as i32)
            .map(|i| [i.wrapping_mul(7_654_321) % (1 << 26), -3 * i])
            .collect();
        let table = Table::new(map, "blue", vectors.clone(), Provenance::default()).expect("valid");
        let mut text = String::new();
        table.write_text(&mut text).expect("strings do not fail");
        let back: Vec<[i32; 2]> = text
            .lines()
            .map(|line| {
                let mut parts = line
                    .split(' ')
                    .map(|v| from_grid_units(v.parse().expect("number")).expect("short"));
                [parts.next().expect("x"), parts.next().expect("y")]
            })
            .collect();
        assert_eq!(back, vectors);
    }
}
