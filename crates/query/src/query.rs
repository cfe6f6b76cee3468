//! Checked queries: where, which sets, and which part of their points.

use std::sync::Arc;

use strew_core::{Area, space::Volume};

use super::{QueryRegion, QueryVolume, Token, amount::Amount, set::Set};

#[derive(Clone, Debug, PartialEq)]
pub struct Query {
    pub region: QueryRegion,
    /// The sets of points: one, or one for each layer.
    pub sets: Arc<[Set]>,
    pub is_layered: bool,
    /// The window of the points, in their order.
    pub window: Window,
    pub world: Option<Named>,
    pub only: Option<usize>,
}

/// The window of the points, in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Window {
    /// The number of points left out at the beginning, or after the cursor.
    pub offset: u64,
    pub limit: Option<u64>,
    pub cursor: Option<Token>,
}

/// The longest that the looks at fields of a small query may take, in nanoseconds.
const QUICK: f64 = 3e5;

impl Query {
    /// Whether it holds all that its answer depends on: in its sets, or in the digest of a world that all of it comes
    /// from.
    pub fn is_pinned(&self) -> bool {
        match &self.world {
            Some(world) => world.is_pinned,
            None => self.sets.iter().all(Set::is_pinned),
        }
    }

    /// The digests of the tables that answer, each once, in the order of the sets. There are 16 at most: queries of more
    /// layers than that have one table.
    pub fn tables(&self) -> Vec<&str> {
        let mut tables: Vec<&str> = vec![];
        for set in self.sets.iter() {
            let digest = set.entry.digest.as_str();
            // Layers of one table mostly stand together.
            if tables.last() != Some(&digest) && !tables.contains(&digest) {
                tables.push(digest);
            }
        }
        tables
    }

    /// The digests of everything that its points depend on beyond the query itself.
    pub fn digests(&self) -> impl Iterator<Item = &str> {
        self.sets.iter().flat_map(Set::digests)
    }

    /// Whether planning counts the points of set number `i`. Those before a cursor and in its own set are not counted
    /// again, and those of layers that are not requested are not, unless their spacing follows from their number.
    pub fn is_counted(&self, i: usize) -> bool {
        let is_requested = self.only.is_none_or(|only| only == i);
        let cursor = self.window.cursor;
        let passed = cursor.filter(|token| i <= usize::from(token.set));
        if is_requested && passed.is_none() {
            return true;
        }
        let here = passed.filter(|token| is_requested && i == usize::from(token.set));
        let is_known = here.is_some_and(|token| token.spacing.is_some());
        let amount = self.sets.get(i).map(|set| set.amount);
        matches!(amount, Some(Amount::Count(_))) && !is_known
    }

    /// Whether planning it and making its points takes no longer than handing it to another
    /// thread: a single set in a box of about 2,000 spacings' area at most, and not long and thin.
    pub fn is_small(&self) -> bool {
        let ([set], Area::Region(_)) = (&*self.sets, &self.region.area) else {
            return false;
        };
        if set.period.is_some() {
            return false;
        }
        if let Some(volume) = &self.region.volume {
            let is_box = matches!(volume.volume, Volume::Region(_));
            let is_plain = set.field.is_none() && set.except.is_none() && set.region.is_none();
            return is_box && is_plain && is_small_in_space(set.amount, volume);
        }
        let spacing = match set.amount {
            Amount::Spacing(spacing) => spacing,
            Amount::Density(density) => density.sqrt().recip(),
            Amount::MinDistance(_) | Amount::Count(_) => return false,
        };
        let [min_x, min_y, max_x, max_y] = self.region.bbox();
        let [width, height] = [(max_x - min_x) / spacing, (max_y - min_y) / spacing];
        let is_plain = set.region.is_none() && set.clear_of.is_empty() && set.except.is_none();
        if !is_plain || width * height > 2048.0 || width.max(height) > 128.0 {
            return false;
        }
        let terrain = set.terrain.iter().map(|terrain| &terrain.field);
        let mut fields = set.fields().chain(terrain).map(|field| &field.spec);
        let mut looks = 0.0;
        let is_quick = fields.all(|field| {
            // A few trial looks measure how long a look takes.
            let is_plain = field.parts() <= 4 && field.vertices() <= 64;
            looks += if is_plain {
                field.nanoseconds(self.region.bounds)
            } else {
                0.0
            };
            is_plain
        });
        // A point may look around itself, too.
        is_quick && width * height * looks * 5.0 <= QUICK
    }
}

/// Whether a box in space has about a thousand points.
fn is_small_in_space(amount: Amount, volume: &QueryVolume) -> bool {
    let spacing = match amount {
        Amount::Spacing(spacing) => spacing,
        Amount::Density(density) => density.cbrt().recip(),
        Amount::MinDistance(_) | Amount::Count(_) => return false,
    };
    let ([x, y, z], [max_x, max_y, max_z]) = (volume.bounds.min(), volume.bounds.max());
    let longest = (max_x - x).max(max_y - y).max(max_z - z);
    volume.spacings(spacing) <= 1024.0 && longest / spacing <= 64.0
}

#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    pub name: String,
    pub digest: String,
    /// Whether the query names this digest, and nothing beside it that a server could change.
    pub is_pinned: bool,
}
