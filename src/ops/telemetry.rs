//! The log: on standard error, so that standard output stays for answers.
//!
//! As text for people or as JSON, an object a line, for programs that gather logs.

use std::io::IsTerminal as _;

use strew_config::LogFormat;
use tracing_subscriber::EnvFilter;

/// Starts logging. The filter is a level or levels by module; a second call changes nothing.
///
/// # Errors
/// If the filter does not read.
pub fn start(
    filter: &str,
    format: LogFormat,
) -> Result<(), tracing_subscriber::filter::ParseError> {
    let filter: EnvFilter = filter.parse()?;
    let lines = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        // A line that cannot be written is lost: an error about it on the same stream would fail, too, and panic.
        .log_internal_errors(false);
    let _ = match format {
        LogFormat::Text => lines.with_ansi(std::io::stderr().is_terminal()).try_init(),
        LogFormat::Json => lines
            .json()
            .flatten_event(true)
            .with_span_list(false)
            .try_init(),
    };
    Ok(())
}
