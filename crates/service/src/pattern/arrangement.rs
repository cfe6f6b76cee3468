//! Arrangements: whether one exists, how often it occurs, and where.

use std::ops::Range;

use schemars::JsonSchema;
use serde::Serialize;
use strew_catalog::Catalog;
use strew_core::{LATTICE_LIMIT, Pattern, Seed, pattern::Arrangement};
use strew_error::{Checked, Error, Fault, Faults, Together as _};
use strew_query::{
    Parameter, Set, Values, parameters,
    patterns::{CURSOR, GRID, LIMIT, LIST, MAP, MOST_PLACED, OFFSETS, SEED, WARP},
};

use super::{List, TURN, alpha, refused};

const AMOUNTS: [&Parameter; 3] = [
    &parameters::DENSITY,
    &parameters::SPACING,
    &parameters::MIN_DISTANCE,
];

/// A checked query about an arrangement.
#[derive(Clone, Debug)]
pub struct ArrangementQuery {
    pub found: Arrangement,
    pub grid: Option<[Range<i64>; 2]>,
    pub list: Option<List>,
    pub limit: Option<u64>,
    /// The first place of the list.
    pub from: Option<(i64, i64)>,
    pub set: Option<Box<Set>>,
}

/// An arrangement of pattern points: a point and others at some offsets. Lengths are in turns of the index
/// torus.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "Arrangement")]
pub struct Facts {
    /// The number α.
    pub alpha: String,
    /// The offsets of the other points from the first.
    pub offsets: Vec<(i64, i64)>,
    /// Whether it occurs anywhere: iff its image fits the set region.
    pub exists: bool,
    /// The side t of the set region.
    pub side: f64,
    /// The extent of its image along dX and dY: the least and the greatest shift, 0 among them.
    pub image: [[f64; 2]; 2],
    /// The ranges of dX and dY that are left to the index of the first point; null if the image does not fit.
    pub margin: Option<[[f64; 2]; 2]>,
    /// The area of the margin, exactly, times 2^128, in decimal digits.
    pub area: String,
    /// Occurrences for each grid point: the area of the margin.
    pub density: f64,
    /// The share of the pattern's points at which it occurs.
    pub frequency: f64,
    /// The number of occurrences in the box, exactly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<u128>,
}

impl ArrangementQuery {
    pub fn check(values: &Values, catalog: &Catalog) -> Result<Self, Error> {
        let places = places(values);
        let parts = (
            values.read(),
            alpha(values),
            values.require::<Vec<f64>>(&OFFSETS),
            values.get::<u64>(&SEED),
            (grid(values), list(values), cursor(values)).together(),
            values.get::<u64>(&LIMIT),
            places,
        );
        let ((), alpha, numbers, seed, (grid, list, from), limit, is_placed) = parts.together()?;
        let offsets: Vec<(i64, i64)> = numbers
            .chunks_exact(2)
            // Within ±2⁵², so exact.
            .map(|pair| (pair[0] as i64, pair[1] as i64))
            .collect();
        let pattern = Pattern::with_origin(alpha, Seed(seed.unwrap_or(0)).origin());
        let found = Arrangement::new(pattern, &offsets).map_err(|error| refused(&error))?;
        let set = is_placed
            .then(|| Set::single(values, catalog))
            .transpose()?;
        let query = Self {
            found,
            grid,
            list,
            limit,
            from,
            set,
        };
        query.check_parts(values)?;
        Ok(query)
    }

    fn check_parts(&self, values: &Values) -> Checked<()> {
        let beside = |parameter: &Parameter, other: &str| -> Checked<()> {
            let allowed = format!("beside {other}");
            let field = format!("{}{}", values.path(), parameter.name);
            let fault = Fault::new(
                &field,
                values.text(parameter),
                "has no effect alone",
                allowed,
            );
            Err(fault.into())
        };
        if self.list.is_some() && self.grid.is_none() {
            return beside(&LIST, GRID.name);
        }
        for parameter in [&LIMIT, &CURSOR] {
            if values.has(parameter) && self.list.is_none() {
                return beside(parameter, LIST.name);
            }
        }
        if self.set.is_some() {
            return self.check_places(values);
        }
        let lost = [&parameters::PROFILE, &MAP, &WARP];
        let lost = lost.into_iter().find(|parameter| values.has(parameter));
        lost.map_or(Ok(()), |parameter| {
            beside(parameter, "density, spacing or min_distance")
        })
    }

    fn check_places(&self, values: &Values) -> Checked<()> {
        let offsets = self.found.offsets();
        if offsets.len() > MOST_PLACED {
            let allowed = format!("at most {MOST_PLACED} offsets where places are listed");
            let value = format!("{} offsets", offsets.len());
            return Err(Fault::new(OFFSETS.name, value, "too many", allowed).into());
        }
        let reach = offsets.iter().map(|(x, y)| x.abs().max(y.abs())).max();
        let ends = self.grid.iter().flatten();
        let far = ends
            .map(|range| range.start.abs().max(range.end.abs()))
            .max();
        if reach.unwrap_or(0) + far.unwrap_or(0) > LATTICE_LIMIT / 2 {
            let detail = "too far from the origin for places to be distinct";
            let allowed = format!("a box and offsets within ±{} together", LATTICE_LIMIT / 2);
            return Err(Fault::new(GRID.name, values.text(&GRID), detail, allowed).into());
        }
        Ok(())
    }

    /// The facts about the arrangement.
    pub fn facts(&self) -> Facts {
        let found = &self.found;
        let margin = found.margin();
        let turns = |range: Range<u64>| [range.start as f64 / TURN, range.end as f64 / TURN];
        let count = |[x, y]: &[Range<i64>; 2]| found.count(x.clone(), y.clone());
        Facts {
            alpha: found.pattern().alpha().to_string(),
            offsets: found.offsets().to_vec(),
            exists: found.exists(),
            side: found.pattern().alpha().set_side_f64(),
            image: (found.image())
                .map(|range| [*range.start() as f64 / TURN, *range.end() as f64 / TURN]),
            margin: margin.map(|margin| margin.map(turns)),
            area: found.area().to_string(),
            density: found.density(),
            frequency: found.frequency(),
            count: self.grid.as_ref().map(count),
        }
    }
}

/// Whether the query includes an amount and thus wants the places of points.
fn places(values: &Values) -> Checked<bool> {
    Ok(AMOUNTS.into_iter().any(|amount| values.has(amount)))
}

fn grid(values: &Values) -> Checked<Option<[Range<i64>; 2]>> {
    let Some([min_x, min_y, max_x, max_y]) = values.get::<[f64; 4]>(&GRID)? else {
        return Ok(None);
    };
    if min_x > max_x || min_y > max_y {
        return Err(values.fault(&GRID, "max is below min").into());
    }
    // Within ±2⁵², so exact.
    let range = |min: f64, max: f64| min as i64..max as i64;
    Ok(Some([range(min_x, max_x), range(min_y, max_y)]))
}

fn list(values: &Values) -> Checked<Option<List>> {
    let name = values.get::<String>(&LIST)?;
    Ok(name.and_then(|name| List::from_name(&name)))
}

fn cursor(values: &Values) -> Checked<Option<(i64, i64)>> {
    let Some(text) = values.get::<String>(&CURSOR)? else {
        return Ok(None);
    };
    let read = |text: &str| {
        let integer: i64 = text.parse().ok()?;
        (integer.abs() <= LATTICE_LIMIT).then_some(integer)
    };
    let place = text
        .split_once(':')
        .and_then(|(x, y)| Some((read(x)?, read(y)?)));
    let fault = || Faults::from(values.fault(&CURSOR, "not a place of the grid"));
    place.map(Some).ok_or_else(fault)
}
