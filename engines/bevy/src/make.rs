//! The points of chunks, made in tasks.

use bevy_ecs::prelude::*;
use bevy_tasks::{AsyncComputeTaskPool, futures::check_ready};

use crate::{
    chunk::{Filling, Made, ScatterChunk, ScatterPoint, ScatterPoints, Step},
    removed::Removed,
    scatter::{Scatter, ScatterBudget},
};

/// Begins tasks for the nearest chunks that lack the points of their level.
pub(crate) fn begin(
    scatters: Query<'_, '_, &Scatter>,
    mut chunks: Query<'_, '_, (Entity, &ScatterChunk, &mut Filling)>,
    budget: Res<'_, ScatterBudget>,
) {
    let (mut running, mut waiting) = (0, Vec::new());
    for (entity, chunk, filling) in &chunks {
        match filling.step {
            Step::Making(..) => running += 1,
            Step::Idle if filling.is_stale || chunk.level != Some(filling.wanted) => {
                waiting.push((filling.distance, entity));
            }
            _ => (),
        }
    }
    waiting.sort_by(|a, b| a.0.total_cmp(&b.0));
    let free = budget.tasks.max(1).saturating_sub(running);
    for (_, entity) in waiting.into_iter().take(free) {
        let Ok((_, chunk, mut filling)) = chunks.get_mut(entity) else {
            continue;
        };
        let Ok(scatter) = scatters.get(filling.scatter) else {
            continue;
        };
        let (scatter, at, level) = (scatter.clone(), chunk.at, filling.wanted);
        let made = async move { scatter.made(at, level) };
        filling.is_stale = false;
        filling.step = Step::Making(level, AsyncComputeTaskPool::get().spawn(made));
    }
}

/// Takes what tasks have made.
pub(crate) fn finish(
    removed: Res<'_, Removed>,
    mut chunks: Query<'_, '_, (&mut Filling, Option<&mut ScatterPoints>)>,
) {
    for (mut filling, list) in &mut chunks {
        let Step::Making(level, task) = &mut filling.step else {
            continue;
        };
        let Some(mut made) = check_ready(task) else {
            continue;
        };
        let (level, scatter) = (*level, filling.scatter);
        made.retain(|point| !removed.is_removed(scatter, point.member.id()));
        match list {
            Some(mut list) => {
                list.0 = made;
                filling.begin(level, Made::new());
            }
            None => filling.begin(level, made),
        }
    }
}

impl Scatter {
    /// The points of a chunk at a level. A chunk so far out that coordinates do not tell points apart has none.
    fn made(&self, at: [i64; 2], level: usize) -> Made {
        let Some(set) = self.set(level) else {
            return Made::new();
        };
        let Ok(plan) = set.chunk(self.chunk, at) else {
            return Made::new();
        };
        let corner = at.map(|i| i as f64 * self.chunk);
        let point = |member: strew_core::Member| {
            let place = member.at();
            let height = self.height.as_ref().map_or(0.0, |height| height(place));
            let offset = [0, 1].map(|i| (place[i] - corner[i]) as f32);
            ScatterPoint {
                member,
                kind: set.kind_of(member.id()),
                offset: self.ground.place(offset, height),
            }
        };
        plan.iter().map(point).collect()
    }
}
