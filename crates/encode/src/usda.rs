//! USD as text: a `PointInstancer` for each chunk of points, with ids, and a prototype for each thing.
//!
//! z is up. Located are relative to the region's lower corner, where the instancers' parent stands, because they are
//! `float`. Orientations are `half`, which is what all readers know. An id is one integer: its column in the upper 32
//! bits, its row in the lower ones; in space 21 bits each for x, y and z.

use std::fmt::Write as _;

use bytes::Bytes;
use strew_error::Error;

use super::{
    EncodeError,
    blocks::Blocks,
    chunks::{Chunks, Things},
    head::Head,
    ids,
    place::Place,
    pose::Pose,
    rows::{Batch, Rows},
    schema::Schema,
};

/// The blocks of a stage.
#[derive(Debug)]
pub(super) struct Usda {
    /// The text before the first chunk, until it is written.
    begin: Option<String>,
    layers: Vec<Option<String>>,
    pose: Pose,
    things: Things,
    /// The names of further numbers.
    others: Vec<String>,
    chunks: Chunks,
    /// The number of chunks so far.
    chunk: u64,
    points: u64,
    is_over: bool,
}

impl Usda {
    /// The stage of rows of which none was taken.
    ///
    /// # Errors
    /// [`Error::Invalid`] for ids that it cannot hold.
    pub(super) fn new(rows: Rows, head: &Head) -> Result<Self, Error> {
        let bits = ids::bits_joined(rows.schema().is_in_space());
        ids::check("usda", &rows, bits)?;
        let pose = Pose::new(rows.schema());
        let things = Things::new(rows.schema(), &pose);
        let spacing = rows.parts().next().map(|part| part.plan.spacing());
        let origin = rows.coordinates().origin();
        let origin = origin.unwrap_or(Place::Plane([0.0; 2]));
        Ok(Self {
            begin: Some(begin(head, &things, origin, spacing.unwrap_or(1.0))),
            layers: rows.parts().map(|part| part.layer.clone()).collect(),
            others: others(rows.schema(), &pose),
            pose,
            things,
            chunks: Chunks::new(rows),
            chunk: 0,
            points: 0,
            is_over: false,
        })
    }

    /// The next chunk; `None` after the last.
    fn instancer(&mut self) -> Option<String> {
        let mut arrays = Arrays::new(self.others.len());
        let (pose, things) = (&self.pose, &self.things);
        let chunks = &mut self.chunks;
        let part = chunks.next(|batch| arrays.push(batch, pose, things))?;
        self.points += arrays.points;
        let number = self.chunk;
        self.chunk += 1;
        let layer = self.layers.get(part).cloned().flatten();
        let layer = layer.map(|layer| {
            format!(
                "    custom string strew:layer = {}\n        ",
                quoted(&layer)
            )
        });
        let prototypes: Vec<String> = (0..things.names.len())
            .map(|i| format!("</points/prototypes/thing_{i}>"))
            .collect();
        let mut out = format!(
            "    def PointInstancer \"chunk_{number}\"\n    {{\n    {}    rel prototypes = [{}]\n",
            layer.unwrap_or_default(),
            prototypes.join(", ")
        );
        let mut array = |name: &str, values: &mut String, after: &str| {
            // Behind each value is a comma and a space.
            values.truncate(values.len().saturating_sub(2));
            let _ = writeln!(out, "        {name} = [{values}]{after}");
        };
        array("int[] protoIndices", &mut arrays.things, "");
        array("int64[] ids", &mut arrays.ids, "");
        array("point3f[] positions", &mut arrays.places, "");
        if pose.is_turned() {
            array("quath[] orientations", &mut arrays.rotations, "");
        }
        if pose.is_scaled() {
            array("float3[] scales", &mut arrays.scales, "");
        }
        for (name, values) in self.others.iter().zip(&mut arrays.others) {
            let name = format!("float[] primvars:{name}");
            array(&name, values, " (interpolation = \"varying\")");
        }
        out.push_str("    }\n");
        Some(out)
    }
}

/// The arrays of a chunk, as text.
#[derive(Debug, Default)]
struct Arrays {
    points: u64,
    things: String,
    ids: String,
    places: String,
    rotations: String,
    scales: String,
    others: Vec<String>,
}

impl Arrays {
    fn new(others: usize) -> Self {
        Self {
            others: vec![String::new(); others],
            ..Self::default()
        }
    }

    fn push(&mut self, batch: Batch<'_>, pose: &Pose, things: &Things) {
        self.points += batch.points.len() as u64;
        // Writing to memory cannot fail.
        for row in batch.rows() {
            let _ = write!(self.things, "{}, ", things.of(row));
            let _ = write!(self.ids, "{}, ", ids::joined(row));
            let [x, y] = batch.near[row.index];
            let _ = write!(self.places, "({x}, {y}, {}), ", pose.z(row) as f32);
            if pose.is_turned() {
                let [x, y, z, w] = pose.rotation(row);
                let _ = write!(self.rotations, "({w:.6}, {x:.6}, {y:.6}, {z:.6}), ");
            }
            if pose.is_scaled() {
                let scale = pose.scale(row) as f32;
                let _ = write!(self.scales, "({scale}, {scale}, {scale}), ");
            }
            for (out, column) in self.others.iter_mut().zip(&pose.others) {
                let value = row.columns.get(*column).and_then(|v| v.number(row.index));
                let _ = write!(out, "{}, ", value.unwrap_or(0.0) as f32);
            }
        }
    }
}

/// The names of further numbers, as USD allows them.
fn others(schema: &Schema, pose: &Pose) -> Vec<String> {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let names = pose.others.iter().map(|i| &schema.columns()[*i].name);
    names
        .map(|name| name.chars().map(letter).collect())
        .collect()
}

/// A text in quotes.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for char in text.chars() {
        match char {
            '"' | '\\' => out.extend(['\\', char]),
            '\n' => out.push_str("\\n"),
            char if char.is_control() => out.push(' '),
            char => out.push(char),
        }
    }
    out.push('"');
    out
}

/// The stage's head, and a cone for each thing, as high as points are apart. They stand under an `over`, so that
/// they are not drawn by themselves.
fn begin(head: &Head, things: &Things, origin: Place, spacing: f64) -> String {
    let ([x, y], z) = (origin.flat(), origin.z());
    let mut out = String::from("#usda 1.0\n(\n    customLayerData = {\n");
    for (name, value) in head.entries() {
        let name = name.replace('.', "_");
        let _ = writeln!(out, "        string {name} = {}", quoted(&value));
    }
    let _ = write!(
        out,
        "    }}\n    defaultPrim = \"points\"\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n\n\
         def Xform \"points\"\n{{\n    double3 xformOp:translate = ({x}, {y}, {z})\n    \
         uniform token[] xformOpOrder = [\"xformOp:translate\"]\n\n    over \"prototypes\"\n    {{\n"
    );
    for (i, name) in things.names.iter().enumerate() {
        let _ = write!(
            out,
            "        def Xform \"thing_{i}\" (\n            displayName = {name}\n        )\n        {{\n            \
             custom string strew:name = {name}\n            def Cone \"placeholder\"\n            {{\n                \
             uniform token axis = \"Z\"\n                double height = {spacing}\n                \
             double radius = {}\n                double3 xformOp:translate = (0, 0, {})\n                \
             uniform token[] xformOpOrder = [\"xformOp:translate\"]\n            }}\n        }}\n",
            spacing / 4.0,
            spacing / 2.0,
            name = quoted(name),
        );
    }
    out.push_str("    }\n\n");
    out
}

impl Blocks for Usda {
    fn points(&self) -> u64 {
        self.points
    }

    fn next(&mut self) -> Option<Result<Bytes, EncodeError>> {
        if self.is_over {
            return None;
        }
        let written = self.begin.take().or_else(|| self.instancer());
        let written = written.unwrap_or_else(|| {
            self.is_over = true;
            "}\n".into()
        });
        Some(Ok(written.into()))
    }
}
