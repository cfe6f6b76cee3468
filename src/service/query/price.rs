//! What decoding the pictures takes that a query brings along, before any of them is decoded.

use super::{Draft, Value, Values};
use crate::raster::Price;

impl Draft {
    /// What the pictures of all its sets take.
    #[must_use]
    pub fn price(&self) -> Price {
        let layers = self.layers.iter().flatten().map(|layer| &layer.values);
        let all = [&self.values].into_iter().chain(layers);
        all.map(Values::price).sum()
    }
}

impl Values {
    /// What the pictures take that are among them.
    #[must_use]
    pub fn price(&self) -> Price {
        let of = |value: &Value| match value {
            Value::Field(field) => field.price(),
            Value::Fields(fields) => fields.iter().map(|(_, field)| field.price()).sum(),
            _ => Price::default(),
        };
        self.given().map(|(_, value)| of(value)).sum()
    }
}
