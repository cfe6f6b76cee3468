//! An app with a scatter and an anchor, and what must be loaded around it by definition.

use std::collections::HashMap;

use bevy_app::{App, TaskPoolPlugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::{TransformPlugin, prelude::Transform};
use strew_bevy::{
    Level, LevelChanged, Removed, Scatter, ScatterAnchor, ScatterBudget, ScatterChunk,
    ScatterPlugin, ScatterPoint, ScatterPoints,
};
use strew_core::{Kinds, PointId, PointSet, Region};

pub const CHUNK: f64 = 16.0;
const MARGIN: f64 = 5.0;
/// Distances and shares of the levels.
const LEVELS: [(f64, f64); 3] = [(20.0, 1.0), (45.0, 0.5), (80.0, 0.125)];
const BUDGET: ScatterBudget = ScatterBudget {
    tasks: 2,
    points: 40,
};
/// More points than any chunk has.
const LARGEST: usize = 100;

pub fn forest() -> PointSet {
    let set = PointSet::blue().spacing(2.0).expect("valid").seed(7);
    let kinds = Kinds::even("birch:1,oak:3").expect("two");
    set.kinds(kinds).expect("built in")
}

pub fn scatter() -> Scatter {
    let levels = LEVELS.map(|(distance, share)| Level::new(distance, share));
    let scatter = Scatter::new(forest(), CHUNK, levels).expect("valid");
    scatter.with_margin(MARGIN)
}

pub struct Game {
    pub app: App,
    pub scatter: Entity,
    pub anchor: Entity,
    /// The changes of levels of chunks, in order.
    pub changes: Vec<LevelChanged>,
}

impl Game {
    pub fn new(scatter: Scatter) -> Self {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, ScatterPlugin));
        app.insert_resource(BUDGET);
        let scatter = app.world_mut().spawn(scatter).id();
        let anchor = app.world_mut().spawn(ScatterAnchor).id();
        Self {
            app,
            scatter,
            anchor,
            changes: Vec::new(),
        }
    }

    /// All components of a type, with their entities.
    pub fn all<C: Component + Clone>(&mut self) -> Vec<(Entity, C)> {
        let world = self.app.world_mut();
        let mut query = world.query::<(Entity, &C)>();
        query.iter(world).map(|(e, c)| (e, c.clone())).collect()
    }

    /// Moves the anchor, whose place in the world follows in one frame.
    pub fn move_to(&mut self, at: Vec3) {
        let anchor = self.app.world_mut().get_mut::<Transform>(self.anchor);
        anchor.expect("an anchor").translation = at;
        self.frame();
    }

    fn frame(&mut self) {
        self.app.update();
        let mut messages = self
            .app
            .world_mut()
            .resource_mut::<Messages<LevelChanged>>();
        self.changes.extend(messages.drain());
    }

    /// Frames until something holds, none of them with more work than it may have.
    pub fn until(&mut self, what: &str, mut holds: impl FnMut(&mut Self) -> bool) {
        for _ in 0..5_000_000 {
            let count = |game: &mut Self| game.all::<ScatterPoint>().len();
            let before = count(self);
            self.frame();
            let after = count(self);
            assert!(after <= before + BUDGET.points, "{before} → {after}");
            let least = before.saturating_sub(BUDGET.points + LARGEST);
            assert!(after >= least, "{before} → {after}");
            if holds(self) {
                return;
            }
            std::thread::yield_now();
        }
        panic!("never: {what}");
    }

    /// The ids of the points of each chunk, in order.
    fn points(&mut self) -> HashMap<[i64; 2], Vec<PointId>> {
        let chunks: HashMap<Entity, ScatterChunk> =
            self.all::<ScatterChunk>().into_iter().collect();
        let mut found: HashMap<[i64; 2], Vec<PointId>> =
            chunks.values().map(|chunk| (chunk.at, vec![])).collect();
        for (point, ScatterPoint { member, .. }) in self.all::<ScatterPoint>() {
            let parent = self.app.world().get::<ChildOf>(point).expect("a chunk");
            let chunk = chunks[&parent.parent()];
            found.entry(chunk.at).or_default().push(member.id());
        }
        for (chunk, ScatterPoints(points)) in self.all::<ScatterPoints>() {
            let ids = points.iter().map(|point| point.member.id());
            found.entry(chunks[&chunk].at).or_default().extend(ids);
        }
        found.values_mut().for_each(|ids| ids.sort());
        found
    }

    /// The level of each chunk that must be loaded around a place or may be, if all are loaded and have a level that
    /// their distance allows, and no others are.
    fn levels(&mut self, place: [f64; 2]) -> Option<HashMap<[i64; 2], usize>> {
        let chunks = self.all::<ScatterChunk>();
        let loaded: HashMap<[i64; 2], Option<usize>> = chunks
            .iter()
            .map(|(_, chunk)| (chunk.at, chunk.level))
            .collect();
        assert_eq!(loaded.len(), chunks.len(), "no chunk is there twice");
        let radius = LEVELS[2].0;
        let reach = ((radius + MARGIN) / CHUNK).ceil() as i64 + 1;
        let center = place.map(|v| (v / CHUNK).floor() as i64);
        let mut expected = HashMap::new();
        for y in center[1] - reach..=center[1] + reach {
            for x in center[0] - reach..=center[0] + reach {
                let distance = distance([x, y], place);
                let level = match loaded.get(&[x, y]) {
                    None if distance <= radius => return None,
                    None => continue,
                    Some(level) => (*level)?,
                };
                let at = |margin: f64| LEVELS.iter().position(|l| distance <= l.0 + margin);
                let farthest = at(0.0).unwrap_or(LEVELS.len() - 1);
                if !(at(MARGIN)?..=farthest).contains(&level) {
                    return None;
                }
                expected.insert([x, y], level);
            }
        }
        (expected.len() == loaded.len()).then_some(expected)
    }

    /// Whether chunks and their points are those that a place must have.
    pub fn is_right(&mut self, place: [f64; 2]) -> bool {
        let Some(levels) = self.levels(place) else {
            return false;
        };
        let scatter = self.scatter;
        let removed = self.app.world().resource::<Removed>().clone();
        let found = self.points();
        levels.into_iter().all(|(at, level)| {
            let set = forest().lod(LEVELS[level].1).expect("a share");
            let region = Region::chunk(CHUNK, at).expect("near");
            let points = set.within(region).expect("near");
            let ids = points.iter().map(|member| member.id());
            let mut ids: Vec<_> = ids.filter(|id| !removed.is_removed(scatter, *id)).collect();
            ids.sort();
            found[&at] == ids
        })
    }

    pub fn wait_at(&mut self, place: [f64; 2]) {
        self.move_to(Vec3::new(place[0] as f32, 30.0, -place[1] as f32));
        self.until("the chunks around a place", |game| game.is_right(place));
    }
}

/// The distance of a chunk from a place.
fn distance(at: [i64; 2], place: [f64; 2]) -> f64 {
    let nearest = [0, 1].map(|i| {
        let start = at[i] as f64 * CHUNK;
        place[i].clamp(start, start + CHUNK)
    });
    (nearest[0] - place[0]).hypot(nearest[1] - place[1])
}
