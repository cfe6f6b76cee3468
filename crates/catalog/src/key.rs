//! The keys of tables, and where tables come from.

use std::{cmp::Ordering, fmt, path::PathBuf, sync::Arc};

use strew_core::{Alpha, map::Size};

/// The key of a table. Those of the plane come first, then all are in the order of their names, then
/// of their numbers.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    pub dimension: Dimension,
    pub profile: Arc<str>,
    pub alpha: Alpha,
    pub size: Size,
    /// The mix of kinds, if it has one.
    pub mix: Option<Arc<MixKey>>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MixKey {
    /// The shares of its kinds.
    pub shares: Box<[u16]>,
    /// The digest of its vectors: those of the plain table, or others.
    pub vectors: [u8; 32],
}

impl Ord for Key {
    fn cmp(&self, other: &Self) -> Ordering {
        let rank = |key: &Self| (key.alpha.half(), key.alpha, key.size);
        let by_name = self.profile.cmp(&other.profile);
        (self.dimension.cmp(&other.dimension))
            .then(by_name)
            .then_with(|| rank(self).cmp(&rank(other)))
            .then_with(|| self.mix.cmp(&other.mix))
    }
}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl MixKey {
    /// The shares as text, such as `1:3`.
    pub fn text(&self) -> String {
        let parts: Vec<String> = self.shares.iter().map(ToString::to_string).collect();
        parts.join(":")
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "profile `{}`, alpha {}, map {}",
            self.profile, self.alpha, self.size
        )?;
        if self.dimension == Dimension::Space {
            f.write_str(", in space")?;
        }
        match &self.mix {
            Some(mix) => write!(f, ", kinds {}", mix.text()),
            None => Ok(()),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    Embedded(&'static str),
    File(PathBuf),
    /// The memory of a program: the table of this number.
    Memory(usize),
    /// None: a pattern without displacements.
    Pattern,
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Embedded(name) => write!(f, "built-in {name}"),
            Self::File(path) => path.display().fmt(f),
            Self::Memory(number) => write!(f, "table {number} in memory"),
            Self::Pattern => f.write_str("derived from alpha"),
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Dimension {
    #[default]
    Plane,
    Space,
}

impl Dimension {
    pub const fn axes(self) -> u32 {
        match self {
            Self::Plane => 2,
            Self::Space => 3,
        }
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Plane => "plane",
            Self::Space => "space",
        })
    }
}
