//! Other ways to make points, to compare with.

#![allow(dead_code, reason = "each bench takes what it needs")]

use strew_core::Table;

use crate::rounds::Output;

/// Cells per axis of index space, for looking up an interval.
const CELLS: usize = 4096;

/// The row scanner as the papers describe it. It walks the grid row by row. In a row whose dY is inside the set
/// region, it walks the columns, updates dX by addition, tests it, looks up the block by the index and adds the
/// displacement.
pub struct RowScanner {
    half: u64,
    side: u64,
    scale: f32,
    /// The interval of each cell of the set region.
    interval: Vec<u8>,
    shift: u32,
    displacements: Vec<[f32; 2]>,
    n: usize,
}

impl RowScanner {
    pub fn new(table: &Table) -> Self {
        let (map, alpha) = (table.map(), table.alpha());
        let side = alpha.set_side();
        let shift = 64 - side.leading_zeros() - CELLS.trailing_zeros();
        let interval = (0..=side >> shift)
            .map(|cell| {
                map.interval_of((cell << shift).min(side - 1))
                    .expect("inside") as u8
            })
            .collect();
        let displacements = table
            .displacements()
            .iter()
            .map(|d| d.map(|v| strew_core::table::to_grid_units(v) as f32))
            .collect();
        Self {
            half: alpha.half(),
            side,
            scale: alpha.set_side_f64() as f32,
            interval,
            shift,
            displacements,
            n: map.intervals(),
        }
    }

    /// Scans a square of `side` mean spacings into a reused block. Returns the number of points.
    pub fn scan(&self, side: f64, block: &mut [[f32; 2]]) -> u64 {
        let cells = (side / f64::from(self.scale)) as u64;
        let mut output = Output::new(block);
        for y in 0..cells {
            let even = self.half.wrapping_mul(y);
            let (parity, dy) = match (even, even ^ (1 << 63)) {
                (dy, _) if dy < self.side => (0, dy),
                (_, dy) if dy < self.side => (1, dy),
                _ => continue,
            };
            let row =
                &self.displacements[self.interval[(dy >> self.shift) as usize] as usize * self.n..];
            let mut dx = self.half.wrapping_mul(parity).wrapping_add((y & 1) << 63);
            let mut x = parity;
            while x < cells {
                if dx < self.side {
                    let [u, v] = row[self.interval[(dx >> self.shift) as usize] as usize];
                    output.push([(x as f32 + u) * self.scale, (y as f32 + v) * self.scale]);
                }
                dx = dx.wrapping_add(self.half.wrapping_mul(2));
                x += 2;
            }
        }
        output.total()
    }
}

/// Fills a square of `side` × `side` cells of unit area with a hashed jittered grid: one point per cell, moved by a
/// hash of the cell. Most programs that need random access do this; its noise is poor. Returns the number of points.
pub fn jittered(side: u32, seed: u32, block: &mut [[f32; 2]]) -> u64 {
    let mut output = Output::new(block);
    for y in 0..side {
        for x in 0..side {
            let hash = hash(x, y, seed);
            let [u, v] = [hash as u32, (hash >> 32) as u32].map(|h| (h >> 8) as f32 / 16_777_216.0);
            output.push([x as f32 + u, y as f32 + v]);
        }
    }
    output.total()
}

/// Two rounds of multiply and shift, the least that looks random.
fn hash(x: u32, y: u32, seed: u32) -> u64 {
    let mut h = (u64::from(y) << 32 | u64::from(x)) ^ (u64::from(seed) << 16);
    h = (h ^ (h >> 31)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    h = (h ^ (h >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h ^ (h >> 32)
}

/// One toroidal tile of prepared points, repeated over the plane. A spatial grid finds the points of the part of the
/// tile that a region covers.
pub struct Tile {
    side: f32,
    /// Cells per axis.
    cells: usize,
    /// The index of each cell's first point, then the number of points.
    starts: Vec<u32>,
    points: Vec<[f32; 2]>,
}

impl Tile {
    /// A tile of points in the square [0, `side`)², with about four points per cell.
    pub fn new(side: f32, points: &[[f32; 2]]) -> Self {
        let cells = ((points.len() / 4) as f32).sqrt().max(1.0) as usize;
        let cell = |p: &[f32; 2]| {
            let along = |v: f32| ((v / side * cells as f32) as usize).min(cells - 1);
            along(p[1]) * cells + along(p[0])
        };
        let mut sorted = points.to_vec();
        sorted.sort_by_key(|p| cell(p));
        let starts = (0..=cells * cells).map(|c| sorted.partition_point(|p| cell(p) < c) as u32);
        Self {
            side,
            cells,
            starts: starts.collect(),
            points: sorted,
        }
    }

    /// Writes the points of the square [0, `side`)². Returns the number of points.
    pub fn fill(&self, side: f32, block: &mut [[f32; 2]]) -> u64 {
        let mut output = Output::new(block);
        let tiles = (side / self.side).ceil() as usize;
        let cell = self.side / self.cells as f32;
        for row in 0..tiles * self.cells {
            if row as f32 * cell >= side {
                break;
            }
            let y = (row / self.cells) as f32 * self.side;
            let row_start = row % self.cells * self.cells;
            for tile in 0..tiles {
                let x = tile as f32 * self.side;
                let wanted = ((side - x) / cell).ceil().min(self.cells as f32) as usize;
                let ends = [row_start, row_start + wanted].map(|c| self.starts[c] as usize);
                let is_inner = x + self.side <= side && (row + 1) as f32 * cell <= side;
                for p in &self.points[ends[0]..ends[1]] {
                    let at = [p[0] + x, p[1] + y];
                    if is_inner || at[0] < side && at[1] < side {
                        output.push(at);
                    }
                }
            }
        }
        output.total()
    }
}
