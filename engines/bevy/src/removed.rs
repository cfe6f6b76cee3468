//! The points that are gone for good, such as felled trees.

use std::{
    collections::{HashMap, HashSet},
    mem,
};

use bevy_ecs::prelude::*;
use strew_core::PointId;

use crate::{
    chunk::{Chunks, Filling, ScatterPoints},
    scatter::Scatter,
};

/// The points that were removed from scatters. They stay away when their chunk is loaded again.
///
/// A saved game keeps [`ids`](Self::ids) and [extends](Self::extend) with them by the entity of the scatter of the same
/// set.
///
/// ```
/// use bevy_ecs::prelude::*;
/// use strew_bevy::Removed;
/// use strew_core::PointId;
///
/// let (scatter, tree) = (Entity::PLACEHOLDER, PointId { x: -31, y: 52 });
/// let mut removed = Removed::default();
/// assert!(removed.remove(scatter, tree) && removed.is_removed(scatter, tree));
/// assert_eq!(removed.ids(scatter).collect::<Vec<_>>(), [tree]);
/// assert!(removed.restore(scatter, tree) && !removed.is_removed(scatter, tree));
/// ```
#[derive(Resource, Clone, Debug, Default)]
pub struct Removed {
    of: HashMap<Entity, HashSet<PointId>>,
    /// What chunks do not show yet.
    fresh: Vec<(Entity, PointId)>,
}

impl Removed {
    /// Removes a point of a scatter: its entity goes in this or the next frame. Returns whether it was there.
    pub fn remove(&mut self, scatter: Entity, id: PointId) -> bool {
        let is_new = self.of.entry(scatter).or_default().insert(id);
        if is_new {
            self.fresh.push((scatter, id));
        }
        is_new
    }

    /// Removes many points of a scatter.
    pub fn extend(&mut self, scatter: Entity, ids: impl IntoIterator<Item = PointId>) {
        for id in ids {
            self.remove(scatter, id);
        }
    }

    /// Lets a point of a scatter return. Returns whether it was removed.
    pub fn restore(&mut self, scatter: Entity, id: PointId) -> bool {
        let all = self.of.get_mut(&scatter);
        let was_removed = all.is_some_and(|all| all.remove(&id));
        if was_removed {
            self.fresh.push((scatter, id));
        }
        was_removed
    }

    /// Whether a point of a scatter was removed.
    #[must_use]
    pub fn is_removed(&self, scatter: Entity, id: PointId) -> bool {
        self.of.get(&scatter).is_some_and(|all| all.contains(&id))
    }

    /// The points that were removed from a scatter, in no order.
    pub fn ids(&self, scatter: Entity) -> impl Iterator<Item = PointId> + '_ {
        self.of.get(&scatter).into_iter().flatten().copied()
    }
}

/// Takes what was removed out of loaded chunks, and has chunks made again to which something returns.
pub(crate) fn apply(
    mut commands: Commands<'_, '_>,
    mut removed: ResMut<'_, Removed>,
    scatters: Query<'_, '_, (&Scatter, &Chunks)>,
    mut chunks: Query<'_, '_, (&mut Filling, Option<&mut ScatterPoints>)>,
) {
    if removed.fresh.is_empty() {
        return;
    }
    for (scatter, id) in mem::take(&mut removed.fresh) {
        let Ok((of, loaded)) = scatters.get(scatter) else {
            continue;
        };
        let Some(point) = of.all.point(id) else {
            continue;
        };
        let at = of.chunk_at(point.at());
        let chunk = loaded.all.get(&at).map(|chunk| chunks.get_mut(*chunk));
        let Some(Ok((mut filling, list))) = chunk else {
            continue;
        };
        if !removed.is_removed(scatter, id) {
            filling.is_stale = true;
            continue;
        }
        if let Some(entity) = filling.entities.remove(&id) {
            commands.entity(entity).try_despawn();
        }
        if let Some(mut list) = list {
            list.0.retain(|point| point.member.id() != id);
        }
    }
}
