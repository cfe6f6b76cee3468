//! The price of counting a volume of space, of seeking in it, and of keeping its points clear of other layers.
//!
//! Most of a large volume is counted as whole cells; what lies along its surface is counted point by point. Points that
//! keep clear of others are all made and tested.

use strew_core::{
    Placement, Region, Spacing, Warp,
    space::{SpaceSet, Volume},
};
use strew_encode::Source;
use strew_query::{Query, Set};

use super::{
    layers::look,
    point::{self, LOOKED_AT, counts},
};
use crate::resolve::{Resolved, in_space as placed};

/// The nanoseconds that counting takes for each square of a spacing's side on the surface, without and with warp.
const SURFACE: f64 = 350.0;
const WARPED: f64 = 800.0;
/// Those of a point that is made to test whether it is clear of others.
const MADE: f64 = 100.0;
/// Those of counting a box without warp, whatever it holds.
const BOX: f64 = 4e5;

/// Those of a point that is walked over to find others by their numbers, and the points that are walked in place of
/// counting a box.
const WALKED: f64 = 15.0;
const WALK: f64 = 65_536.0;

/// The sides of the tiles in which points of another layer are made, in its spacings.
const TILE: [f64; 3] = [16.0, 16.0, 2.0];
const THINNED: f64 = 4.0;
/// The nanoseconds to make a tile, each of its points before they are thinned, and to test against a tile.
const MAKING: f64 = 60_000.0;
const LISTED: f64 = 150.0;
const TESTED: f64 = 150.0;
/// Those of a comparison with a point, of which some decide.
const COMPARED: f64 = 4.0;
const MANY: f64 = 100.0;
/// With fewer tests for each tile a test looks around its place alone: so long it takes, and for each point there.
const WORTH: f64 = 4.0;
const SEARCH: f64 = 10_000.0;
const FOUND: f64 = 100.0;
/// Tests end with the first layer that a place is too near to: of those that may be so, this share is.
const REMOVED: f64 = 0.25;

/// The layers of a query in space, reduced to the parts that decide the price of keeping clear of them.
#[derive(Debug, Default)]
pub struct Chains(Vec<Layer>);

#[derive(Debug)]
struct Layer {
    /// The mean spacing before and after points are thinned out.
    plain: f64,
    spacing: f64,
    clear: Vec<(usize, f64)>,
    /// The sides of the box around its own region.
    most: [f64; 3],
}

/// How much is needed of a layer.
#[derive(Clone, Copy, Debug, Default)]
struct Need {
    /// The box in which its points are made.
    sides: [f64; 3],
    tests: f64,
    /// The greatest distance that is kept.
    distance: f64,
}

impl Chains {
    /// Adds the next layer, which may have a region of its own; none if it cannot be planned.
    pub fn push(
        &mut self,
        points: Option<&SpaceSet>,
        clear: &[(usize, f64)],
        own: Option<&Volume>,
    ) {
        let plain = points.map_or(f64::INFINITY, |points| points.placement().spacing.get());
        let keep = points.map_or(1.0, |points| points.placement().keep.get());
        self.0.push(Layer {
            plain,
            spacing: plain / keep.cbrt(),
            clear: clear.into(),
            most: own.map_or([f64::INFINITY; 3], sides),
        });
    }

    /// The nanoseconds that testing each point of a set in a volume takes: against the layers that it keeps clear of, whose
    /// points are tested against those that these keep clear of, and so on. Each layer is made once, wherever a point
    /// of one that keeps clear of it is tested.
    pub fn test(&self, points: &SpaceSet, clear: &[(usize, f64)], volume: &Volume) -> f64 {
        let placement = points.placement();
        let spacing = placement.spacing.get() / placement.keep.get().cbrt();
        let sides = sides(volume);
        let places = sides.iter().map(|side| side / spacing).product::<f64>();
        let (mut needs, mut all) = (vec![Need::default(); self.0.len()], 0.0);
        let mut left = places;
        for &(place, distance) in clear {
            let Some(layer) = self.0.get(place) else {
                continue;
            };
            let tiles = layer.tiles(sides, 0.0);
            if places < WORTH * tiles {
                let near = layer.near(distance);
                all += left * (SEARCH + near * FOUND);
                let sides = sides.map(|side| side + 2.0 * distance);
                self.tested(&mut needs, layer, sides, left * layer.within(distance));
            } else {
                needs[place].add(sides, distance, left);
            }
            left *= layer.left(distance);
        }
        for (place, layer) in self.0.iter().enumerate().rev() {
            let need = needs[place];
            if need.tests == 0.0 {
                continue;
            }
            let touched = layer.tiles([2.0 * need.distance; 3], need.distance);
            let sides = [0, 1, 2].map(|axis| need.sides[axis].min(layer.most[axis]));
            let tiles = layer.tiles(sides, need.distance).min(need.tests * touched);
            let tile: f64 = layer.tile(need.distance).iter().product();
            let listed = tiles * tile / layer.plain.powi(3);
            let near = layer.near(need.distance).min(MANY);
            all += tiles * MAKING
                + listed * LISTED
                + need.tests * (touched * TESTED + near * COMPARED);
            // Each of its points is tested once, if it lies near a tested place.
            let points = sides
                .iter()
                .map(|side| side / layer.spacing + 1.0)
                .product::<f64>();
            let within = need.tests * layer.within(need.distance);
            self.tested(&mut needs, layer, sides, points.min(within));
        }
        all / places.max(1.0)
    }

    /// Adds tests of some points of a layer in a box.
    fn tested(&self, needs: &mut [Need], layer: &Layer, sides: [f64; 3], points: f64) {
        let mut left = points;
        for &(place, distance) in &layer.clear {
            let (Some(need), Some(other)) = (needs.get_mut(place), self.0.get(place)) else {
                continue;
            };
            need.add(sides, distance, left);
            left *= other.left(distance);
        }
    }
}

impl Need {
    fn add(&mut self, sides: [f64; 3], distance: f64, tests: f64) {
        self.sides = [0, 1, 2].map(|axis| self.sides[axis].max(sides[axis] + 2.0 * distance));
        self.tests += tests;
        self.distance = self.distance.max(distance);
    }
}

impl Layer {
    fn tile(&self, distance: f64) -> [f64; 3] {
        let wide = (self.spacing / self.plain).min(THINNED);
        TILE.map(|side| (side * self.plain * wide).max(distance))
    }

    /// About the number of tiles that a box touches.
    fn tiles(&self, sides: [f64; 3], distance: f64) -> f64 {
        let tile = self.tile(distance);
        (0..3).map(|axis| sides[axis] / tile[axis] + 1.0).product()
    }

    /// The number of points that are nearer to a place than a distance.
    fn within(&self, distance: f64) -> f64 {
        4.19 * (distance / self.spacing).powi(3)
    }

    /// The share of places that are tested against other layers after this one.
    fn left(&self, distance: f64) -> f64 {
        1.0 - REMOVED * self.within(distance).min(1.0)
    }

    /// The number of points in a box around a place.
    fn near(&self, distance: f64) -> f64 {
        (2.0 * distance / self.spacing + 1.0).powi(3)
    }
}

/// The sides of the box around a volume.
fn sides(volume: &Volume) -> [f64; 3] {
    volume.bounds().map_or([0.0; 3], |bounds| {
        [0, 1, 2].map(|axis| bounds.max()[axis] - bounds.min()[axis])
    })
}

/// The nanoseconds that counting the sets of a query in space takes: with a cursor of those after the cursor's. An offset
/// is sought as well.
pub(super) fn counting(query: &Query) -> f64 {
    let Some(whole) = &query.region.volume else {
        return 0.0;
    };
    let window = &query.window;
    let (mut chains, mut all) = (Chains::default(), 0.0);
    for (i, set) in query.sets.iter().enumerate() {
        let own = set.region.as_ref().and_then(|own| own.volume.as_ref());
        let volume = whole.and(own);
        // Planning refuses what cannot be planned.
        let points = set.space().and_then(|table| {
            let (spacing, counts) = match placed(set, table).ok()? {
                Resolved::Known(spacing, _) => (spacing, 1.0),
                Resolved::Count(count) => (guess(set, &volume, count).ok()?, counts(set)),
            };
            Some((set.points_in_space(table, spacing).ok()?, counts))
        });
        if let (Some((points, counts)), true) = (&points, query.is_counted(i)) {
            let placement = points.placement();
            let test = test(&chains, set, points, (&volume, query.region.bounds));
            let counted =
                counting_set(points, &volume, test) * counts + lacking(set, points, &volume);
            let is_sought = window.offset > 0;
            let sought = is_sought.then(|| {
                seeking(
                    placement,
                    &volume,
                    (counted, test > 0.0 || set.moves()),
                    1.0,
                )
            });
            all += counted + sought.unwrap_or(0.0);
        }
        let points = points.as_ref().map(|(points, _)| points);
        chains.push(points, &set.clear_of, own.map(|own| &own.volume));
    }
    all
}

/// About the spacing at which a volume has a number of a set's points, or the number.
pub fn guess(set: &Set, volume: &Volume, count: u64) -> Result<Spacing, u64> {
    let [a, b, c] = sides(volume).map(f64::cbrt);
    let guess = a * b * c * (set.share() / count.max(1) as f64).cbrt();
    Spacing::new(guess).map_err(|_| count)
}

/// The least spacing at which counting takes at most `most` rows, searched downward from that of some points.
pub fn least(points: &SpaceSet, most: f64, rows: impl Fn(&SpaceSet) -> f64) -> f64 {
    /// The ratio of a spacing to the one before, and the most steps.
    const STEP: f64 = 0.8;
    const STEPS: i32 = 60;
    let placement = points.placement();
    let at = |step: i32| Spacing::new(placement.spacing.get() * STEP.powi(step)).ok();
    let spacings = (1..STEPS).map_while(at);
    let is_cheap = |spacing: &Spacing| {
        let spacing = *spacing;
        rows(&points.clone().placed(Placement {
            spacing,
            ..placement
        })) <= most
    };
    let last = spacings.take_while(is_cheap).last();
    last.unwrap_or(placement.spacing).get()
}

/// The nanoseconds that looking at each point of a set in a volume takes: at those of its field, and whether it is clear
/// of other layers.
pub fn test(
    chains: &Chains,
    set: &Set,
    points: &SpaceSet,
    (volume, within): (&Volume, Region),
) -> f64 {
    let field = set.field.as_ref();
    let field = field.map_or(0.0, |field| LOOKED_AT + look([&field.spec], within));
    field + chains.test(points, &set.clear_of, volume)
}

/// The nanoseconds to find the points inside that are left out by their ids.
pub fn lacking(set: &Set, points: &SpaceSet, volume: &Volume) -> f64 {
    let unit = points.placement().spacing.get() * points.table().map().alpha().set_side_f64();
    (volume.bounds()).map_or(0.0, |within| point::lacking(set, unit, &within))
}

/// The points that counting a set in a field looks at.
pub fn candidates(points: &SpaceSet, volume: &Volume) -> u128 {
    let placement = points.placement();
    (points_in(volume, placement.spacing.get()) * placement.keep.get()) as u128
}

/// The nanoseconds that counting the points of a set in a volume takes, where testing one against others takes `test`.
pub(super) fn counting_set(points: &SpaceSet, volume: &Volume, test: f64) -> f64 {
    let placement = points.placement();
    settled(points, volume) + placed_set(placement, volume, test)
}

/// The nanoseconds that settling the points near the surface of a volume takes, with those around.
fn settled(points: &SpaceSet, volume: &Volume) -> f64 {
    /// How far around points others matter, the depth of the parts that are settled, in local spacings, and the
    /// nanoseconds for a step of a point.
    const AROUND: f64 = 12.0;
    const DEEP: f64 = 60.0;
    const STEP: f64 = 250.0;
    let placement = points.placement();
    let local = placement.spacing.get() / placement.keep.get().cbrt();
    let whole: f64 = sides(volume)
        .iter()
        .map(|side| side / local + AROUND)
        .product();
    let near = surface(volume) / (local * local) * DEEP;
    whole.min(near.max(AROUND.powi(3))) * f64::from(points.steps()) * STEP
}

fn placed_set(placement: Placement, volume: &Volume, test: f64) -> f64 {
    let spacing = placement.spacing.get();
    let is_box = matches!(volume, Volume::Region(_));
    match (test > 0.0, placement.warp) {
        (true, _) => points_in(volume, spacing) * (MADE + test * placement.keep.get()),
        (false, Warp::OFF) if is_box => BOX,
        (false, Warp::OFF) => BOX + surface(volume) / (spacing * spacing) * SURFACE,
        (false, _) => BOX + surface(volume) / (spacing * spacing) * WARPED,
    }
}

/// The nanoseconds to find points by some numbers in a volume that is counted in `counted`; those that keep clear of
/// others are tested again. Parts are counted, or all is walked once.
pub(super) fn seeking(
    placement: Placement,
    volume: &Volume,
    (counted, is_tested): (f64, bool),
    numbers: f64,
) -> f64 {
    if is_tested {
        return counted;
    }
    let all = points_in(volume, placement.spacing.get());
    let halves = 2.0 * numbers.log2() + 1.0;
    let parts = match counted <= BOX {
        true => numbers * (WALK * WALKED + BOX) + all.max(1.0).log2() * BOX,
        false => counted * halves,
    };
    parts.min(all * WALKED)
}

/// The number of points in the box around a volume.
fn points_in(volume: &Volume, spacing: f64) -> f64 {
    sides(volume).iter().map(|side| side / spacing).product()
}

/// The surface of the parts of a volume together.
fn surface(volume: &Volume) -> f64 {
    let of_box = |volume: &Volume| {
        let [a, b, c] = sides(volume);
        2.0 * (a * b + b * c + c * a)
    };
    match volume {
        Volume::AllOf(parts) | Volume::AnyOf(parts) => parts.iter().map(surface).sum(),
        Volume::Outside(part) => surface(part),
        Volume::Outlined(prism) => of_box(volume) * (1.0 + prism.vertices() as f64 / 64.0),
        other => of_box(other),
    }
}

/// The nanoseconds to split the points of a set, if it is one in space.
pub(super) fn splitting(
    query: &Query,
    set: &Set,
    (plan, nanoseconds): (&dyn Source, f64),
    parts: f64,
) -> Option<f64> {
    let placement = plan.space()?.placement();
    let own = set.region.as_ref().and_then(|own| own.volume.as_ref());
    let volume = query.region.volume.as_ref()?.and(own);
    let is_tested = !set.clear_of.is_empty() || set.field.is_some() || set.moves();
    let counted = match !is_tested {
        true => placed_set(placement, &volume, 0.0),
        false => plan.total() as f64 * nanoseconds,
    };
    Some(seeking(placement, &volume, (counted, is_tested), parts))
}

#[cfg(test)]
mod tests {
    use strew_core::space::{self, Ball};

    use super::*;

    /// The price of counting the last of some layers in a volume, each of which keeps clear of the one before it or of all.
    fn price(sets: &[SpaceSet], is_chain: bool, distance: f64, volume: &Volume) -> f64 {
        let (mut chains, mut price) = (Chains::default(), 0.0);
        for (i, set) in sets.iter().enumerate() {
            let first = if is_chain { i.saturating_sub(1) } else { 0 };
            let clear: Vec<_> = (first..i).map(|place| (place, distance)).collect();
            let test = chains.test(set, &clear, volume);
            price = counting_set(set, volume, test);
            chains.push(Some(set), &clear, None);
        }
        price
    }

    fn layers(number: u64) -> Vec<SpaceSet> {
        (1..=number)
            .map(|seed| SpaceSet::blue().seed(seed))
            .collect()
    }

    #[test]
    fn chains_cost_the_sum_of_their_layers() {
        let ball = Volume::from(Ball::new([0.0; 3], 2.0).expect("a ball"));
        for is_chain in [true, false] {
            let [two, eight, sixteen] =
                [2, 8, 16].map(|depth| price(&layers(depth), is_chain, 0.5, &ball));
            assert!(two < eight && eight < sixteen, "{two} {eight} {sixteen}");
            assert!(sixteen < 64.0 * two, "{two} {sixteen}");
        }
        // Some milliseconds are long work.
        assert!(price(&layers(16), true, 1.0, &ball) > 3e6);
    }

    #[test]
    fn many_parts_cost_no_more_than_a_walk() {
        let placement = SpaceSet::blue().placement();
        let cube = Volume::from(space::Region::new([0.0; 3], [100.0; 3]).expect("a box"));
        let sought = |numbers| seeking(placement, &cube, (BOX, false), numbers);
        assert!(sought(1.0) < sought(10_000.0) && sought(10_000.0) <= 1e6 * WALKED);
    }
}
