//! Displacement tables: one vector per block of a neighborhood map.
//!
//! A table with the pattern of its α makes a point set: position = scale · ((x, y) +
//! D\[block(dY)\]\[block(dX)\]). Vectors are fixed point, so that a table means the same everywhere.

mod digest;
mod error;
mod file;
mod provenance;
mod text;
mod wire;

use alloc::{string::String, vec, vec::Vec};

use crate::{map::Map, pattern::Alpha};

pub use digest::Digest;
pub use error::TableError;
pub use file::{FORMAT_VERSION, MAX_FILE_BYTES};
pub use provenance::{Figures, Provenance};

/// Fraction bits of every coordinate: one unit is 2⁻²⁰ grid units, about 3·10⁻⁷ mean spacings.
///
/// Fine enough that its rounding adds less than 10⁻¹² to the low-frequency power, and coarse enough
/// that all coordinates of a tile fit 32-bit lanes.
pub const FRACTION_BITS: u32 = 20;

/// The largest displacement along an axis, in grid units (exclusive). Published tables stay within
/// 13; vectors longer than the map's half-width would outrun what a block knows.
pub const MAX_DISPLACEMENT: f64 = 127.0;

/// A displacement in units of 2⁻²⁰ grid units.
pub type Displacement = [i32; 2];

/// The displacement vectors of one noise profile for one neighborhood map, with their history.
///
/// Immutable: what is made or read here has been checked, and its digest names it.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    map: Map,
    profile: String,
    displacements: Vec<Displacement>,
    provenance: Provenance,
    digest: Digest,
}

impl Table {
    /// A table from its parts: `displacements` holds n² vectors, row = interval of dY, column =
    /// interval of dX, in units of 2⁻²⁰ grid units.
    ///
    /// # Errors
    /// [`TableError`] for a wrong number of vectors, a vector of [`MAX_DISPLACEMENT`] or more, a
    /// profile name that is not 1 to 32 of `a-z 0-9 -`, or a history beyond the format's limits.
    pub fn new(
        map: Map,
        profile: &str,
        displacements: Vec<Displacement>,
        provenance: Provenance,
    ) -> Result<Self, TableError> {
        let expected = map.intervals() * map.intervals();
        if displacements.len() != expected {
            return Err(TableError::Field {
                field: "displacements",
                value: alloc::format!("{} vectors", displacements.len()),
                allowed: alloc::format!("{expected} vectors, the number of blocks"),
            });
        }
        let limit = (MAX_DISPLACEMENT as i32) << FRACTION_BITS;
        let too_long = |d: &Displacement| d.iter().any(|v| !(-limit < *v && *v < limit));
        if let Some(block) = displacements.iter().position(too_long) {
            let [x, y] = displacements[block].map(to_grid_units);
            return Err(TableError::Field {
                field: "displacements",
                value: alloc::format!("({x}, {y}) in block {block}"),
                allowed: alloc::format!("less than {MAX_DISPLACEMENT} grid units along an axis"),
            });
        }
        check_profile(profile)?;
        provenance.check()?;
        let mut table = Self {
            map,
            profile: profile.into(),
            displacements,
            provenance,
            digest: Digest::default(),
        };
        table.digest = file::digest(&table)?;
        Ok(table)
    }

    /// The table without displacements: the AA pattern itself.
    ///
    /// # Errors
    /// [`TableError`] if `radius` is too large or the profile name is not allowed.
    pub fn undisplaced(alpha: Alpha, radius: u32, profile: &str) -> Result<Self, TableError> {
        let map = Map::new(alpha, radius)?;
        let blocks = map.intervals() * map.intervals();
        let provenance = Provenance {
            optimizer: "none".into(),
            ..Provenance::default()
        };
        Self::new(map, profile, vec![[0, 0]; blocks], provenance)
    }

    /// Reads a table file and checks everything in it: see [`TableError`] for what can be wrong.
    ///
    /// # Errors
    /// [`TableError`], saying what is wrong where.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, TableError> {
        file::read(bytes)
    }

    /// The table as a file. The same table always gives the same bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        file::write(self)
    }

    /// The neighborhood map whose blocks the vectors belong to.
    #[must_use]
    pub const fn map(&self) -> &Map {
        &self.map
    }

    /// The number α.
    #[must_use]
    pub const fn alpha(&self) -> Alpha {
        self.map.alpha()
    }

    /// The name of the noise profile.
    #[must_use]
    pub fn profile(&self) -> &str {
        &self.profile
    }

    /// All n² vectors, row = interval of dY, column = interval of dX.
    #[must_use]
    pub fn displacements(&self) -> &[Displacement] {
        &self.displacements
    }

    /// How the table was made, and what was measured on it.
    #[must_use]
    pub const fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// BLAKE3 over the file: the table's name in answers.
    #[must_use]
    pub const fn digest(&self) -> Digest {
        self.digest
    }
}

/// A fixed-point coordinate in grid units.
#[must_use]
pub fn to_grid_units(fixed: i32) -> f64 {
    f64::from(fixed) / f64::from(1 << FRACTION_BITS)
}

/// The nearest fixed-point coordinate to one in grid units, or `None` at [`MAX_DISPLACEMENT`] and
/// beyond (or not a number).
#[must_use]
pub fn from_grid_units(value: f64) -> Option<i32> {
    let in_range = value > -MAX_DISPLACEMENT && value < MAX_DISPLACEMENT;
    in_range.then(|| libm::round(value * f64::from(1 << FRACTION_BITS)) as i32)
}

fn check_profile(name: &str) -> Result<(), TableError> {
    let allowed = |c: u8| c.is_ascii_lowercase() || c.is_ascii_digit() || c == b'-';
    if (1..=32).contains(&name.len()) && name.bytes().all(allowed) {
        return Ok(());
    }
    Err(TableError::Field {
        field: "profile",
        value: alloc::format!("{name:?}"),
        allowed: "1 to 32 characters of a-z, 0-9 and -".into(),
    })
}
