//! A noise profile, and its recipe: the parameters of an optimizer, and the phases in which it runs.

use std::slice;

use crate::{
    curve::Target,
    energy::{Gaussian, Guard, Lloyd},
    judge::Bound,
    optimize::{Descent, Objective, Pairs, Radial, RadialWeights, Sets},
    twins::Domain,
    watch::Phase,
};

/// A noise profile: how its tables are optimized, and what they must satisfy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// The name, which table files record.
    pub name: &'static str,
    pub summary: &'static str,
    /// The way in which the tables are optimized.
    pub recipe: Recipe,
    /// The half-width, in mean spacings, of the square that the vectors of the random start fill.
    pub jitter: f64,
    /// The default number of optimizer steps.
    pub steps: u32,
    /// The bounds that the figures of every unseen point set must satisfy.
    pub bounds: &'static [Bound],
}

impl Profile {
    /// The radial power curve that the profile follows, if any.
    pub fn target(&self) -> Option<Target> {
        match self.recipe {
            Recipe::Radial(following) => following.curve.replace(';', "\n").parse().ok(),
            _ => None,
        }
    }
}

/// The way in which the tables of a profile are optimized. Lengths are in mean spacings, rates in mean spacings moved per
/// unit of gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Recipe {
    /// Gaussian repulsion with a [`Guard`] against close pairs, in two phases.
    Gaussian(Repulsion),
    /// Push and pull in table space, after Ahmed, Guo, Yan, Franceschi, Zhang, Deussen (2017).
    ///
    /// A [`Guard`] that hardens from stage to stage pushes pairs in conflict apart. A Gaussian assigns
    /// every point its share of the plane, which also keeps holes closed. Both are pair energies, so
    /// their frequencies are known exactly and no triangulation is needed.
    Spacing {
        /// The width of the Gaussian.
        sigma: f64,
        /// The stages of the push, in order.
        pushes: &'static [Push],
    },
    /// Lloyd's centroidal Voronoi relaxation, that AA patterns were published with, on all twins at once. A block moves by
    /// the mean of its instances.
    Lloyd {
        /// The rate: ½ is a step to the centroid.
        rate: f64,
    },
    /// The descent on the error of a radial power curve, on unbounded patterns.
    Radial(Following),
    /// No optimization: every vector is zero.
    Undisplaced,
}

/// The parameters of a Gaussian repulsion in two phases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repulsion {
    /// The width of the Gaussian in the first phase.
    pub sigma: f64,
    /// The width of the Gaussian in the second phase. A wider Gaussian goes on lowering the power
    /// at low frequencies and leaves the rest as it is. The first phase alone, run until the power
    /// there is as low, also sharpens the set and raises its spectral peak.
    pub polish_sigma: f64,
    /// The share of the steps that the second phase takes.
    pub polish_share: f64,
    /// The range of the guard. The smallest distance ends a little below it.
    pub guard_reach: f64,
    /// The height of the guard at distance 0; see [`Guard::new`].
    pub guard_strength: f64,
    /// The rate of both phases.
    pub rate: f64,
}

/// The parameters of a descent on the error of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Following {
    /// The points `ν power` of the curve, separated by semicolons; see [`Target`].
    pub curve: &'static str,
    /// The weights in the cost of its error.
    pub weights: RadialWeights,
    /// The share of the steps that Gaussian repulsion (σ = 1) takes first. It quickly removes the
    /// power at low frequencies, which suits curves that are 0 over nearly the same range.
    pub warm_share: f64,
    pub rate: f64,
}

/// A stage of the push. The upper limit for a smallest distance is that of the hexagonal lattice, 1.0746.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Pairs closer than this are in conflict. Above 1.02 sets crystallize: the spectral peak grows
    /// from 6 to 9 and more.
    pub reach: f64,
    /// The height of the guard at distance 0. The greater it is, the closer to `reach` the smallest
    /// distance ends.
    pub strength: f64,
    /// The rate. A harder push needs a lower one.
    pub rate: f64,
    /// The share of the steps that the stage takes; the last stage takes all that are left.
    pub share: f64,
}

/// A descent.
type BoxedPhase = Box<dyn Phase>;

/// The descent of an objective.
fn phase(objective: impl Objective + 'static, steps: u32, rate: f64) -> BoxedPhase {
    Box::new(Descent::new(objective, steps, rate))
}

/// The rate of the repulsion before a curve is followed.
const WARM_RATE: f64 = 0.2;

impl Recipe {
    /// The optimizer's name and its parameters (name, value) but the curve, as a table's history records them.
    pub fn describe(&self) -> (&'static str, Vec<(String, String)>) {
        let numbers = |all: &[(&str, f64)]| {
            let text = |(name, value): &(&str, f64)| ((*name).to_owned(), value.to_string());
            all.iter().map(text).collect()
        };
        match *self {
            Self::Gaussian(own) => {
                let all = [
                    ("sigma", own.sigma),
                    ("polish_sigma", own.polish_sigma),
                    ("polish_share", own.polish_share),
                    ("guard_reach", own.guard_reach),
                    ("guard_strength", own.guard_strength),
                    ("rate", own.rate),
                ];
                ("gaussian", numbers(&all))
            }
            Self::Spacing { sigma, pushes } => {
                let list = |name: &str, pick: fn(&Push) -> f64| {
                    let each: Vec<String> = pushes.iter().map(|p| pick(p).to_string()).collect();
                    (name.to_owned(), each.join(" "))
                };
                let all = vec![
                    ("sigma".to_owned(), sigma.to_string()),
                    list("reach", |p| p.reach),
                    list("strength", |p| p.strength),
                    list("rate", |p| p.rate),
                    list("share", |p| p.share),
                ];
                ("spacing", all)
            }
            Self::Lloyd { rate } => ("lloyd", numbers(&[("rate", rate)])),
            Self::Radial(own) => {
                let weights = own.weights;
                let all = [
                    ("reach", weights.reach),
                    ("nu_max", weights.nu_max),
                    ("fit", weights.fit),
                    ("quiet", weights.quiet),
                    ("edge", weights.edge),
                    ("leash", weights.leash),
                    ("rate", own.rate),
                    ("warm_share", own.warm_share),
                ];
                let has_warm = usize::from(own.warm_share > 0.0);
                ("radial", numbers(&all[..7 + has_warm]))
            }
            Self::Undisplaced => ("none", Vec::new()),
        }
    }

    /// The phases in order, with `steps` steps in all. `target` is the curve for
    /// [`Recipe::Radial`], which has no phases without one; the others ignore it.
    pub(crate) fn phases(
        &self,
        domain: &Domain,
        target: Option<&Target>,
        steps: u32,
    ) -> Vec<BoxedPhase> {
        let share = |share: f64| (f64::from(steps) * share) as u32;
        let repelled = |sigma, guard, steps, rate| {
            let pairs = (Gaussian::new(sigma), guard);
            let pairs = Pairs::new(pairs, &domain.twin_maps(), domain.scale());
            phase(pairs, steps, rate)
        };
        match *self {
            Self::Gaussian(own) => {
                let guard = Guard::new(own.guard_reach, own.guard_strength);
                let polish = share(own.polish_share);
                vec![
                    repelled(own.sigma, guard, steps - polish, own.rate),
                    repelled(own.polish_sigma, guard, polish, own.rate),
                ]
            }
            Self::Spacing { sigma, pushes } => {
                let mut left = steps;
                let stages = pushes.iter().enumerate().map(|(at, push)| {
                    let is_last = at + 1 == pushes.len();
                    let steps = if is_last {
                        left
                    } else {
                        share(push.share).min(left)
                    };
                    left -= steps;
                    let guard = Guard::new(push.reach, push.strength);
                    repelled(sigma, guard, steps, push.rate)
                });
                stages.collect()
            }
            Self::Lloyd { rate } => {
                let sets = Sets::new(Lloyd, &domain.map, &domain.twins);
                vec![phase(sets, steps, rate)]
            }
            // The repulsion uses the pattern of α alone. The error is averaged over several α of the same map, so that the
            // table follows its curve on every twin.
            Self::Radial(own) => {
                let Some(target) = target else {
                    return Vec::new();
                };
                let warm = share(own.warm_share);
                let map = slice::from_ref(&domain.map);
                let repulsion = Pairs::new(Gaussian::new(1.0), map, domain.scale());
                let error = Radial::new(&domain.spread(), target, &own.weights);
                let mut phases = vec![
                    phase(repulsion, warm, WARM_RATE),
                    phase(error, steps - warm, own.rate),
                ];
                phases.retain(|phase| phase.steps() > 0);
                phases
            }
            Self::Undisplaced => Vec::new(),
        }
    }
}
