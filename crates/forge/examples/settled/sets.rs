//! The sets to measure: constant shares, and fields.

use std::{error::Error, sync::Arc};

use strew_core::{
    Field, PointSet, Region,
    field::{FieldSpec, Noise},
};

/// A field to share between sets.
#[derive(Clone)]
pub struct Shares(Arc<dyn Field>);

impl Shares {
    fn new(field: impl Field + 'static) -> Self {
        Self(Arc::new(field))
    }
}

impl Field for Shares {
    fn share(&self, at: [f64; 2]) -> f64 {
        self.0.share(at)
    }

    fn shares(&self, places: &[[f64; 2]], shares: &mut [f64]) {
        self.0.shares(places, shares);
    }

    fn bounds(&self, within: &Region) -> [f64; 2] {
        self.0.bounds(within)
    }

    fn slopes(&self, within: &Region) -> [f64; 2] {
        self.0.slopes(within)
    }
}

/// A part of some shares: those of a kind.
pub struct Part<'a>(pub &'a Shares, pub f64);

impl Field for Part<'_> {
    fn share(&self, at: [f64; 2]) -> f64 {
        self.0.share(at) * self.1
    }

    fn shares(&self, places: &[[f64; 2]], shares: &mut [f64]) {
        self.0.shares(places, shares);
        for share in shares {
            *share *= self.1;
        }
    }

    fn bounds(&self, within: &Region) -> [f64; 2] {
        self.0.bounds(within).map(|share| share * self.1)
    }
}

/// Stripes along y: `inside` where x modulo `period` is below `width`, else `outside`.
#[derive(Clone, Copy)]
pub struct Stripes {
    pub period: f64,
    pub width: f64,
    pub inside: f64,
    pub outside: f64,
}

impl Stripes {
    fn share(&self, x: f64) -> f64 {
        match x.rem_euclid(self.period) < self.width {
            true => self.inside,
            false => self.outside,
        }
    }

    /// The distance from the nearest edge in local spacings, with the share there: below 0 outside.
    pub fn edge_distance(&self, x: f64) -> (f64, f64) {
        let x = x.rem_euclid(self.period);
        if x < self.width {
            return (x.min(self.width - x) * self.inside.sqrt(), self.inside);
        }
        let far = (x - self.width).min(self.period - x);
        // Where there is nothing, distances are those of the other side.
        let local = if self.outside > 0.0 {
            self.outside
        } else {
            self.inside
        };
        (-far * local.sqrt(), self.outside)
    }
}

/// How the share varies over the plane.
#[derive(Clone, Copy)]
pub enum Kind {
    Constant(f64),
    /// Natural noise of three octaves, the longest of this wavelength. Values of .3 and below are shares of .1, those
    /// of .7 and above 1.
    Noise(f64),
    Stripes(Stripes),
    /// Straight up and down between two shares, each way over a length, with flat parts between.
    Ramp {
        shares: [f64; 2],
        length: f64,
        flat: f64,
    },
}

/// A set to measure.
pub struct Case {
    pub name: String,
    pub kind: Kind,
    /// About its mean share.
    mean: f64,
}

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
        let case = |name: &str, kind: Kind, mean: f64| Self {
            name: name.to_owned(),
            kind,
            mean,
        };
        let stripes = |period, width, inside, outside| {
            Kind::Stripes(Stripes {
                period,
                width,
                inside,
                outside,
            })
        };
        let ramp = |shares, length, flat| Kind::Ramp {
            shares,
            length,
            flat,
        };
        let mut all = vec![
            case("noise", Kind::Noise(80.0), 0.55),
            case("steep", Kind::Noise(40.0), 0.55),
            case("rough", Kind::Noise(24.0), 0.55),
        ];
        let constant = [
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
        all.extend(constant.map(Self::constant));
        all.extend([
            case("edge 1|1/16", stripes(96.0, 48.0, 1.0, 1.0 / 16.0), 0.53),
            case("edge .9|0", stripes(96.0, 48.0, 0.9, 0.0), 0.45),
            case("edge 1/16|0", stripes(192.0, 96.0, 1.0 / 16.0, 0.0), 0.031),
            case("road 0 in .3", stripes(32.0, 3.0, 0.0, 0.3), 0.27),
            case("road 1 in .08", stripes(48.0, 3.0, 1.0, 0.08), 0.137),
            case("road 1 in .01", stripes(60.0, 2.0, 1.0, 0.01), 0.043),
            case("ramp 1 to .06 in 30", ramp([1.0, 0.06], 30.0, 10.0), 0.53),
            case("ramp .9 to .03 in 6", ramp([0.9, 0.03], 6.0, 20.0), 0.46),
        ]);
        all
    }

    /// The side of a window that holds about this number of points.
    pub fn side(&self, points: f64) -> f64 {
        let side = (points / self.mean).sqrt();
        match self.kind {
            Kind::Stripes(stripes) => (side / stripes.period).ceil() * stripes.period,
            _ => side.round(),
        }
    }

    /// Whether the share jumps.
    pub const fn has_edges(&self) -> bool {
        matches!(self.kind, Kind::Stripes(_) | Kind::Ramp { .. })
    }

    /// The set by a seed, and its shares. Stripes begin at a place along x.
    pub fn set(
        &self,
        all: &PointSet,
        seed: u64,
        start: f64,
    ) -> Result<(PointSet, Shares), Box<dyn Error>> {
        let all = all.clone().seed(seed);
        let shares = match self.kind {
            Kind::Constant(share) => {
                return Ok((all.keep(share)?, Shares::new(move |_: [f64; 2]| share)));
            }
            Kind::Noise(wavelength) => Shares::new(
                FieldSpec::noise(Noise {
                    seed: seed + 100,
                    wavelength,
                    octaves: 3,
                    range: [0.0, 1.0],
                })?
                .curve(vec![[0.3, 0.1], [0.7, 1.0]])?,
            ),
            Kind::Stripes(stripes) => Shares::new(move |[x, _]: [f64; 2]| stripes.share(x - start)),
            Kind::Ramp {
                shares: [high, low],
                length,
                flat,
            } => Shares::new(move |[x, _]: [f64; 2]| {
                let x = (x - start).rem_euclid(2.0 * (length + flat));
                let x = x.min(2.0 * (length + flat) - x) - flat / 2.0;
                high + (low - high) * (x / length).clamp(0.0, 1.0)
            }),
        };
        Ok((all.in_field(shares.clone()), shares))
    }
}
