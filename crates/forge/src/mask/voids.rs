//! Voids and clusters of pixels on a torus, and the order of few pixels, farther apart than the kernel reaches.
//!
//! The energy of a pixel is the sum of a kernel over the pixels that are on. The kernel is (1 − d²/r²)¹⁶ with
//! r² = 72, which is near the Gaussian of σ = 1.5 pixels that void and cluster needs, by plain arithmetic. The best
//! pixel of each block of pixels is kept, so a step looks at few pixels but those whose energy changes.
//!
//! Few pixels push each other with 1/d⁴ of the distance d. The one that is pushed most leaves first, so those that are left are
//! spread at every number. Pushes are integers, too, so an order is the same on every machine.

/// The push at distance 1. Those of all pixels of a plane together are about 6 times as much, below 2⁶⁴.
const UNIT: f64 = (1u64 << 60) as f64;

pub(super) type Look<'a> = &'a mut dyn FnMut(usize) -> bool;

/// The pixels of a square of a side, in an order in which all the first ones are spread; fewer if it is stopped.
pub(super) fn few_ordered(size: usize, pixels: &[usize], goes_on: Look<'_>) -> Vec<usize> {
    let pushed = pixels.iter().take_while(|_| goes_on(1));
    let pushes = pushed.map(|&pixel| {
        let others = pixels.iter().filter(|&&other| other != pixel);
        (others.map(|&other| push(size, pixel, other)).sum(), pixel)
    });
    let mut left: Vec<(u64, usize)> = pushes.collect();
    let mut order = vec![];
    let highest = |left: &[(u64, usize)]| (0..left.len()).max_by_key(|&i| left[i]);
    while let Some(most) = highest(&left).filter(|_| goes_on(1)) {
        let (_, pixel) = left.swap_remove(most);
        for (pushed, other) in &mut left {
            *pushed -= push(size, pixel, *other);
        }
        order.push(pixel);
    }
    order.reverse();
    order
}

/// The push between two pixels.
fn push(size: usize, a: usize, b: usize) -> u64 {
    let apart = |a: usize, b: usize| a.abs_diff(b).min(size - a.abs_diff(b));
    let [x, y] = [apart(a % size, b % size), apart(a / size, b / size)];
    let squared = (x * x + y * y) as f64;
    (UNIT / (squared * squared)) as u64
}

/// The squared radius of the kernel, and the largest offset within it.
const SQUARED: i64 = 72;
const REACH: i64 = 8;
/// The side of a block.
const BLOCK: usize = 8;

/// The rule for the pixel that is flipped next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Choice {
    /// The one that is on in the tightest cluster: it goes off.
    Clusters,
    /// The one that is off in the largest void: it goes on.
    Voids,
}

pub(super) struct Voids {
    size: usize,
    choice: Choice,
    is_on: Vec<bool>,
    energies: Vec<u32>,
    /// The weights of offsets, row by row.
    kernel: Vec<u32>,
    /// Blocks along a side.
    blocks: usize,
    /// The best pixel of each block with how good it is, if it has any.
    best: Vec<Option<(u32, usize)>>,
    /// The best of each row of blocks.
    best_of_rows: Vec<Option<(u32, usize)>>,
}

/// The better one of two; the first of equals.
fn better(a: (u32, usize), b: (u32, usize)) -> (u32, usize) {
    if b.0 > a.0 { b } else { a }
}

impl Voids {
    /// A square of pixels of which some are on.
    pub(super) fn new(size: usize, on: &[usize]) -> Self {
        let blocks = size.div_ceil(BLOCK);
        let mut voids = Self {
            size,
            choice: Choice::Voids,
            is_on: vec![false; size * size],
            energies: vec![0; size * size],
            kernel: kernel(),
            blocks,
            best: vec![None; blocks * blocks],
            best_of_rows: vec![None; blocks],
        };
        for &pixel in on {
            voids.is_on[pixel] = true;
            voids.add(pixel, u32::wrapping_add);
        }
        voids
    }

    /// The pixels that are on, or off.
    pub(super) fn those(&self, is_on: bool) -> Vec<usize> {
        (0..self.is_on.len())
            .filter(|&pixel| self.is_on[pixel] == is_on)
            .collect()
    }

    /// Begins to flip pixels of a kind.
    pub(super) fn choose(&mut self, choice: Choice) {
        self.choice = choice;
        for block in 0..self.best.len() {
            self.renew(block);
        }
        for row in 0..self.blocks {
            self.renew_row(row);
        }
    }

    /// Finds the best of a row of blocks anew.
    fn renew_row(&mut self, row: usize) {
        let blocks = &self.best[row * self.blocks..][..self.blocks];
        self.best_of_rows[row] = blocks.iter().flatten().copied().reduce(better);
    }

    /// Flips the best pixel and returns it; of equally good ones, the first of the first block.
    pub(super) fn flip(&mut self) -> usize {
        let best = self.best_of_rows.iter().flatten().copied().reduce(better);
        let pixel = best.map_or(0, |(_, pixel)| pixel);
        self.is_on[pixel] = self.choice == Choice::Voids;
        match self.choice {
            Choice::Clusters => self.add(pixel, u32::wrapping_sub),
            Choice::Voids => self.add(pixel, u32::wrapping_add),
        }
        let touched = |at: usize| {
            let blocks = (-REACH..=REACH).map(|i| self.moved(at, i) / BLOCK);
            let mut blocks: Vec<usize> = blocks.collect();
            blocks.sort_unstable();
            blocks.dedup();
            blocks
        };
        let (columns, rows) = (touched(pixel % self.size), touched(pixel / self.size));
        for row in rows {
            for column in &columns {
                self.renew(row * self.blocks + column);
            }
            self.renew_row(row);
        }
        pixel
    }

    /// A coordinate moved by an offset, on the torus.
    fn moved(&self, at: usize, offset: i64) -> usize {
        (at as i64 + offset).rem_euclid(self.size as i64) as usize
    }

    /// Changes the energies around a pixel.
    fn add(&mut self, pixel: usize, change: fn(u32, u32) -> u32) {
        let (x, y) = (pixel % self.size, pixel / self.size);
        let mut weights = 0;
        for j in -REACH..=REACH {
            let row = self.moved(y, j) * self.size;
            for i in -REACH..=REACH {
                let energy = row + self.moved(x, i);
                self.energies[energy] = change(self.energies[energy], self.kernel[weights]);
                weights += 1;
            }
        }
    }

    /// Finds the best pixel of a block again.
    fn renew(&mut self, block: usize) {
        let (left, top) = (block % self.blocks * BLOCK, block / self.blocks * BLOCK);
        let mut best: Option<(u32, usize)> = None;
        for y in top..(top + BLOCK).min(self.size) {
            for pixel in y * self.size + left..y * self.size + (left + BLOCK).min(self.size) {
                let good = match self.choice {
                    Choice::Clusters if self.is_on[pixel] => self.energies[pixel],
                    Choice::Voids if !self.is_on[pixel] => u32::MAX - self.energies[pixel],
                    _ => continue,
                };
                if best.is_none_or(|(other, _)| good > other) {
                    best = Some((good, pixel));
                }
            }
        }
        self.best[block] = best;
    }
}

/// The weights of offsets, row by row. All of them together stay far below 2³².
fn kernel() -> Vec<u32> {
    let offsets = (-REACH..=REACH).flat_map(|j| (-REACH..=REACH).map(move |i| i * i + j * j));
    let weight = |squared: i64| {
        if squared >= SQUARED {
            return 0;
        }
        let mut v = 1.0 - squared as f64 / SQUARED as f64;
        for _ in 0..4 {
            v *= v;
        }
        (v * f64::from(1u32 << 24)) as u32
    };
    offsets.map(weight).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_one_is_pushed_most_by_those_before_it() {
        let size = 40;
        let pixels: Vec<usize> = (0..size * size).step_by(37).collect();
        let order = few_ordered(size, &pixels, &mut |_| true);
        for count in 1..=order.len() {
            let first = &order[..count];
            let pushed = |pixel: usize| -> u64 {
                let others = first.iter().filter(|&&other| other != pixel);
                others.map(|&other| push(size, pixel, other)).sum()
            };
            let most = first.iter().map(|&pixel| pushed(pixel)).max();
            assert_eq!(most, Some(pushed(order[count - 1])), "{count}");
        }
        let mut sorted = order;
        sorted.sort_unstable();
        assert_eq!(sorted, pixels);
    }

    #[test]
    fn pushes_wrap_and_do_not_overflow() {
        assert_eq!(push(20, 0, 19), 1 << 60);
        assert_eq!(push(20, 21, 19 * 20 + 19), 1 << 54);
        let all: Vec<usize> = (0..400).collect();
        assert_eq!(few_ordered(20, &all, &mut |_| true).len(), 400);
    }

    #[test]
    fn each_step_flips_the_best_of_all_pixels() {
        for size in [16, 21, 40] {
            let on: Vec<usize> = (0..size * size).step_by(11).collect();
            for choice in [Choice::Clusters, Choice::Voids] {
                let mut voids = Voids::new(size, &on);
                voids.choose(choice);
                let steps = match choice {
                    Choice::Clusters => on.len(),
                    Choice::Voids => size * size - on.len(),
                };
                for _ in 0..steps {
                    let (energies, is_on) = (voids.energies.clone(), voids.is_on.clone());
                    let free =
                        (0..size * size).filter(|&p| is_on[p] == (choice == Choice::Clusters));
                    let energies_of_free = free.map(|p| energies[p]);
                    let best = match choice {
                        Choice::Clusters => energies_of_free.max(),
                        Choice::Voids => energies_of_free.min(),
                    };
                    let pixel = voids.flip();
                    assert_eq!(Some(energies[pixel]), best);
                    assert_ne!(voids.is_on[pixel], is_on[pixel]);
                }
            }
        }
    }

    #[test]
    fn energies_are_sums_of_the_kernel_on_the_torus() {
        let on = [0, 5, 17 * 20 + 19];
        let voids = Voids::new(20, &on);
        let kernel = kernel();
        for pixel in 0..400usize {
            let mut sum = 0;
            for other in on {
                for j in -REACH..=REACH {
                    for i in -REACH..=REACH {
                        let x = (other as i64 % 20 + i).rem_euclid(20);
                        let y = (other as i64 / 20 + j).rem_euclid(20);
                        if y * 20 + x == pixel as i64 {
                            sum += kernel[((j + REACH) * (2 * REACH + 1) + i + REACH) as usize];
                        }
                    }
                }
            }
            assert_eq!(voids.energies[pixel], sum);
        }
        let all: u64 = kernel.iter().map(|&v| u64::from(v)).sum();
        assert!(all < 1 << 32);
    }
}
