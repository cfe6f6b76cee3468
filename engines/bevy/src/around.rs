//! The chunks around anchors: which are to be loaded, at which level, and which are to go.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::{GlobalTransform, Transform};

use crate::{
    chunk::{Chunks, Filling, ScatterChunk, ScatterPoints, Spent},
    scatter::{Scatter, ScatterAnchor, ScatterBudget},
};

/// Finds the chunks of all scatters, and lets go of those that are too far away.
pub(crate) fn find_chunks(
    mut commands: Commands<'_, '_>,
    anchors: Query<'_, '_, &GlobalTransform, With<ScatterAnchor>>,
    mut scatters: Query<'_, '_, (Entity, Ref<'_, Scatter>, &mut Chunks)>,
    mut fillings: Query<'_, '_, &mut Filling>,
    (budget, mut spent): (Res<'_, ScatterBudget>, ResMut<'_, Spent>),
) {
    spent.0 = 0;
    for (entity, scatter, mut chunks) in &mut scatters {
        if scatter.is_changed() {
            for (_, chunk) in chunks.all.drain() {
                commands.entity(chunk).try_despawn();
            }
            chunks.found_for = None;
        }
        let below = |at: &GlobalTransform| scatter.ground.below(at.translation());
        let mut places: Vec<[f64; 2]> = anchors.iter().map(below).collect();
        places.retain(|place| place.iter().all(|v| v.is_finite()));
        if chunks.found_for.as_ref() == Some(&places) {
            continue;
        }
        let mut has_room = |points: usize| {
            let has_room = spent.0 < budget.points.max(1);
            spent.0 += if has_room { points } else { 0 };
            has_room
        };
        let mut is_all = let_go(&mut commands, &scatter, &mut chunks, &places, |chunk| {
            has_room(fillings.get(chunk).map_or(0, |f| f.entities.len()))
        });
        for (distance, at) in near(&scatter, &places) {
            let loaded = chunks.all.get(&at).copied();
            if let Some(mut filling) = loaded.and_then(|chunk| fillings.get_mut(chunk).ok()) {
                filling.distance = distance;
                filling.wanted = scatter.next_level(filling.wanted, distance);
                continue;
            }
            if let (None, Some(level)) = (loaded, scatter.level(distance, 0.0)) {
                if !has_room(1) {
                    is_all = false;
                    break;
                }
                let corner = at.map(|i| (i as f64 * scatter.chunk) as f32);
                let corner: Vec3 = scatter.ground.place(corner, 0.0);
                let chunk = (
                    ScatterChunk { at, level: None },
                    Filling::new(entity, level, distance),
                    Transform::from_translation(corner),
                    ChildOf(entity),
                );
                let mut chunk = commands.spawn(chunk);
                if scatter.is_listed {
                    chunk.insert(ScatterPoints::default());
                }
                chunks.all.insert(at, chunk.id());
            }
        }
        chunks.found_for = is_all.then_some(places);
    }
}

/// Lets chunks beyond the radius and the margin go, as long as there is room for their points in this frame. Returns
/// whether all went.
fn let_go(
    commands: &mut Commands<'_, '_>,
    scatter: &Scatter,
    chunks: &mut Chunks,
    places: &[[f64; 2]],
    mut has_room: impl FnMut(Entity) -> bool,
) -> bool {
    let most = scatter.radius() + scatter.margin;
    let mut is_all = true;
    chunks.all.retain(|at, chunk| {
        if scatter.distance(*at, places) <= most {
            return true;
        }
        let goes = has_room(*chunk);
        if goes {
            commands.entity(*chunk).try_despawn();
        }
        is_all &= goes;
        !goes
    });
    is_all
}

/// The distances and places of the chunks within the radius and the margin of any place, each once, nearest first.
fn near(scatter: &Scatter, places: &[[f64; 2]]) -> Vec<(f64, [i64; 2])> {
    let most = scatter.radius() + scatter.margin;
    let mut all = Vec::new();
    for (i, place) in places.iter().enumerate() {
        let [low, high] = [-most, most].map(|r| scatter.chunk_at(place.map(|v| v + r)));
        for y in low[1]..=high[1] {
            for x in low[0]..=high[0] {
                let at = [x, y];
                let is_near = scatter.distance(at, &[*place]) <= most;
                // Found from an earlier place already.
                if is_near && (i == 0 || scatter.distance(at, &places[..i]) > most) {
                    all.push((scatter.distance(at, places), at));
                }
            }
        }
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

impl Scatter {
    /// The chunk in which a place lies.
    pub(crate) fn chunk_at(&self, place: [f64; 2]) -> [i64; 2] {
        place.map(|v| (v / self.chunk).floor() as i64)
    }

    /// The distance of a chunk from the nearest of some places.
    fn distance(&self, at: [i64; 2], places: &[[f64; 2]]) -> f64 {
        let from = |place: &[f64; 2]| {
            let beyond = [0, 1].map(|i| {
                let start = at[i] as f64 * self.chunk;
                (start - place[i])
                    .max(place[i] - start - self.chunk)
                    .max(0.0)
            });
            beyond[0].hypot(beyond[1])
        };
        places.iter().map(from).fold(f64::INFINITY, f64::min)
    }

    /// The level of a chunk that has or awaits one: another if it is near enough for one with more points, or farther
    /// than its own with the margin.
    fn next_level(&self, level: usize, distance: f64) -> usize {
        let nearer = self.level(distance, 0.0);
        match nearer {
            Some(nearer) if nearer < level => nearer,
            // Beyond the radius it keeps what it has until it goes.
            _ => self
                .level(distance, self.margin)
                .unwrap_or(level)
                .max(level),
        }
    }
}
