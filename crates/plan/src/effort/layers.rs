//! The price of keeping points clear of other layers, and of looking at fields.

use strew_core::{Region, Spacing, server};
use strew_query::Set;

/// A search for points near a place, in nanoseconds.
const SEARCH: f64 = 800.0;
/// A point that a search finds.
const FOUND: f64 = 20.0;
/// A search ends with the first point that is not left out, which is one of the first few.
const FIRST: f64 = 4.0;

/// The layers of a query, in their order, reduced to the parts that decide the price of later ones.
#[derive(Debug, Default)]
pub struct Layers(Vec<Layer>);

#[derive(Debug)]
struct Layer {
    density: f64,
    /// The time to decide whether one of its points exists, in nanoseconds.
    look: f64,
}

impl Layers {
    /// Adds the next layer, with a mean spacing.
    pub fn push(&mut self, set: &Set, spacing: Option<Spacing>, within: Region) {
        self.0.push(Layer {
            density: spacing.map_or(0.0, Spacing::density),
            look: self.test(set) + look(set.field.as_ref().map(|field| &field.spec), within),
        });
    }

    /// Whether a place is clear of all layers that a set names, in nanoseconds. A point that lies near counts only
    /// if it is clear of other layers itself, and so on.
    pub fn test(&self, set: &Set) -> f64 {
        let test = |&(place, distance): &(usize, f64)| {
            let Some(layer) = self.0.get(place) else {
                return 0.0;
            };
            let near = std::f64::consts::PI * distance * distance * layer.density;
            let seen = if layer.look > 0.0 {
                1.0 + near
            } else {
                near.clamp(1.0, FIRST)
            };
            SEARCH + seen * (FOUND + layer.look)
        };
        set.clear_of.iter().map(test).sum()
    }
}

/// A look at fields, in nanoseconds.
pub(super) fn look<'a>(
    fields: impl IntoIterator<Item = &'a strew_core::field::FieldSpec>,
    within: Region,
) -> f64 {
    let looks = fields.into_iter().map(|field| server::look(field, within));
    looks.sum()
}
