//! Checking merged settings. What is allowed is written beside the settings.

use super::{Config, ConfigError};

/// Checks every setting; reports all that are not allowed.
pub(super) fn validate(config: &Config) -> Result<(), ConfigError> {
    let Config {
        server,
        tls,
        access,
        rate,
        admin,
        http,
        limits,
        per_address,
        workers,
        shutdown,
        log,
        metrics: _,
        telemetry,
        reload,
        tables: _,
        fields: _,
        // Checked with the tables at hand.
        except,
        worlds: _,
        files: _,
    } = config;
    let faults = [
        server.faults(),
        tls.faults(),
        access.faults(),
        rate.faults(),
        admin.faults(),
        http.faults(),
        limits.faults(),
        per_address.faults(limits),
        workers.faults(),
        shutdown.faults(),
        log.faults(),
        telemetry.faults(),
        reload.faults(),
        except.faults(),
    ]
    .concat();
    if faults.is_empty() {
        Ok(())
    } else {
        Err(ConfigError::OutOfRange { faults })
    }
}
