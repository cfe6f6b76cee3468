//! Settings: every one has a default in `strew.toml`, a meaning there, and a range in `validate`.
//!
//! Layers, the later the stronger: defaults, a file, the environment, flags. They are merged as
//! TOML by `layers` and read into [`Config`] once; the result is checked as a whole, and no
//! setting is checked again later. Also here: reading files of a bounded size ([`bounded_file`]), and the names that
//! keys, fields, worlds and layers may have ([`name`]).
//!
//! Depends on no other crate of Strew. Everything that has a setting may depend on it.

#![allow(missing_docs, reason = "internal: names say what items are")]

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
mod reports;
mod server;
mod validate;

use std::time::Duration;

use serde::{Deserialize, Serialize};

pub use access::{Access, AddressLimits, Rate};
pub use limits::{Limits, Reload, Workers};
pub use loaded::{Except, Fields, Tables, Worlds};
pub use memory::Lowered;
pub use networks::{NETWORKS, Networks};
pub use reports::{Http, Log, LogFormat, LogOutput, Metrics, Telemetry};
pub use server::{Admin, Server, Shutdown, Tls};

pub use error::ConfigError;
pub use layers::{DEFAULTS, Layers};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    pub server: Server,
    pub tls: Tls,
    pub access: Access,
    pub rate: Rate,
    pub admin: Admin,
    pub http: Http,
    pub tables: Tables,
    pub fields: Fields,
    pub limits: Limits,
    pub per_address: AddressLimits,
    pub reload: Reload,
    pub workers: Workers,
    pub shutdown: Shutdown,
    pub log: Log,
    pub metrics: Metrics,
    pub telemetry: Telemetry,
    pub except: Except,
    pub worlds: Worlds,
    /// What these settings were read from.
    #[serde(skip)]
    pub layers: Layers,
}

impl Config {
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string_pretty(self)
    }
}

/// Seconds of a setting as a duration; settings are checked to be within range before.
pub fn seconds(value: f64) -> Duration {
    Duration::try_from_secs_f64(value).unwrap_or(Duration::MAX)
}
