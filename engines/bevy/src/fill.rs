//! Points become entities, and entities of points that are not wanted go: a few in each frame.

use bevy_ecs::prelude::*;
use bevy_transform::prelude::Transform;

use crate::{
    chunk::{Filling, LevelChanged, ScatterChunk, Spent, Step},
    removed::Removed,
    scatter::ScatterBudget,
};

/// Fills chunks, the nearest first.
pub(crate) fn fill(
    mut commands: Commands<'_, '_>,
    mut chunks: Query<'_, '_, (Entity, &mut ScatterChunk, &mut Filling)>,
    mut changes: MessageWriter<'_, LevelChanged>,
    removed: Res<'_, Removed>,
    (budget, mut spent): (Res<'_, ScatterBudget>, ResMut<'_, Spent>),
) {
    let most = budget.points.max(1);
    let is_filling = |filling: &Filling| matches!(filling.step, Step::Filling { .. });
    let open = chunks.iter().filter(|(_, _, filling)| is_filling(filling));
    let mut open: Vec<(f64, Entity)> = open.map(|(chunk, _, f)| (f.distance, chunk)).collect();
    open.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, entity) in open {
        let Ok((_, mut chunk, mut filling)) = chunks.get_mut(entity) else {
            continue;
        };
        let Filling {
            scatter,
            step,
            entities,
            ..
        } = &mut *filling;
        let Step::Filling {
            level,
            coming,
            going,
        } = step
        else {
            continue;
        };
        while spent.0 < most
            && let Some(gone) = going.pop()
        {
            commands.entity(gone).try_despawn();
            spent.0 += 1;
        }
        while spent.0 < most
            && let Some(point) = coming.pop_front()
        {
            let id = point.member.id();
            // It may have been removed since it was made.
            if removed.is_removed(*scatter, id) {
                continue;
            }
            let place = Transform::from_translation(point.offset);
            let spawned = commands.spawn((point, place, ChildOf(entity))).id();
            entities.insert(id, spawned);
            spent.0 += 1;
        }
        if !(coming.is_empty() && going.is_empty()) {
            return;
        }
        let (from, to) = (chunk.level, *level);
        let scatter = *scatter;
        filling.step = Step::Idle;
        chunk.level = Some(to);
        changes.write(LevelChanged {
            scatter,
            chunk: entity,
            from,
            to,
        });
    }
}
