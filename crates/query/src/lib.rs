//! Queries: from raw parameters, a JSON body or typed fields to a checked [`Query`].
//!
//! [`parameters`] is the table of all parameters. Addresses ([`parse_pairs`]), bodies ([`read_body`]), flags and
//! messages become [`Values`], each read by the parameter's [`Shape`]; with a region and layers they are a [`Draft`].
//! The one way on is [`Draft::check`] against [`Assets`]; beyond it nothing is checked again. It reports every fault it
//! finds, so that a client needs one round to learn them all. A [`Set`] keeps its values with everything filled in:
//! echoes and identities are loops over them. [`Worlds`] are queries that are described once. Depends on the catalog,
//! the names of formats and the words of faults; plans nothing.

#![allow(missing_docs, reason = "internal: names say what items are")]

mod amount;
mod assets;
mod attributes;
mod check;
mod cursor;
mod defaults;
mod depends;
mod draft;
mod echo;
mod except;
mod features;
mod field;
mod json;
mod kinds;
mod layer;
mod lists;
mod lookup;
mod nearest;
mod options;
mod parameter;
pub mod parameters;
pub mod patterns;
mod period;
mod plane;
mod query;
#[cfg(test)]
mod recipe;
mod region;
mod region_check;
pub mod rules;
mod schema;
mod set;
mod set_check;
mod shape;
mod space;
mod spread;
mod table;
mod terrain;
mod text;
mod value;
mod values;
pub mod world;

pub use amount::Amount;
pub use assets::Assets;
pub use cursor::Token;
pub use defaults::{
    DEFAULT_ALPHA, DEFAULT_PROFILE, MOST_FEATURES, MOST_LAYERS, MOST_LEVELS, MOST_NAMES,
    MOST_PARTS, MOST_REGIONS,
};
pub use draft::{Draft, entry, options, parts};
pub use echo::{Echoed, KindDistance, Resolved, ResolvedSet};
pub use features::Feature;
pub use field::SetField;
pub use json::{RegionSchema, VolumeSchema, read_body, read_features, read_members, read_region};
pub use kinds::{Kinds, other_kinds};
pub use layer::LayerDraft;
pub use lookup::of;
pub use nearest::Nearest;
pub use options::Options;
pub use parameter::{Group, Parameter, groups};
pub use period::{Period, PeriodEcho, Periods};
pub use query::{Named, Query, Window};
pub use region::{RegionDraft, Rings, ShapeDraft};
pub use region_check::{QueryRegion, QueryVolume};
pub use schema::{NAME, TITLE, integer, schema};
pub use set::Set;
pub use shape::Shape;
pub use space::{BALL, BOX, SPACE_AT, SPACE_ATTRIBUTES, SPACE_PARAMETERS};
pub use spread::Spread;
pub use table::chosen;
pub use terrain::Terrain;
pub use text::parse_pairs;
pub use value::Value;
pub use values::Values;
pub use world::{World, Worlds};
