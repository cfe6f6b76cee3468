//! Settings: every one has a default in `strew.toml`, a meaning there, and a range beside its
//! field.
//!
//! Layers, the later the stronger: defaults, a file, the environment, flags. They are merged as
//! TOML by `layers` and read into [`Config`] once; the result is checked as a whole, and no
//! setting is checked again later. Also here: reading files of a bounded size ([`bounded_file`]), and the names that
//! keys, fields, worlds and layers may have ([`name`]).
//!
//! Depends on no other crate of Strew. Everything that has a setting may depend on it.

mod access;
pub mod bounded_file;
mod error;
mod layers;
mod limits;
mod lines;
mod listen;
mod loaded;
mod memory;
pub mod name;
mod networks;
mod range;
mod reports;
mod server;
mod validate;

use std::{path::PathBuf, time::Duration};

use serde::{Deserialize, Serialize};

pub use access::{Access, AddressLimits, Rate};
pub use limits::{Limits, Reload, Workers};
pub use loaded::{Except, Fields, Tables, Worlds};
pub use memory::Lowered;
pub use networks::{NETWORKS, Networks};
pub use reports::{Http, Log, LogFormat, LogOutput, Metrics, Telemetry};
pub use server::{Admin, Server, Shutdown, Tls};

pub use error::ConfigError;
pub use layers::Layers;

/// The defaults, with comments.
pub const DEFAULTS: &str = include_str!("../strew.toml");

/// All settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Addresses, connections and their times.
    pub server: Server,
    /// The certificates of the server and of clients.
    pub tls: Tls,
    /// The admission of clients.
    pub access: Access,
    /// The rate at which a client may take points.
    pub rate: Rate,
    /// The address of administrators.
    pub admin: Admin,
    /// Answers over HTTP.
    pub http: Http,
    /// The tables to load.
    pub tables: Tables,
    /// The fields to load.
    pub fields: Fields,
    /// The limits of queries and of memory.
    pub limits: Limits,
    /// The limits of one address.
    pub per_address: AddressLimits,
    /// The reloading of files.
    pub reload: Reload,
    /// The threads that make points.
    pub workers: Workers,
    /// The times of a shutdown.
    pub shutdown: Shutdown,
    /// The log.
    pub log: Log,
    /// The metrics.
    pub metrics: Metrics,
    /// The collector of spans.
    pub telemetry: Telemetry,
    /// The lists of points to load.
    pub except: Except,
    /// The worlds to load.
    pub worlds: Worlds,
    /// The files that settings were read from.
    #[serde(skip)]
    pub files: Vec<PathBuf>,
}

impl Config {
    /// The merged settings as TOML.
    ///
    /// # Errors
    /// Only if a path is not Unicode.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string_pretty(self)
    }
}

/// Seconds of a setting as a duration; settings are checked to be within range before.
pub fn seconds(value: f64) -> Duration {
    Duration::try_from_secs_f64(value).unwrap_or(Duration::MAX)
}
