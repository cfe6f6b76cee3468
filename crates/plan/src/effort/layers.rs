//! The price of keeping points clear of other layers, and of looking at fields.

use strew_core::{Area, Region, Spacing};
use strew_query::Set;

/// A search for points near a place, in nanoseconds.
const SEARCH: f64 = 800.0;
/// A point that a search finds.
const FOUND: f64 = 20.0;
/// A search ends with the first point that is not left out, which is one of the first few.
const FIRST: f64 = 4.0;

/// A look at the points that are marked around a place.
const MARKED: f64 = 60.0;
/// A point that is listed and marked.
const LISTED: f64 = 60.0;
/// The points around a tile are listed when searches in it have cost as much.
const TWICE: f64 = 2.0;
/// The greatest side of a tile, in spacings of the points that are listed, beside twice the distance.
const TILE: f64 = 32.0;
/// About the sides of the pieces that are cut into tiles, in spacings of the points that are tested.
const PIECE: [f64; 2] = [300.0, 75.0];

/// The layers of a query, in their order, reduced to the parts that decide the price of later ones.
#[derive(Debug, Default)]
pub struct Layers(Vec<Layer>);

#[derive(Debug)]
struct Layer {
    density: f64,
    /// The time to decide whether one of its points exists, in nanoseconds.
    look: f64,
    /// The time of such a look for each of many points that are listed at once.
    listed: f64,
}

/// The places that are tested: about `density` in each world unit squared, everywhere in a box.
#[derive(Clone, Copy, Debug)]
pub struct Everywhere {
    /// The sides of the box, or of the pieces into which it is cut.
    sides: [f64; 2],
    density: f64,
}

impl Everywhere {
    /// The points of a set with a mean spacing in a part of a query, if it is a box that they fill.
    pub fn of(set: &Set, spacing: Spacing, area: &Area) -> Option<Self> {
        let Area::Region(region) = area else {
            return None;
        };
        let is_filled = set.field.is_none();
        is_filled.then(|| Self::within(*region, spacing, set.share()))
    }

    fn within(region: Region, spacing: Spacing, share: f64) -> Self {
        let sides = region.sides();
        Self {
            sides: [0, 1].map(|i| sides[i].min(PIECE[i] * spacing.get())),
            density: spacing.density() * share,
        }
    }

    /// The time of a test against a layer's points, in nanoseconds, if they are listed around tiles; `search` is the
    /// time of a search. `None` if too few places are tested in a tile.
    fn marked(&self, layer: &Layer, distance: f64, search: f64) -> Option<f64> {
        let most = TILE / layer.density.sqrt() + 2.0 * distance;
        let tile = self.sides.map(|side| side / (side / most).ceil().max(1.0));
        let radius = (0.5 * tile[0] + distance).hypot(0.5 * tile[1] + distance);
        let points = std::f64::consts::PI * radius * radius * layer.density;
        let listed = points * (LISTED + layer.listed);
        let tested = tile[0] * tile[1] * self.density;
        let is_worth = layer.density > 0.0 && tested * search > listed;
        is_worth.then(|| MARKED + TWICE * listed / tested)
    }
}

impl Layers {
    /// Adds the next layer, with a mean spacing.
    pub fn push(&mut self, set: &Set, spacing: Option<Spacing>, within: Region) {
        let look = look(set.field.as_ref().map(|field| &field.spec), within);
        // Fewer of its points, in its own region and field, take no longer in all.
        let places = spacing.map(|spacing| Everywhere::within(within, spacing, 1.0));
        self.0.push(Layer {
            density: spacing.map_or(0.0, Spacing::density),
            look: self.test(set, None) + look,
            listed: self.test(set, places) + look,
        });
    }

    /// Whether a place is clear of all layers that a set names, in nanoseconds; less if it is known that many places
    /// are tested. A point that lies near counts only if it is clear of other layers itself, and so on.
    pub fn test(&self, set: &Set, everywhere: Option<Everywhere>) -> f64 {
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
            let search = SEARCH + seen * (FOUND + layer.look);
            let marked = everywhere.and_then(|places| places.marked(layer, distance, search));
            marked.map_or(search, |marked| marked.min(search))
        };
        set.clear_of.iter().map(test).sum()
    }
}

/// A look at fields, in nanoseconds.
pub(super) fn look<'a>(
    fields: impl IntoIterator<Item = &'a strew_core::field::FieldSpec>,
    within: Region,
) -> f64 {
    let looks = fields.into_iter().map(|field| field.nanoseconds(within));
    looks.sum()
}
