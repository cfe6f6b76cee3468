//! Reading documents of fields, with faults that name their path.

use serde::Deserializer;
use serde_path_to_error::Segment;
use strew_error::{Fault, Faults};

use super::Document;

pub(super) const FIELD: &str = "the name of a loaded field, or an object with one member: name, constant, ramp, \
                                radial, distance, noise, raster, height, slope, multiply, min, max, \
                                invert or curve";

/// Reads JSON: a name, or an object. `path` is put before the names of members in faults.
pub fn read_json(path: &str, text: &str) -> Result<Document, Faults> {
    let text = text.trim_start_matches('\u{feff}').trim();
    if text.starts_with('"') {
        let name = serde_json::from_str(text);
        let name = name.map_err(|error| fault(path, text, &error.to_string()))?;
        return Ok(Document::Name(name));
    }
    if !text.starts_with('{') {
        return Err(fault(path, text, "must be a name or an object"));
    }
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let document = read(path, text, &mut deserializer)?;
    let end = deserializer.end();
    end.map_err(|error| fault(path, text, &error.to_string()))?;
    Ok(document)
}

fn read<'de>(
    path: &str,
    text: &str,
    deserializer: impl Deserializer<'de, Error = serde_json::Error>,
) -> Result<Document, Faults> {
    serde_path_to_error::deserialize(deserializer).map_err(|error| {
        let mut place = path.to_owned();
        for segment in error.path().iter() {
            match segment {
                Segment::Seq { index } => place += &format!("[{index}]"),
                Segment::Map { key } => place += &format!(".{key}"),
                Segment::Enum { variant } => place += &format!(".{variant}"),
                Segment::Unknown => {}
            }
        }
        fault(&place, text, &error.inner().to_string())
    })
}

fn fault(path: &str, text: &str, detail: &str) -> Faults {
    let detail = match detail.rfind(" at line ") {
        Some(end) => &detail[..end],
        None => detail.lines().next().unwrap_or(detail),
    };
    let words: Vec<&str> = text.split_whitespace().take(40).collect();
    Fault::new(path, words.join(" "), detail, FIELD).into()
}
