//! Stripes of two shares, and the density of points near their edges.

use crate::figures;

/// Stripes along y: the first share where x modulo the sum of both widths is below the first width, else the second.
#[derive(Clone, Copy)]
pub struct Stripes {
    pub shares: [f64; 2],
    pub widths: [f64; 2],
}

impl Stripes {
    pub fn period(&self) -> f64 {
        self.widths[0] + self.widths[1]
    }

    pub fn share(&self, x: f64) -> f64 {
        self.shares[usize::from(x.rem_euclid(self.period()) >= self.widths[0])]
    }

    /// The distance from the nearest edge in local spacings: below 0 outside.
    fn edge_distance(&self, x: f64) -> f64 {
        let (x, [width, _]) = (x.rem_euclid(self.period()), self.widths);
        let [inside, outside] = self.shares;
        if x < width {
            return x.min(width - x) * inside.sqrt();
        }
        // Where there is nothing, distances are those of the other side.
        let local = if outside > 0.0 { outside } else { inside };
        -(x - width).min(self.period() - x) * local.sqrt()
    }
}

/// Counts by half local spacings from an edge, and what the shares let expect: outside, then inside.
#[derive(Default)]
pub struct Profile([[[f64; 2]; 6]; 2]);

impl Profile {
    pub fn add(&mut self, stripes: Stripes, side: f64, points: &[[f64; 2]]) {
        const LOOKS: usize = 100_000;
        let mut add = |x: f64, [found, expected]: [f64; 2]| {
            let far = stripes.edge_distance(x);
            let bins = &mut self.0[usize::from(far >= 0.0)];
            if let Some(sum) = bins.get_mut((far.abs() * 2.0) as usize) {
                *sum = [sum[0] + found, sum[1] + expected];
            }
        };
        for p in points {
            add(p[0], [1.0, 0.0]);
        }
        for i in 0..LOOKS {
            let x = (i as f64 + 0.5) / LOOKS as f64 * stripes.period();
            add(x, [0.0, stripes.share(x) * side * side / LOOKS as f64]);
        }
    }

    /// Prints the density over the share, or the number of points where none are expected.
    pub fn print(&self, name: &str) {
        if self.0.as_flattened().iter().all(|sum| sum[1] == 0.0) {
            return;
        }
        let over = |[found, expected]: [f64; 2]| match expected > 0.0 {
            true => found / expected,
            false => found,
        };
        for (place, bins) in ["outside", "inside"].iter().zip(&self.0) {
            let subject = format!("{name}, {place}");
            println!("{}", figures::row(subject, &bins.map(over)));
        }
    }
}
