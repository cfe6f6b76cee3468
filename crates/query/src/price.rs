//! The price of decoding the pictures of a query, known before any of them is decoded.

use strew_raster::Price;

use super::{Draft, Value, Values};

impl Draft {
    pub fn price(&self) -> Price {
        let layers = self.layers.iter().flatten().map(|layer| &layer.values);
        let all = [&self.values].into_iter().chain(layers);
        all.map(Values::price).sum()
    }
}

impl Values {
    pub fn price(&self) -> Price {
        let of = |value: &Value| match value {
            Value::Field(field) => field.price(),
            Value::Fields(fields) => fields.iter().map(|(_, field)| field.price()).sum(),
            _ => Price::default(),
        };
        self.given().map(|(_, value)| of(value)).sum()
    }
}
