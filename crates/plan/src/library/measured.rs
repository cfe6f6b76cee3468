//! Measuring points: figures, power and distances of a set that a program has.

use serde_json::{Map, Value, json};
use strew_error::{Error, Fault, number};
use strew_forge::{
    Report, Resolution,
    measure::{BANDS, Sample},
};

use super::Work;

/// The largest set that is measured: its spectrum takes some gigabytes at ν = 4.
pub const MOST_POINTS: u128 = 4_000_000;
/// The smallest.
pub const LEAST_POINTS: u128 = 100;

/// A measurement of points: their square, their density, and the resolution.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The square that the points fill: min x, min y, max x, max y.
    pub bbox: [f64; 4],
    /// Points per unit of area, where that is known better than by counting.
    pub density: Option<f64>,
    pub is_periodic: bool,
    pub resolution: Resolution,
}

/// Measures points, as the work of a call, which may be stopped.
pub fn measure(mut points: Vec<[f64; 2]>, of: &Measured, work: &Work) -> Result<Report, Error> {
    let [min_x, min_y, max_x, max_y] = of.bbox;
    let (width, height) = (max_x - min_x, max_y - min_y);
    let is_square = width > 0.0 && (width / height - 1.0).abs() <= 1e-9;
    if !is_square || !of.bbox.iter().all(|v| v.is_finite()) {
        let value = of.bbox.map(number).join(",");
        let detail = "only squares are measured";
        let allowed = "min_x,min_y,max_x,max_y of a square";
        return Err(Fault::new("bbox", value, detail, allowed).into());
    }
    for (field, value, [least, most]) in [
        ("nu_max", of.resolution.nu_max, [0.5, 8.0]),
        ("ring_width", of.resolution.ring_width, [0.0, 0.5]),
    ] {
        if !(least..=most).contains(&value) {
            let allowed = format!("a number from {least} to {most}");
            return Err(Fault::new(field, number(value), "out of range", allowed).into());
        }
    }
    let count = points.len() as u128;
    if !(LEAST_POINTS..=MOST_POINTS).contains(&count) {
        let allowed = format!("from {LEAST_POINTS} to {MOST_POINTS} points");
        let detail = "too few or too many to be measured";
        return Err(Fault::new("points", format!("{count} points"), detail, allowed).into());
    }
    let inside = |[x, y]: &[f64; 2]| (min_x..max_x).contains(x) && (min_y..max_y).contains(y);
    if let Some([x, y]) = points.iter().find(|point| !inside(point)) {
        let value = format!("{},{}", number(*x), number(*y));
        let allowed = "points with min <= p < max";
        return Err(Fault::new("points", value, "outside of bbox", allowed).into());
    }
    for point in &mut points {
        *point = [point[0] - min_x, point[1] - min_y];
    }
    let name = format!("{count} points");
    let set = if of.is_periodic {
        Sample::torus(width, points)
    } else {
        let density = of.density.unwrap_or(count as f64 / (width * height));
        Sample::window(width, density, points)
    };
    let set = set.until(work.stop.clone());
    work.finished(Report::of(name, false, &set, of.resolution))
}

pub fn document(report: &Report) -> Value {
    let figures = report.figures.values.iter();
    let figures = figures.map(|(name, value)| (name.clone(), json!(value)));
    let rings: Vec<Value> = report
        .rings
        .iter()
        .map(|r| json!([r.nu, r.power, r.anisotropy_db]))
        .collect();
    let bands: Vec<Value> = BANDS
        .iter()
        .zip(&report.anisotropy_by_band)
        .map(|([from, to], db)| json!([from, to, db]))
        .collect();
    json!({
        "subject": report.figures.subject,
        "made_on_it": report.figures.seen,
        "points": report.figures.points,
        "figures": figures.collect::<Map<_, _>>(),
        "radial": { "columns": ["nu", "power", "anisotropy_db"], "rings": rings },
        "anisotropy": { "columns": ["from", "to", "db"], "bands": bands },
        "rdf": { "columns": ["distance", "g"], "bins": report.rdf.bins },
    })
}
