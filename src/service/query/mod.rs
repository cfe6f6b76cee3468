//! Queries: from raw parameters or typed fields to a checked [`Query`].
//!
//! There is one way in, [`Draft::check`]; beyond it nothing is checked again. It reports every
//! fault it finds, so that a client needs one round to learn them all. Text parameters, of an
//! address or a command line, become [`Parameters`] first.

mod parameters;
mod pin;
mod text;

use serde::Serialize;
use strew_core::{
    Alpha, Placement, Region, Seed, Spacing, Warp,
    map::Size,
    sample::{PlanError, RegionError, SpacingError},
};

use super::{Catalog, Error, Fault, Key};

pub use parameters::{PARAMETERS, Parameter, Shape};
pub use text::{Parameters, parse_pairs, read_bbox};

/// The profile of a query that names none.
pub const DEFAULT_PROFILE: &str = "blue";
/// The α of a query that names none: the one whose pattern's spectrum is the most even.
pub const DEFAULT_ALPHA: &str = "(5-sqrt(3))/2";

/// What a box must be.
const BOX: &str =
    "four finite numbers min_x,min_y,max_x,max_y with min_x < max_x and min_y < max_y";
/// How to say how densely points lie.
const AMOUNT: &str =
    "one of density (points per unit of area) and spacing (the mean, density^-1/2)";

/// What a warp may be.
const WARP: &str = "off, on, or a strength from 0 (off) over 1 (on) to 2";

/// A query as typed fields, not checked yet. What is absent takes its default; a box and one of
/// density and spacing must be there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Draft<'a> {
    /// min x, min y, max x, max y.
    pub bbox: Option<[f64; 4]>,
    /// Points per unit of area.
    pub density: Option<f64>,
    /// The mean spacing.
    pub spacing: Option<f64>,
    /// The name of the noise profile.
    pub profile: Option<&'a str>,
    /// The number α, in any form that is read.
    pub alpha: Option<&'a str>,
    /// The size of the map: `s`, `m`, `l`; the size S if it is loaded, else the smallest, by
    /// default.
    pub map: Option<&'a str>,
    /// The seed.
    pub seed: u64,
    /// The strength of the warp; by default 0 for seed 0 and 1 for every other.
    pub warp: Option<f64>,
    /// The digest of the table that has to answer.
    pub table: Option<&'a str>,
}

/// A checked query: what is asked for can be answered.
#[derive(Clone, Debug, PartialEq)]
pub struct Query {
    /// The region; not empty.
    pub region: Region,
    /// The mean spacing.
    pub spacing: Spacing,
    /// The density, as asked for or from the spacing.
    pub density: f64,
    /// The name of the noise profile; loaded for `alpha`.
    pub profile: String,
    /// The number α.
    pub alpha: Alpha,
    /// The size of the map.
    pub size: Size,
    /// The seed.
    pub seed: Seed,
    /// How strongly the plane is warped.
    pub warp: Warp,
}

/// A query as answers echo it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Resolved {
    /// min x, min y, max x, max y.
    pub bbox: [f64; 4],
    /// Points per unit of area.
    pub density: f64,
    /// The mean spacing.
    pub spacing: f64,
    /// The name of the noise profile.
    pub profile: String,
    /// The number α in its canonical form.
    pub alpha: String,
    /// The size of the map.
    pub map: String,
    /// The seed.
    pub seed: u64,
    /// The strength of the warp; 0 is off.
    pub warp: f64,
}

impl Draft<'_> {
    /// Checks everything against what is loaded. `faults` are those found on the way here; a field
    /// that one of them names is not faulted again.
    ///
    /// # Errors
    /// [`Error::Invalid`] with every fault.
    pub fn check(&self, catalog: &Catalog, mut faults: Vec<Fault>) -> Result<Query, Error> {
        let known: Vec<String> = faults.iter().map(|fault| fault.field.clone()).collect();
        let is_new = |fault: &Fault| {
            let amount = |field: &str| field == "density" || field == "spacing";
            !known
                .iter()
                .any(|field| *field == fault.field || amount(field) && amount(&fault.field))
        };
        let mut add = |fault: Fault| {
            if is_new(&fault) {
                faults.push(fault);
            }
        };
        let region = self.region().map_err(&mut add).ok();
        let amount = self.amount().map_err(&mut add).ok();
        let warp = self.warp().map_err(&mut add).ok();
        let pin = pin::read(self.table).map_err(&mut add);
        let key = self
            .key(catalog)
            .map_err(|faults| faults.into_iter().for_each(&mut add))
            .ok();
        let (Some(region), Some((spacing, density)), Some(warp), Some(key), Ok(()), true) =
            (region, amount, warp, key, pin, faults.is_empty())
        else {
            return Err(Error::Invalid(faults));
        };
        pin::compare(self.table, catalog, &key)?;
        Ok(Query {
            region,
            spacing,
            density,
            profile: key.profile.as_ref().into(),
            alpha: key.alpha,
            size: key.size,
            seed: Seed(self.seed),
            warp: warp.unwrap_or(Placement::new(spacing, Seed(self.seed)).warp),
        })
    }

    fn region(&self) -> Result<Region, Fault> {
        let corners = self.bbox.ok_or_else(|| Fault::missing("bbox", BOX))?;
        let [min_x, min_y, max_x, max_y] = corners;
        let fault = |detail: String| Fault::new("bbox", listed(corners), detail, BOX);
        let region = Region::new([min_x, min_y], [max_x, max_y]).map_err(|error| {
            fault(match error {
                RegionError::NotFinite { corner, value } => format!("{corner} is {value}"),
                RegionError::Reversed {
                    corner,
                    value,
                    lower,
                } => format!("it is reversed: {corner} is {value}, below the lower bound {lower}"),
                other => other.to_string(),
            })
        })?;
        for (axis, i) in [("x", 0), ("y", 1)] {
            let (min, max) = (region.min()[i], region.max()[i]);
            if min >= max {
                let detail = format!("it is empty: min_{axis} and max_{axis} are both {min}");
                return Err(fault(detail));
            }
        }
        Ok(region)
    }

    /// The warp that is asked for, if any.
    fn warp(&self) -> Result<Option<Warp>, Fault> {
        self.warp
            .map(|strength| {
                Warp::new(strength)
                    .map_err(|_| Fault::new("warp", number(strength), "it is out of range", WARP))
            })
            .transpose()
    }

    /// Spacing and density.
    fn amount(&self) -> Result<(Spacing, f64), Fault> {
        let fault = |field, value: f64, error: SpacingError| {
            let allowed = match error {
                SpacingError::Spacing(_) => {
                    format!("{:e} to {:e}", Spacing::MIN, Spacing::MAX)
                }
                _ => format!("{:e} to {:e}", Spacing::MIN_DENSITY, Spacing::MAX_DENSITY),
            };
            Fault::new(field, number(value), "it is out of range", allowed)
        };
        match (self.density, self.spacing) {
            (Some(density), None) => Spacing::from_density(density)
                .map(|spacing| (spacing, density))
                .map_err(|error| fault("density", density, error)),
            (None, Some(spacing)) => Spacing::new(spacing)
                .map(|spacing| (spacing, spacing.density()))
                .map_err(|error| fault("spacing", spacing, error)),
            (None, None) => Err(Fault::missing("density", AMOUNT)),
            (Some(density), Some(spacing)) => Err(Fault::new(
                "spacing",
                number(spacing),
                format!("density is given, too, as {}", number(density)),
                AMOUNT,
            )),
        }
    }

    /// The table that is asked for.
    fn key(&self, catalog: &Catalog) -> Result<Key, Vec<Fault>> {
        let profile = self.profile.unwrap_or(DEFAULT_PROFILE);
        let text = self.alpha.unwrap_or(DEFAULT_ALPHA);
        let alphas = catalog.alphas(profile);
        let is_loaded = !alphas.is_empty();
        let mut faults = vec![];
        if !is_loaded {
            let detail = "no such profile is loaded";
            faults.push(Fault::new("profile", profile, detail, loaded(catalog)));
        }
        let allowed = || {
            if is_loaded {
                some(alphas.iter().map(ToString::to_string))
            } else {
                loaded(catalog)
            }
        };
        let alpha = text.parse::<Alpha>().map_err(|error| {
            faults.push(Fault::new("alpha", text, error.to_string(), allowed()));
        });
        let (Ok(alpha), true) = (alpha, faults.is_empty()) else {
            return Err(faults);
        };
        let sizes = catalog.sizes(profile, alpha);
        let Some(&smallest) = sizes.first() else {
            let detail = format!("the profile `{profile}` is not loaded for this alpha");
            return Err(vec![Fault::new("alpha", text, detail, allowed())]);
        };
        let size = match self.map {
            Some(text) => text
                .parse::<Size>()
                .ok()
                .filter(|size| sizes.contains(size))
                .ok_or_else(|| {
                    let detail =
                        format!("the profile `{profile}` is not loaded with this map size");
                    vec![Fault::new(
                        "map",
                        text,
                        detail,
                        some(sizes.iter().map(ToString::to_string)),
                    )]
                })?,
            None if sizes.contains(&Size::S) => Size::S,
            None => smallest,
        };
        let entry = catalog.entry(&Key {
            profile: profile.into(),
            alpha,
            size,
        });
        entry.map(|entry| entry.key.clone()).ok_or_else(Vec::new)
    }
}

impl Query {
    /// What its table is found by.
    #[must_use]
    pub fn key(&self) -> Key {
        Key {
            profile: self.profile.as_str().into(),
            alpha: self.alpha,
            size: self.size,
        }
    }

    /// How the table's points are laid into the world.
    #[must_use]
    pub const fn placement(&self) -> Placement {
        Placement::new(self.spacing, self.seed).with_warp(self.warp)
    }

    /// As answers echo it.
    #[must_use]
    pub fn resolved(&self) -> Resolved {
        Resolved {
            bbox: self.bbox(),
            density: self.density,
            spacing: self.spacing.get(),
            profile: self.profile.clone(),
            alpha: self.alpha.to_string(),
            map: self.size.to_string(),
            seed: self.seed.0,
            warp: self.warp.strength(),
        }
    }

    /// min x, min y, max x, max y.
    #[must_use]
    pub fn bbox(&self) -> [f64; 4] {
        let ([min_x, min_y], [max_x, max_y]) = (self.region.min(), self.region.max());
        [min_x, min_y, max_x, max_y]
    }

    /// The error of a box that reaches too far for its spacing.
    pub(super) fn too_far(&self, error: &PlanError) -> Error {
        let value = listed(self.bbox());
        Error::Invalid(vec![match error {
            PlanError::TooFar {
                corner,
                value: far,
                limit,
            } => Fault::new(
                "bbox",
                value,
                format!("{corner} is {}, too far from the origin", number(*far)),
                format!(
                    "within ±{} at spacing {}, where f64 still tells neighbors apart",
                    number(*limit),
                    number(self.spacing.get())
                ),
            ),
            other => Fault::new("bbox", value, other.to_string(), BOX),
        }])
    }
}

/// The shortest digits of any number.
fn number(value: f64) -> String {
    zmij::Buffer::new().format(value).into()
}

fn listed(corners: [f64; 4]) -> String {
    corners.map(number).join(",")
}

/// What is loaded, for an error.
fn loaded(catalog: &Catalog) -> String {
    let of = |profile: &str| {
        let alphas = some(catalog.alphas(profile).iter().map(ToString::to_string));
        format!("{profile} (alpha {alphas})")
    };
    match catalog.profiles().as_slice() {
        [] => "nothing: no table is loaded".into(),
        profiles => some(profiles.iter().map(|profile| of(profile))),
    }
}

/// A list, but not a long one: errors travel in headers, too.
fn some(items: impl Iterator<Item = String>) -> String {
    const SHOWN: usize = 16;
    let mut items: Vec<String> = items.collect();
    let more = items.len().saturating_sub(SHOWN);
    if more > 0 {
        items.truncate(SHOWN);
        items.push(format!("and {more} more (see the list of profiles)"));
    }
    items.join(", ")
}
