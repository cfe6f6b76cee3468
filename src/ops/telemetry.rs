//! The log: on standard error by default, so that standard output stays for answers.
//!
//! As text for people or as JSON, an object a line, for programs that gather logs. Lines that a request causes have its
//! id, however little is logged: it is looked up when there is a line to write. Of events that may happen a thousand times
//! a second there is one line an interval, with their number.

use std::{
    fmt,
    io::IsTerminal as _,
    time::{Duration, Instant},
};

use parking_lot::Mutex;
use strew_config::{Log, LogFormat, LogOutput};
use strew_service::Record;
use tracing::{Event, Subscriber};
use tracing_subscriber::{
    filter::Targets,
    fmt::{
        FmtContext, FormatEvent, FormatFields,
        format::{self, Writer},
        writer::BoxMakeWriter,
    },
    layer::{Layer as _, SubscriberExt as _},
    registry::LookupSpan,
    util::SubscriberInitExt as _,
};

/// The target of access lines, which say more about their request than its id.
pub(super) const ACCESS: &str = "strew::access";

/// Starts logging; a second call changes nothing.
pub fn start(log: &Log) -> Result<(), tracing_subscriber::filter::ParseError> {
    let filter: Targets = log.filter.parse()?;
    let is_json = log.format == LogFormat::Json;
    let (is_terminal, writer) = match log.output {
        LogOutput::Stderr => (
            std::io::stderr().is_terminal(),
            BoxMakeWriter::new(std::io::stderr),
        ),
        LogOutput::Stdout => (
            std::io::stdout().is_terminal(),
            BoxMakeWriter::new(std::io::stdout),
        ),
    };
    let is_colored = !is_json && is_terminal;
    let lines = tracing_subscriber::fmt::layer()
        .with_writer(writer)
        .with_ansi(is_colored)
        // A line that cannot be written is lost: an error about it on the same stream would fail, too, and panic.
        .log_internal_errors(false);
    let registry = tracing_subscriber::registry();
    let _ = if is_json {
        let lines = lines
            .fmt_fields(format::JsonFields::new())
            .event_format(Named {
                inner: format::format().json().flatten_event(true),
                is_json,
            });
        registry.with(lines.with_filter(filter)).try_init()
    } else {
        let lines = lines.event_format(Named {
            inner: format::format().with_ansi(is_colored),
            is_json,
        });
        registry.with(lines.with_filter(filter)).try_init()
    };
    Ok(())
}

struct Named<F> {
    inner: F,
    is_json: bool,
}

impl<S, N, F> FormatEvent<S, N> for Named<F>
where
    S: Subscriber + for<'a> LookupSpan<'a>,
    N: for<'a> FormatFields<'a> + 'static,
    F: FormatEvent<S, N>,
{
    fn format_event(
        &self,
        context: &FmtContext<'_, S, N>,
        mut writer: Writer<'_>,
        event: &Event<'_>,
    ) -> fmt::Result {
        let record = Record::current().filter(|_| event.metadata().target() != ACCESS);
        let Some(record) = record else {
            return self.inner.format_event(context, writer, event);
        };
        let mut line = String::new();
        let inner = Writer::new(&mut line);
        self.inner.format_event(context, inner, event)?;
        let line = line.trim_end();
        // Ids are plain: nothing in them has to be escaped.
        let names = [
            ("request_id", Some(record.id())),
            ("trace_id", record.trace()),
        ];
        let names = names.into_iter().filter_map(|(name, id)| Some((name, id?)));
        if self.is_json {
            writer.write_str(line.strip_suffix('}').unwrap_or(line))?;
            for (name, id) in names {
                write!(writer, ",\"{name}\":\"{id}\"")?;
            }
            return writer.write_str("}\n");
        }
        writer.write_str(line)?;
        for (name, id) in names {
            write!(writer, " {name}=\"{id}\"")?;
        }
        writer.write_char('\n')
    }
}

const INTERVAL: Duration = Duration::from_secs(10);

#[derive(Debug, Default)]
pub(super) struct LogThrottle {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    count: u64,
    logged: Option<Instant>,
}

impl LogThrottle {
    /// Records one event. Returns the number of events since the last line if it is time for
    /// another.
    pub(super) fn record(&self) -> Option<u64> {
        let mut state = self.state.lock();
        state.count += 1;
        if state.logged.is_some_and(|at| at.elapsed() < INTERVAL) {
            return None;
        }
        state.logged = Some(Instant::now());
        Some(std::mem::take(&mut state.count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_event_is_logged_and_the_next_are_counted() {
        let throttle = LogThrottle::default();
        assert_eq!(throttle.record(), Some(1));
        assert_eq!([throttle.record(), throttle.record()], [None, None]);
        let earlier = Instant::now().checked_sub(INTERVAL);
        throttle.state.lock().logged = earlier;
        let expected = if earlier.is_some() { 3 } else { 4 };
        assert_eq!(throttle.record(), Some(expected));
    }
}
