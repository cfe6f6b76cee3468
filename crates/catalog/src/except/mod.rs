//! Points that were taken away: lists of ids that answers leave out.
//!
//! A query names ids, and lists of the configuration, of a folder or of a client. A point that was taken away keeps its
//! place: other layers still keep clear of it, and the attributes and ids of others stay. So nothing appears where a
//! tree was felled. [`Except`] has the points that one set lacks.

mod list;

use std::{fmt, ops::Range, str::FromStr, sync::Arc};

use strew_core::{PointId, space};
use strew_error::Fault;

pub use list::{Lists, NamedList, Section, split};

pub const MOST_GIVEN: usize = 10_000;

/// The id of a point of the plane or in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Id {
    Plane(PointId),
    Space(space::PointId),
}

impl FromStr for Id {
    type Err = strew_core::Error;

    fn from_str(text: &str) -> Result<Self, strew_core::Error> {
        let in_space = text.parse().map(Self::Space);
        in_space.or_else(|_| text.parse().map(Self::Plane))
    }
}

impl fmt::Display for Id {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plane(id) => id.fmt(f),
            Self::Space(id) => id.fmt(f),
        }
    }
}

/// Sorted ids, each once, with their digest.
#[derive(Clone, Debug, PartialEq)]
pub struct Ids {
    plane: Arc<[PointId]>,
    space: Arc<[space::PointId]>,
    digest: String,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Except {
    /// The ids of the query, which must be points of the set, each with the name of its field.
    pub given: Vec<(String, Id)>,
    pub names: Vec<String>,
    /// Whether the name of one may stand for another list later.
    pub may_change: bool,
    pub parts: Vec<Arc<Ids>>,
}

impl Ids {
    pub fn new(ids: Vec<Id>) -> Self {
        let (mut plane, mut space) = (vec![], vec![]);
        for id in ids {
            match id {
                Id::Plane(id) => plane.push(id),
                Id::Space(id) => space.push(id),
            }
        }
        plane.sort_unstable();
        plane.dedup();
        space.sort_unstable();
        space.dedup();
        let mut hasher = blake3::Hasher::new();
        for v in plane.iter().flat_map(|id| [id.x, id.y]) {
            hasher.update(&v.to_le_bytes());
        }
        if !space.is_empty() {
            hasher.update(b"in space");
        }
        for v in space
            .iter()
            .flat_map(|id: &space::PointId| [id.x, id.y, id.z])
        {
            hasher.update(&v.to_le_bytes());
        }
        Self {
            digest: hasher.finalize().to_hex().to_string(),
            plane: plane.into(),
            space: space.into(),
        }
    }

    pub fn len(&self) -> usize {
        self.plane.len() + self.space.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The memory that they take, in bytes.
    pub(super) fn size(&self) -> usize {
        size_of_val(&*self.plane) + size_of::<space::PointId>() * self.space.len()
    }

    /// Those of points of the plane, sorted.
    pub const fn in_plane(&self) -> &Arc<[PointId]> {
        &self.plane
    }

    /// Those of points in space, sorted.
    pub const fn in_space(&self) -> &Arc<[space::PointId]> {
        &self.space
    }

    /// The digest of all of them, in hexadecimal.
    pub fn digest(&self) -> &str {
        &self.digest
    }
}

impl Except {
    /// The number of ids in some columns of the lattice.
    pub fn within(&self, columns: &Range<i64>) -> usize {
        fn count<T>(ids: &[T], columns: &Range<i64>, x: impl Fn(&T) -> i64) -> usize {
            let [start, end] =
                [columns.start, columns.end].map(|first| ids.partition_point(|id| x(id) < first));
            end.saturating_sub(start)
        }
        let of = |part: &Arc<Ids>| {
            count(&part.plane, columns, |id| id.x) + count(&part.space, columns, |id| id.x)
        };
        self.parts.iter().map(of).sum()
    }

    /// The digest of all ids, in hexadecimal.
    pub fn digest(&self) -> String {
        match self.parts.as_slice() {
            [only] => only.digest.clone(),
            parts => {
                let mut hasher = blake3::Hasher::new();
                for part in parts {
                    hasher.update(part.digest.as_bytes());
                }
                hasher.finalize().to_hex().to_string()
            }
        }
    }

    /// Refuses ids of the query that `has` says are no points of a set's table. Those that the set leaves out anyway, by
    /// its share or its field, are allowed.
    pub fn check(&self, layer: &str, has: impl Fn(Id) -> bool) -> Result<(), Fault> {
        let wrong = self.given.iter().find(|(_, id)| !has(*id));
        let Some((field, id)) = wrong else {
            return Ok(());
        };
        let detail = match layer {
            "" => "this set has no such point".to_owned(),
            layer => format!("the layer {layer} has no such point"),
        };
        Err(Fault::new(field, id, detail, "ids of points of this set"))
    }
}
