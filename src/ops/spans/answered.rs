//! A request that has ended, with all that a span says about it.

use std::net::SocketAddr;

use crate::ops::{identity::Trace, metrics::Broken};

/// The facts about a request and its answer.
#[derive(Clone, Debug)]
#[cfg_attr(
    not(feature = "otlp"),
    expect(dead_code, reason = "only an exporter reads it")
)]
pub(in crate::ops) struct Answered<'a> {
    pub(in crate::ops) trace: &'a Trace,
    pub(in crate::ops) request_id: &'a str,
    /// A call's path, or `None` for what is no call.
    pub(in crate::ops) call: Option<&'a str>,
    /// The route; `None` where there is none.
    pub(in crate::ops) route: Option<&'a str>,
    pub(in crate::ops) method: &'static str,
    /// Path and query.
    pub(in crate::ops) address: &'a str,
    pub(in crate::ops) client: Option<SocketAddr>,
    pub(in crate::ops) status: Option<u16>,
    pub(in crate::ops) code: Option<u32>,
    pub(in crate::ops) reason: Option<&'static str>,
    pub(in crate::ops) broken: Option<Broken>,
    pub(in crate::ops) format: Option<&'static str>,
    pub(in crate::ops) points: u64,
    pub(in crate::ops) bytes: u64,
    /// Seconds to the first byte, and to the end.
    pub(in crate::ops) first_byte: f64,
    pub(in crate::ops) total: f64,
}
