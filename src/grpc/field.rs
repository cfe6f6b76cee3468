//! Fields of messages as documents, and loaded fields as messages.

use base64::{Engine as _, prelude::BASE64_STANDARD};
use bytes::Bytes;
use strew_catalog::field::{
    Document, NamedField,
    document::{
        Curve, Distance, EdgesName, FilterName, Height, Noise, Parts, Pixels, Place, Radial, Ramp,
        Slope,
    },
};

use super::proto::{
    self, Field, FieldBox, FieldEdges, FieldFilter, FieldPair, FieldPlace, field::Shape,
};

/// The document of a message. One without a shape is a field without a name, of which there is none.
pub(super) fn document(field: &Field) -> Document {
    let Some(shape) = &field.shape else {
        return Document::Name(String::new());
    };
    match shape {
        Shape::Name(name) => Document::Name(name.clone()),
        Shape::Constant(share) => Document::Constant(*share),
        Shape::Ramp(ramp) => Document::Ramp(Box::new(Ramp {
            from: place(ramp.from),
            to: place(ramp.to),
            shares: ramp.shares.map_or([0.0, 1.0], numbers),
        })),
        Shape::Radial(radial) => Document::Radial(Box::new(Radial {
            center: place(radial.center),
            radii: pair(radial.radii),
            shares: radial.shares.map_or([1.0, 0.0], numbers),
        })),
        Shape::Distance(distance) => {
            let lines = |lines: &[proto::FieldLine]| {
                let line = |line: &proto::FieldLine| pairs(&line.vertices);
                (!lines.is_empty()).then(|| lines.iter().map(line).collect())
            };
            let points = &distance.points;
            Document::Distance(Box::new(Distance {
                points: (!points.is_empty()).then(|| pairs(points)),
                lines: lines(&distance.lines),
                polygons: lines(&distance.polygons),
                distances: pair(distance.distances),
                shares: distance.shares.map_or([0.0, 1.0], numbers),
            }))
        }
        Shape::Noise(noise) => Document::Noise(Box::new(Noise {
            seed: noise.seed,
            wavelength: noise.wavelength,
            octaves: noise.octaves.unwrap_or(1),
            range: noise.range.map_or([0.0, 1.0], numbers),
        })),
        Shape::Raster(raster) => Document::Raster(Box::new(pixels(Some(raster)))),
        Shape::Height(height) => Document::Height(Box::new(Height {
            terrain: pixels(height.terrain.as_ref()),
            heights: pair(height.heights),
            shares: height.shares.map_or([0.0, 1.0], numbers),
        })),
        Shape::Slope(slope) => Document::Slope(Box::new(Slope {
            terrain: pixels(slope.terrain.as_ref()),
            slopes: pair(slope.slopes),
            shares: slope.shares.map_or([1.0, 0.0], numbers),
        })),
        Shape::Multiply(parts) => Document::Multiply(joined(parts)),
        Shape::Min(parts) => Document::Min(joined(parts)),
        Shape::Max(parts) => Document::Max(joined(parts)),
        Shape::Invert(of) => Document::Invert(Box::new(document(of))),
        Shape::Curve(curve) => Document::Curve(Box::new(Curve {
            of: curve
                .of
                .as_deref()
                .map_or_else(|| document(&Field::default()), document),
            points: pairs(&curve.points),
        })),
    }
}

/// The message of a document that answers repeat, which is a name.
pub(super) fn message_of(document: &Document) -> Field {
    Field {
        shape: match document {
            Document::Name(name) => Some(Shape::Name(name.clone())),
            _ => None,
        },
    }
}

pub(super) fn loaded(field: &NamedField) -> proto::LoadedField {
    let bbox = field.bbox;
    proto::LoadedField {
        name: field.name.clone(),
        digest: field.digest(),
        shape: field.document.shape().into(),
        parts: u32::try_from(field.spec.parts()).unwrap_or(u32::MAX),
        bbox: bbox.map(|[min_x, min_y, max_x, max_y]| FieldBox {
            min_x,
            min_y,
            max_x,
            max_y,
        }),
    }
}

fn joined(parts: &proto::FieldParts) -> Parts {
    Parts(parts.fields.iter().map(document).collect())
}

const fn numbers(pair: FieldPair) -> [f64; 2] {
    [pair.first, pair.second]
}

/// A place that must be there; see [`pair`].
fn place(place: Option<FieldPlace>) -> Place {
    match place.unwrap_or_default() {
        FieldPlace { x, y, z: None } => Place::Plane([x, y]),
        FieldPlace { x, y, z: Some(z) } => Place::Space([x, y, z]),
    }
}

/// Numbers that must be there; where they are not, the field refuses two zeros.
fn pair(pair: Option<FieldPair>) -> [f64; 2] {
    pair.map_or([0.0; 2], numbers)
}

fn pairs(pairs: &[FieldPair]) -> Vec<[f64; 2]> {
    pairs.iter().copied().map(numbers).collect()
}

fn pixels(pixels: Option<&proto::FieldPixels>) -> Pixels {
    let Some(pixels) = pixels else {
        return Pixels::default();
    };
    let text = |bytes: &Bytes| (!bytes.is_empty()).then(|| BASE64_STANDARD.encode(bytes));
    let size = |side: Option<u32>| side.map(|side| side as usize);
    Pixels {
        file: None,
        png: text(&pixels.png),
        f32: text(&pixels.f32),
        width: size(pixels.width),
        height: size(pixels.height),
        bbox: pixels.bbox.map(|b| [b.min_x, b.min_y, b.max_x, b.max_y]),
        edges: match FieldEdges::try_from(pixels.edges) {
            Ok(FieldEdges::Clamp) => EdgesName::Clamp,
            Ok(FieldEdges::Repeat) => EdgesName::Repeat,
            Ok(FieldEdges::Mirror) => EdgesName::Mirror,
            _ => EdgesName::Zero,
        },
        filter: match FieldFilter::try_from(pixels.filter) {
            Ok(FieldFilter::Linear) => Some(FilterName::Linear),
            Ok(FieldFilter::Nearest) => Some(FilterName::Nearest),
            _ => None,
        },
        black: pixels.black,
        white: pixels.white,
        low: pixels.low,
        high: pixels.high,
        gamma: pixels.gamma,
    }
}
