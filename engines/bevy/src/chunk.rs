//! The components of chunks and of their points.

use std::{
    collections::{HashMap, VecDeque},
    mem,
};

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_tasks::Task;
use bevy_transform::prelude::Transform;
use strew_core::{Member, PointId};

/// A chunk of a [`Scatter`](crate::Scatter), a child of its entity. It lies at the chunk's lower corner.
///
/// It changes, as queries with `Changed` see, when all points of another level are there.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[require(Transform)]
pub struct ScatterChunk {
    /// The column and the row, as [`PointSet::chunk`](strew_core::PointSet::chunk) takes them.
    pub at: [i64; 2],
    /// The level whose points are all there, 0 for the nearest; `None` until the first points are made.
    pub level: Option<usize>,
}

/// A point of a chunk: a component of its own entity, which is a child of the chunk, or an item of
/// [`ScatterPoints`].
///
/// The `Transform` of the entity is set once, to the offset. What a game changes of it stays.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[require(Transform)]
pub struct ScatterPoint {
    /// The point: its id, place, angle, scale and random numbers.
    pub member: Member,
    /// The number of its kind, the rarest first, if the set has [kinds](strew_core::PointSet::kinds).
    pub kind: Option<u8>,
    /// Its place from the chunk's corner, in world units.
    pub offset: Vec3,
}

/// The points of a chunk of a scatter [as lists](crate::Scatter::as_lists), a component of the chunk.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct ScatterPoints(pub Vec<ScatterPoint>);

/// All points of another level of a chunk are there.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelChanged {
    /// The entity of the scatter.
    pub scatter: Entity,
    /// The entity of the chunk.
    pub chunk: Entity,
    /// The level before, `None` for a new chunk.
    pub from: Option<usize>,
    /// The level now, 0 for the nearest.
    pub to: usize,
}

/// The chunks of a scatter by column and row.
#[derive(Component, Debug, Default)]
pub(crate) struct Chunks {
    pub(crate) all: HashMap<[i64; 2], Entity>,
    /// The places of the anchors for which all chunks were found.
    pub(crate) found_for: Option<Vec<[f64; 2]>>,
}

/// The work on a chunk.
#[derive(Component, Debug)]
pub(crate) struct Filling {
    pub(crate) scatter: Entity,
    /// The level that it is to have.
    pub(crate) wanted: usize,
    /// The distance from the nearest anchor.
    pub(crate) distance: f64,
    pub(crate) step: Step,
    /// Whether its points are to be made again at the same level.
    pub(crate) is_stale: bool,
    /// The points that are entities.
    pub(crate) entities: HashMap<PointId, Entity>,
}

/// The points of a level, in the order of the set.
pub(crate) type Made = Vec<ScatterPoint>;

/// The state of a chunk, on the way to the points of a level.
#[derive(Debug)]
pub(crate) enum Step {
    /// Nothing is made.
    Idle,
    /// The points of a level are made in a task.
    Making(usize, Task<Made>),
    /// Entities of a level come and go.
    Filling {
        level: usize,
        coming: VecDeque<ScatterPoint>,
        going: Vec<Entity>,
    },
}

impl Filling {
    pub(crate) fn new(scatter: Entity, wanted: usize, distance: f64) -> Self {
        Self {
            scatter,
            wanted,
            distance,
            step: Step::Idle,
            is_stale: false,
            entities: HashMap::new(),
        }
    }

    /// Begins to turn the entities that are there into the points of a level.
    pub(crate) fn begin(&mut self, level: usize, made: Made) {
        let mut old = mem::take(&mut self.entities);
        let mut coming = VecDeque::new();
        for point in made {
            let id = point.member.id();
            match old.remove(&id) {
                Some(entity) => drop(self.entities.insert(id, entity)),
                None => coming.push_back(point),
            }
        }
        let going = old.into_values().collect();
        self.step = Step::Filling {
            level,
            coming,
            going,
        };
    }
}

/// The points that this frame has turned into entities, or entities into nothing.
#[derive(Resource, Debug, Default)]
pub(crate) struct Spent(pub(crate) usize);
