//! Fields made of their documents. Later code relies on the checks made here.

use strew_core::field::{FieldSpec, Filter, Marks, Noise, Raster, Terrain};
use strew_error::{Checked, Fault, Faults, Together as _, all};

use super::{
    Document,
    document::{Curve, Distance, Pixels, Place},
    pixels,
    read::FIELD,
    sources::{Sources, problem},
};

/// Makes the field of a document. `path` is put before the names of members in faults.
pub fn build(path: &str, document: &Document, sources: &Sources<'_>) -> Checked<FieldSpec> {
    sources.go_on(path)?;
    let inside = |name: &str| format!("{path}.{name}");
    match document {
        Document::Name(name) => named(path, name, sources),
        Document::Constant(share) => {
            FieldSpec::constant(*share).map_err(|error| at(path, "constant", &error))
        }
        Document::Ramp(ramp) => {
            let path = inside("ramp");
            let spec = match (ramp.from, ramp.to) {
                (Place::Plane(from), Place::Plane(to)) => FieldSpec::ramp(from, to, ramp.shares),
                (Place::Space(from), Place::Space(to)) => FieldSpec::ramp(from, to, ramp.shares),
                _ => {
                    let (field, detail) = (format!("{path}.to"), "not as many numbers as from");
                    let allowed = "two places of two numbers, or for points in space of three";
                    return Err(Fault::new(&field, "", detail, allowed).into());
                }
            };
            spec.map_err(|error| within(&path, &error))
        }
        Document::Radial(radial) => {
            let spec = match radial.center {
                Place::Plane(at) => FieldSpec::radial(at, radial.radii, radial.shares),
                Place::Space(at) => FieldSpec::radial(at, radial.radii, radial.shares),
            };
            spec.map_err(|error| within(&inside("radial"), &error))
        }
        Document::Distance(distance) => measured(&inside("distance"), distance),
        Document::Noise(noise) => {
            let spec = FieldSpec::noise(Noise {
                seed: noise.seed,
                wavelength: noise.wavelength,
                octaves: noise.octaves,
                range: noise.range,
            });
            spec.map_err(|error| within(&inside("noise"), &error))
        }
        Document::Raster(pixels) => raster(&inside("raster"), pixels, sources),
        Document::Height(height) => {
            let path = inside("height");
            let terrain = terrain(&format!("{path}.terrain"), &height.terrain, sources)?;
            let spec = FieldSpec::height(terrain, height.heights, height.shares);
            spec.map_err(|error| within(&path, &error))
        }
        Document::Slope(slope) => {
            let path = inside("slope");
            let terrain = terrain(&format!("{path}.terrain"), &slope.terrain, sources)?;
            let stop = sources.allowance.stop;
            let spec = FieldSpec::slope_until(terrain, slope.slopes, slope.shares, stop);
            spec.map_err(|error| within(&path, &error))
        }
        Document::Multiply(parts) => {
            joined(path, "multiply", &parts.0, sources, FieldSpec::multiply)
        }
        Document::Min(parts) => joined(path, "min", &parts.0, sources, FieldSpec::min),
        Document::Max(parts) => joined(path, "max", &parts.0, sources, FieldSpec::max),
        Document::Invert(of) => {
            let of = build(&inside("invert"), of, sources)?;
            of.invert().map_err(|error| at(path, "invert", &error))
        }
        Document::Curve(curve) => curved(&inside("curve"), curve, sources),
    }
}

fn named(path: &str, name: &str, sources: &Sources<'_>) -> Checked<FieldSpec> {
    let (spec, epsg) = (sources.named)(name).ok_or_else(|| {
        let allowed = (sources.names)();
        Fault::new(path, name, "no such field is loaded", allowed)
    })?;
    sources.meet(path, epsg)?;
    Ok(spec)
}

fn joined(
    path: &str,
    kind: &'static str,
    parts: &[Document],
    sources: &Sources<'_>,
    join: fn(Vec<FieldSpec>) -> Result<FieldSpec, strew_core::Error>,
) -> Checked<FieldSpec> {
    let part = |(i, part)| build(&format!("{path}.{kind}[{i}]"), part, sources);
    let parts = all(parts.iter().enumerate().map(part))?;
    join(parts).map_err(|error| at(path, kind, &error))
}

fn curved(path: &str, curve: &Curve, sources: &Sources<'_>) -> Checked<FieldSpec> {
    let of = build(&format!("{path}.of"), &curve.of, sources)?;
    let spec = of.curve(curve.points.clone());
    spec.map_err(|error| at(path, "points", &error))
}

fn measured(path: &str, distance: &Distance) -> Checked<FieldSpec> {
    let marks = match (&distance.points, &distance.lines, &distance.polygons) {
        (Some(points), None, None) => Marks::Points(points.clone()),
        (None, Some(lines), None) => Marks::Lines(lines.clone()),
        (None, None, Some(polygons)) => Marks::Polygons(polygons.clone()),
        (None, None, None) => {
            let field = format!("{path}.points");
            return Err(Fault::missing(&field, "one of points, lines and polygons").into());
        }
        _ => {
            let detail = "more than one of points, lines and polygons";
            let allowed = "one of them; join fields with min or multiply";
            return Err(Fault::new(path, "", detail, allowed).into());
        }
    };
    let spec = FieldSpec::distance(marks, distance.distances, distance.shares);
    spec.map_err(|error| within(path, &error))
}

fn raster(path: &str, document: &Pixels, sources: &Sources<'_>) -> Checked<FieldSpec> {
    let (region, pixels, is_sharp) = pixels::shares(path, document, sources)?;
    let filter = match document.filter {
        Some(filter) => filter.into(),
        None if is_sharp => Filter::Nearest,
        None => Filter::Linear,
    };
    let raster = Raster::of(region, pixels).and_then(|raster| {
        let raster = raster.edges(document.edges.into()).filter(filter);
        let (low, high) = (document.low.unwrap_or(0.0), document.high.unwrap_or(1.0));
        let gamma = document.gamma.unwrap_or(1.0);
        FieldSpec::raster(raster.tone_until(low, high, gamma, sources.allowance.stop)?)
    });
    raster.map_err(|error| within(path, &error))
}

fn terrain(path: &str, document: &Pixels, sources: &Sources<'_>) -> Checked<Terrain> {
    let only_masks = [
        ("black", document.black),
        ("white", document.white),
        ("low", document.low),
        ("high", document.high),
        ("gamma", document.gamma),
    ];
    let refused = only_masks.into_iter().map(|(name, value)| match value {
        Some(value) => {
            let field = format!("{path}.{name}");
            let detail = "has no effect on a terrain, whose pixels are heights";
            Err(Fault::new(&field, value, detail, "no such member").into())
        }
        None => Ok(()),
    });
    let (_, (region, pixels)) =
        (all(refused), pixels::heights(path, document, sources)).together()?;
    let terrain = Terrain::new(region, pixels).map(|terrain| {
        let terrain = terrain.edges(document.edges.into());
        terrain.filter(document.filter.map_or(Filter::Linear, Into::into))
    });
    terrain.map_err(|error| within(path, &error))
}

/// The fault of what the library refuses, under the name that the library has for it.
fn within(path: &str, error: &strew_core::Error) -> Faults {
    at(path, error.field(), error)
}

fn at(path: &str, name: &str, error: &strew_core::Error) -> Faults {
    let allowed = match error.allowed() {
        "" => FIELD,
        allowed => allowed,
    };
    let field = format!("{path}.{name}");
    Fault::new(&field, error.value(), problem(error), allowed).into()
}
