//! The order of few pixels on a torus, farther apart than the kernel of [`super::voids`] reaches.
//!
//! Every pixel pushes every other one with 1/d⁴ of the distance d. The one that is pushed most leaves first, so
//! those that are left are spread at every number. The pushes are integers, so an order is the same on every
//! machine.

/// The push at distance 1. Those of all pixels of a plane together are about 6 times as much, below 2⁶⁴.
const UNIT: f64 = (1u64 << 60) as f64;

/// The pixels of a square of a side, in an order in which all the first ones are spread.
pub(super) fn ordered(size: usize, pixels: &[usize]) -> Vec<usize> {
    let pushes = pixels.iter().map(|&pixel| {
        let others = pixels.iter().filter(|&&other| other != pixel);
        (others.map(|&other| push(size, pixel, other)).sum(), pixel)
    });
    let mut left: Vec<(u64, usize)> = pushes.collect();
    let mut order = vec![];
    while let Some(most) = (0..left.len()).max_by_key(|&i| left[i]) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_one_is_pushed_most_by_those_before_it() {
        let size = 40;
        let pixels: Vec<usize> = (0..size * size).step_by(37).collect();
        let order = ordered(size, &pixels);
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
        assert_eq!(ordered(20, &all).len(), 400);
    }
}
