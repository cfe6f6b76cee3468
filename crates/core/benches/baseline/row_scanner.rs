//! The row scanner as the papers describe it, implemented as a baseline. It walks the grid row by
//! row. In a row whose dY is inside the set region, it walks the columns, updates dX by addition,
//! tests it, looks up the block by the index and adds the displacement.

use strew_core::Table;

/// Cells per axis of index space, for looking up an interval.
const CELLS: usize = 4096;

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
        let (mut written, mut total) = (0, 0u64);
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
                    block[written] = [(x as f32 + u) * self.scale, (y as f32 + v) * self.scale];
                    written += 1;
                    if written == block.len() {
                        std::hint::black_box(&mut *block);
                        total += written as u64;
                        written = 0;
                    }
                }
                dx = dx.wrapping_add(self.half.wrapping_mul(2));
                x += 2;
            }
        }
        total + written as u64
    }
}
