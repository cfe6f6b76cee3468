//! In the place of an exporter, in a program without the feature `otlp`: a collector is refused at the
//! start, and so there are never any spans.

use strew_config::Telemetry as Settings;

use super::{Answered, SpansError};
use crate::ops::metrics::Metrics;

/// There is none.
#[derive(Debug)]
pub(in crate::ops) enum Collector {}

impl Collector {
    /// Refuses a collector.
    pub(in crate::ops) fn new(settings: &Settings) -> Result<Option<Self>, SpansError> {
        let endpoint = &settings.otlp_endpoint;
        if endpoint.is_empty() {
            return Ok(None);
        }
        Err(SpansError {
            setting: "telemetry.otlp_endpoint",
            value: endpoint.clone(),
            problem:
                "this program was built without the feature otlp; allowed: \"\", or a program that \
                      was built with it (cargo build --release --features otlp)"
                    .into(),
        })
    }

    pub(in crate::ops) const fn start(&self, _: &Metrics) -> Result<(Spans, Sending), SpansError> {
        match *self {}
    }
}

/// There are none.
#[derive(Clone, Debug)]
pub(in crate::ops) enum Spans {}

impl Spans {
    pub(in crate::ops) const fn begins_one(&self) -> bool {
        match *self {}
    }

    pub(in crate::ops) const fn take(&self, _: &Answered<'_>) {
        match *self {}
    }
}

/// Nothing is sent.
#[derive(Debug)]
pub(in crate::ops) enum Sending {}

impl Sending {
    pub(in crate::ops) async fn finish(self) {
        match self {}
    }
}
