//! Single points as messages.

use strew_plan::Found;

use super::proto::{Block, Point, Value, value};

/// A point that was found.
pub(super) fn point(found: Found) -> Point {
    let attribute = |(name, value): (String, serde_json::Value)| Value {
        name,
        value: match value {
            serde_json::Value::String(text) => Some(value::Value::Text(text)),
            number => number.as_f64().map(value::Value::Number),
        },
    };
    Point {
        id: found.id,
        x: found.x,
        y: found.y,
        z: found.z,
        distance: found.distance,
        attributes: found.attributes.into_iter().map(attribute).collect(),
        block: found.block.map(|block| {
            // A map has a few hundred intervals.
            let [column, row] = block.map(|i| u32::try_from(i).unwrap_or(u32::MAX));
            Block { column, row }
        }),
    }
}
