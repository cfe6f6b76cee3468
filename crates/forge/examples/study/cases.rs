//! The sets that settle: constant shares, and fields.

use strew_core::{
    Field, PointSet,
    field::{FieldSpec, Noise},
};

use crate::{Outcome, stripes::Stripes};

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
    0.999,
    0.995,
    0.99,
    0.985,
    0.95,
    0.9,
    0.8,
    0.61,
    0.3,
    0.1,
    0.03,
    1.0 / 300.0,
];

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
            (
                "edge 1 to 1/16",
                stripes([1.0, 1.0 / 16.0], [48.0; 2]),
                0.53,
            ),
            ("edge .9 to 0", stripes([0.9, 0.0], [48.0; 2]), 0.45),
            (
                "edge 1/16 to 0",
                stripes([1.0 / 16.0, 0.0], [96.0; 2]),
                0.031,
            ),
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

    /// Whether the share jumps.
    pub const fn has_edges(&self) -> bool {
        matches!(self.kind, Kind::Stripes(_) | Kind::Ramp(..))
    }

    /// The set of some points, and its shares. Stripes begin at a place along x.
    pub fn set(&self, all: &PointSet, start: f64) -> Outcome<(PointSet, Box<dyn Field>)> {
        Ok(match self.kind {
            Kind::Constant(share) => {
                let set = all.clone().keep(share)?;
                (set, Box::new(move |_: [f64; 2]| share))
            }
            Kind::Noise(wavelength) => {
                let noise = FieldSpec::noise(Noise {
                    seed: all.placement().seed.0 + 100,
                    wavelength,
                    octaves: 3,
                    range: [0.0, 1.0],
                })?;
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
