//! The JSON Schema of documents: a choice of objects with one member each, which generators of clients read
//! better than what is derived from the enum.

// Schemas are all that is made of these types.
#![allow(dead_code, reason = "the types are only described, not built")]

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};

use super::document::{Curve, Distance, Document, Height, Noise, Pixels, Radial, Ramp, Slope};

/// A field: a share of the density, from 0 to 1, at each place.
#[derive(JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Field")]
enum FieldSchema {
    Name(NamedShape),
    Constant(ConstantShape),
    Ramp(RampShape),
    Radial(RadialShape),
    Distance(DistanceShape),
    Noise(NoiseShape),
    Raster(RasterShape),
    Height(HeightShape),
    Slope(SlopeShape),
    Multiply(MultiplyShape),
    Min(MinShape),
    Max(MaxShape),
    Invert(InvertShape),
    Curve(CurveShape),
}

/// Makes an object with one member of each shape.
macro_rules! shapes {
    ($($(#[$doc:meta])+ $name:ident = $member:ident: $kind:ty;)+) => {$(
        $(#[$doc])+
        #[derive(JsonSchema)]
        #[schemars(deny_unknown_fields)]
        struct $name {
            $member: $kind,
        }
    )+};
}

shapes! {
    /// A field that is loaded, or one that was sent.
    NamedShape = name: String;
    /// The same share everywhere.
    ConstantShape = constant: f64;
    /// A share that changes from one place to another, constant before and beyond.
    RampShape = ramp: Ramp;
    /// A share that changes with the distance from a place.
    RadialShape = radial: Radial;
    /// A share that changes with the distance from points, lines or polygons.
    DistanceShape = distance: Distance;
    /// Natural patches.
    NoiseShape = noise: Noise;
    /// The pixels of a mask.
    RasterShape = raster: Pixels;
    /// A share that changes with the height of a terrain.
    HeightShape = height: Height;
    /// A share that changes with the slope of a terrain.
    SlopeShape = slope: Slope;
    /// The product of fields.
    MultiplyShape = multiply: Vec<Document>;
    /// The least of fields.
    MinShape = min: Vec<Document>;
    /// The greatest of fields.
    MaxShape = max: Vec<Document>;
    /// 1 − the share of a field.
    InvertShape = invert: Box<Document>;
    /// The share of a field, mapped by a curve.
    CurveShape = curve: Box<Curve>;
}

impl JsonSchema for Document {
    fn schema_name() -> Cow<'static, str> {
        FieldSchema::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        FieldSchema::json_schema(generator)
    }
}
