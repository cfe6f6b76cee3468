//! The sets that settle: constant shares, and fields; of stripes also the density of points near edges.

use strew_core::{Field, PointSet};

use crate::{Outcome, figures, ground::noise};

/// How the share varies over the plane.
#[derive(Clone, Copy)]
pub enum Kind {
    Constant(f64),
    /// Natural noise of three octaves, the longest of this wavelength. Values of .3 and below are shares of .1, those
    /// of .7 and above 1.
    Noise(f64),
    Stripes(Stripes),
    /// Straight up and down between two shares, each way over a length, with flat parts between.
    Ramp([f64; 2], f64, f64),
}

/// A set to measure.
pub struct Case {
    pub name: String,
    pub kind: Kind,
    /// About its mean share.
    mean: f64,
}

/// Constant shares.
const SHARES: [f64; 12] = [
    0.999, 0.995, 0.99, 0.985, 0.95, 0.9, 0.8, 0.61, 0.3, 0.1, 0.03, THIN,
];
const THIN: f64 = 1.0 / 300.0;

impl Case {
    /// The same share everywhere.
    pub fn constant(share: f64) -> Self {
        Self {
            name: format!("keep {share:.4}"),
            kind: Kind::Constant(share),
            mean: share,
        }
    }

    /// All sets, in the order of docs/quality.md.
    pub fn all() -> Vec<Self> {
        let case = |(name, kind, mean): (&str, Kind, f64)| Self {
            name: name.into(),
            kind,
            mean,
        };
        let stripes = |shares, widths| Kind::Stripes(Stripes { shares, widths });
        let noise = [
            ("noise", Kind::Noise(80.0), 0.55),
            ("steep", Kind::Noise(40.0), 0.55),
            ("rough", Kind::Noise(24.0), 0.55),
        ];
        let [up, down] = [[1.0, 0.06], [0.9, 0.03]];
        let edges = [
            ("edge 1 to 1/16", stripes([1.0, 0.0625], [48.0; 2]), 0.53),
            ("edge .9 to 0", stripes([0.9, 0.0], [48.0; 2]), 0.45),
            ("edge 1/16 to 0", stripes([0.0625, 0.0], [96.0; 2]), 0.031),
            ("road 0 in .3", stripes([0.0, 0.3], [3.0, 29.0]), 0.27),
            ("road 1 in .08", stripes([1.0, 0.08], [3.0, 45.0]), 0.137),
            ("road 1 in .01", stripes([1.0, 0.01], [2.0, 58.0]), 0.043),
            ("ramp 1 to .06 in 30", Kind::Ramp(up, 30.0, 10.0), 0.53),
            ("ramp .9 to .03 in 6", Kind::Ramp(down, 6.0, 20.0), 0.46),
        ];
        let constant = SHARES.map(Self::constant);
        let noise = noise.map(case).into_iter();
        noise.chain(constant).chain(edges.map(case)).collect()
    }

    /// The side of a window that holds about this number of points.
    pub fn side(&self, points: f64) -> f64 {
        let side = (points / self.mean).sqrt();
        match self.kind {
            Kind::Stripes(stripes) => (side / stripes.period()).ceil() * stripes.period(),
            _ => side.round(),
        }
    }

    /// The places along a side of boxes and of windows at which shares are looked up: more where they jump.
    pub const fn looks(&self) -> [usize; 2] {
        match self.kind {
            Kind::Stripes(_) | Kind::Ramp(..) => [64, 768],
            _ => [16, 96],
        }
    }

    /// The set of some points, and its shares. Stripes begin at a place along x.
    pub fn set(&self, all: &PointSet, start: f64) -> Outcome<(PointSet, Box<dyn Field>)> {
        Ok(match self.kind {
            Kind::Constant(share) => {
                let set = all.clone().keep(share)?;
                (set, Box::new(move |_: [f64; 2]| share))
            }
            Kind::Noise(wavelength) => {
                let noise = noise(all.placement().seed.0 + 100, wavelength, 3)?;
                shared(all, noise.curve(vec![[0.3, 0.1], [0.7, 1.0]])?)
            }
            Kind::Stripes(stripes) => shared(all, move |[x, _]: [f64; 2]| stripes.share(x - start)),
            Kind::Ramp([high, low], length, flat) => shared(all, move |[x, _]: [f64; 2]| {
                let x = (x - start).rem_euclid(2.0 * (length + flat));
                let x = x.min(2.0 * (length + flat) - x) - flat / 2.0;
                high + (low - high) * (x / length).clamp(0.0, 1.0)
            }),
        })
    }
}

/// A set in a field, and the field.
fn shared(all: &PointSet, field: impl Field + Clone + 'static) -> (PointSet, Box<dyn Field>) {
    (all.in_field(field.clone()), Box::new(field))
}

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
            figures::row(subject, &bins.map(over));
        }
    }
}
