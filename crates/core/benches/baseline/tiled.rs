//! Tiled lookup: one toroidal tile of points, repeated over the plane. A spatial grid finds the
//! points of the part of the tile that a region covers.

/// A tile of prepared points.
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
        let (mut written, mut total) = (0, 0);
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
                        block[written] = at;
                        written += 1;
                        if written == block.len() {
                            std::hint::black_box(&mut *block);
                            total += written as u64;
                            written = 0;
                        }
                    }
                }
            }
        }
        total + written as u64
    }
}
