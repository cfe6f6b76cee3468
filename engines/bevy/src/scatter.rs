//! The components and resources that a game sets.

use std::{fmt, sync::Arc};

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::Transform;
use strew_core::{PointSet, Region};

use crate::chunk::Chunks;

/// A point set laid on the ground, loaded around each [`ScatterAnchor`].
///
/// The set's x and y are world units on the ground, from the origin of the world. The entity itself stays at the origin.
/// Inserting another scatter replaces all chunks.
///
/// ```
/// use strew_bevy::{Ground, Level, Scatter};
/// use strew_core::{Kinds, PointSet};
///
/// let trees = PointSet::blue().spacing(4.0)?.seed(7);
/// let hills = |[x, y]: [f64; 2]| (0.1 * (x + y).sin()) as f32;
/// let scatter = Scatter::new(trees, 32.0, [Level::new(100.0, 1.0), Level::new(300.0, 0.25)])?
///     .on(Ground::Xz)
///     .at_height(hills)
///     .with_margin(8.0);
/// assert_eq!(scatter.radius(), 300.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Component, Clone)]
#[require(Transform, Chunks)]
pub struct Scatter {
    /// The set of all points, whatever the levels show.
    pub(crate) all: PointSet,
    pub(crate) chunk: f64,
    pub(crate) levels: Arc<[Leveled]>,
    pub(crate) margin: f64,
    pub(crate) ground: Ground,
    pub(crate) height: Option<Arc<Height>>,
    pub(crate) is_listed: bool,
}

/// The most chunks from an anchor to the radius: what is looked at in each frame.
const MOST_CHUNKS: f64 = 64.0;

/// The reason why a scatter was refused.
#[derive(Clone, Debug, PartialEq)]
pub enum ScatterError {
    /// The side of chunks or a share, in the words of the set.
    Set(strew_core::Error),
    /// The distance of a level.
    Levels {
        /// The number of the level, from 0.
        level: usize,
        /// The distance it had.
        value: String,
        /// The allowed distances.
        allowed: String,
    },
}

impl fmt::Display for ScatterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Set(error) => error.fmt(f),
            Self::Levels {
                level,
                value,
                allowed,
            } => write!(
                f,
                "the distance of level {level} is {value}; it must be {allowed}"
            ),
        }
    }
}

impl std::error::Error for ScatterError {}

impl From<strew_core::Error> for ScatterError {
    fn from(error: strew_core::Error) -> Self {
        Self::Set(error)
    }
}

/// The height of the ground at a place of the set, in world units.
type Height = dyn Fn([f64; 2]) -> f32 + Send + Sync;

/// A level of detail: the distance from the anchor out to which chunks have it, and their share of the points.
///
/// ```
/// use strew_bevy::Level;
///
/// let far = Level::new(300.0, 0.25);
/// assert_eq!((far.distance, far.share), (300.0, 0.25));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// The distance of a chunk's nearest corner or edge, in world units; above that of the level before.
    pub distance: f64,
    /// The share of the set's points, from 10⁻⁶ to 1: those of lowest rank, so levels nest.
    pub share: f64,
}

impl Level {
    /// A level out to a distance, with a share of the points.
    #[must_use]
    pub const fn new(distance: f64, share: f64) -> Self {
        Self { distance, share }
    }
}

/// A level of a scatter: out to which distance, and the set with the points of its share.
pub(crate) struct Leveled {
    pub(crate) distance: f64,
    pub(crate) set: PointSet,
}

/// The plane on which points lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ground {
    /// Of three dimensions with y up: the set's y becomes −z, so that, seen from above, the plane is not mirrored.
    #[default]
    Xz,
    /// Of two dimensions: the set's x and y.
    Xy,
}

impl Ground {
    /// The place of a point on the ground.
    pub(crate) const fn place(self, [x, y]: [f32; 2], height: f32) -> Vec3 {
        match self {
            Self::Xz => Vec3::new(x, height, -y),
            Self::Xy => Vec3::new(x, y, height),
        }
    }

    /// The place in the set below an entity.
    pub(crate) const fn below(self, at: Vec3) -> [f64; 2] {
        match self {
            Self::Xz => [at.x as f64, -at.z as f64],
            Self::Xy => [at.x as f64, at.y as f64],
        }
    }
}

impl Scatter {
    /// A set in square chunks with sides of `chunk` world units, loaded out to the distance of the last level, at most
    /// 64 chunks. Sets with [kinds](PointSet::kinds) have those as [`ScatterPoint::kind`](crate::ScatterPoint::kind).
    ///
    /// # Errors
    /// [`ScatterError::Set`] for the side of chunks and for shares, [`ScatterError::Levels`] unless there are levels
    /// whose distances ascend from above 0 to 64 chunks.
    ///
    /// ```
    /// use strew_bevy::{Level, Scatter, ScatterError};
    /// use strew_core::PointSet;
    ///
    /// let refused = |levels: &[Level]| Scatter::new(PointSet::blue(), 32.0, levels.iter().copied()).unwrap_err();
    /// assert!(matches!(refused(&[]), ScatterError::Levels { .. }));
    /// let error = refused(&[Level::new(9.0, 1.0), Level::new(9.0, 0.5)]);
    /// assert_eq!(error.to_string(), "the distance of level 1 is 9; it must be above 9 and at most 2048, 64 chunks");
    /// assert!(matches!(refused(&[Level::new(9.0, 2.0)]), ScatterError::Set(_)));
    /// ```
    pub fn new(
        set: PointSet,
        chunk: f64,
        levels: impl IntoIterator<Item = Level>,
    ) -> Result<Self, ScatterError> {
        Region::chunk(chunk, [0, 0])?;
        let (mut of_levels, mut last) = (Vec::new(), 0.0);
        for (level, Level { distance, share }) in levels.into_iter().enumerate() {
            let most = MOST_CHUNKS * chunk;
            if !(distance > last && distance <= most) {
                let value = format!("{distance}");
                let allowed = format!("above {last} and at most {most}, {MOST_CHUNKS} chunks");
                return Err(ScatterError::Levels {
                    level,
                    value,
                    allowed,
                });
            }
            last = distance;
            let set = set.clone().lod(share)?;
            of_levels.push(Leveled { distance, set });
        }
        if of_levels.is_empty() {
            let (value, allowed) = (
                "missing".into(),
                "there: a scatter has one level at least".into(),
            );
            return Err(ScatterError::Levels {
                level: 0,
                value,
                allowed,
            });
        }
        Ok(Self {
            all: set,
            chunk,
            levels: of_levels.into(),
            margin: 0.25 * chunk,
            ground: Ground::default(),
            height: None,
            is_listed: false,
        })
    }

    /// Lays the points on another plane than x and z.
    #[must_use]
    pub fn on(self, ground: Ground) -> Self {
        Self { ground, ..self }
    }

    /// Sets the height of points, a function of the place in the set. It is called in tasks.
    #[must_use]
    pub fn at_height(self, height: impl Fn([f64; 2]) -> f32 + Send + Sync + 'static) -> Self {
        let height: Arc<Height> = Arc::new(height);
        Self {
            height: Some(height),
            ..self
        }
    }

    /// Sets how much farther than a level's distance a chunk must be to leave the level, in world units; 0 and more.
    /// So an anchor that goes to and fro loads nothing anew. By default a quarter of a chunk.
    #[must_use]
    pub fn with_margin(self, margin: f64) -> Self {
        let margin = margin.max(0.0);
        Self { margin, ..self }
    }

    /// Leaves the points of each chunk in a [`ScatterPoints`](crate::ScatterPoints) instead of entities of their own.
    #[must_use]
    pub fn as_lists(self) -> Self {
        Self {
            is_listed: true,
            ..self
        }
    }

    /// The distance out to which chunks are loaded, that of the last level.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.levels.last().map_or(0.0, |level| level.distance)
    }

    /// The set of all points of a level, 0 for the nearest; `None` past the last one.
    #[must_use]
    pub fn set(&self, level: usize) -> Option<&PointSet> {
        self.levels.get(level).map(|level| &level.set)
    }

    /// The first level whose distance, with a margin, reaches as far.
    pub(crate) fn level(&self, distance: f64, margin: f64) -> Option<usize> {
        let mut levels = self.levels.iter();
        levels.position(|level| distance <= level.distance + margin)
    }
}

impl fmt::Debug for Scatter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scatter")
            .field("chunk", &self.chunk)
            .field("radius", &self.radius())
            .field("ground", &self.ground)
            .finish_non_exhaustive()
    }
}

/// An entity around which chunks are loaded, such as the camera. With several, a chunk has the level of the nearest.
#[derive(Component, Clone, Copy, Debug, Default)]
#[require(Transform)]
pub struct ScatterAnchor;

/// The most work of one frame, of all scatters together.
///
/// ```
/// use bevy_app::App;
/// use strew_bevy::ScatterBudget;
///
/// let mut app = App::new();
/// app.insert_resource(ScatterBudget { tasks: 2, ..ScatterBudget::default() });
/// ```
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScatterBudget {
    /// The most chunks that are made at once, in tasks. By default 8.
    pub tasks: usize,
    /// The most points that become entities or cease to be, or join or leave lists, in one frame. A chunk that goes
    /// takes all of its points along, so a frame may exceed it by those of one chunk. By default 4096.
    pub points: usize,
}

impl Default for ScatterBudget {
    fn default() -> Self {
        Self {
            tasks: 8,
            points: 4096,
        }
    }
}
