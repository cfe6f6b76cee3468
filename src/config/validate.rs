//! The ranges of settings.

use super::{Config, ConfigError, NETWORKS, Networks};

/// Checks every setting; reports all that are out of range.
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
        presets: _,
    } = config;
    let mut faults = vec![];
    let mut within = |key: &str, value: f64, min: f64, max: f64| {
        if !(min..=max).contains(&value) {
            faults.push(format!("{key} = {value}; allowed: {min} to {max}"));
        }
    };
    let (second, hour, day) = (1.0, 3600.0, 86400.0);
    within(
        "server.max_connections",
        server.max_connections as f64,
        1.0,
        1e6,
    );
    within(
        "server.header_read_timeout_seconds",
        server.header_read_timeout_seconds,
        0.1 * second,
        hour,
    );
    // Below 8192 the HTTP library refuses; 16 MiB a connection is more than any head needs.
    within(
        "server.max_header_bytes",
        f64::from(server.max_header_bytes),
        8192.0,
        f64::from(16 << 20),
    );
    within(
        "server.max_requests_per_connection",
        f64::from(server.max_requests_per_connection),
        1.0,
        1e6,
    );
    within(
        "server.http2_keepalive_seconds",
        server.http2_keepalive_seconds,
        second,
        hour,
    );
    within(
        "server.idle_connection_seconds",
        server.idle_connection_seconds,
        0.1 * second,
        day,
    );
    within(
        "server.stalled_reader_seconds",
        server.stalled_reader_seconds,
        0.1 * second,
        day,
    );
    within(
        "server.min_bytes_per_second",
        server.min_bytes_per_second,
        0.0,
        1e9,
    );
    within(
        "server.body_read_timeout_seconds",
        server.body_read_timeout_seconds,
        0.1 * second,
        hour,
    );
    within(
        "server.first_byte_seconds",
        server.first_byte_seconds,
        0.1 * second,
        hour,
    );
    within(
        "server.max_stream_seconds",
        server.max_stream_seconds,
        0.1 * second,
        365.0 * day,
    );
    within(
        "http.cache_seconds",
        f64::from(http.cache_seconds),
        0.0,
        365.0 * day,
    );
    within("reload.watch_seconds", reload.watch_seconds, 0.0, day);
    within("rate.points_per_second", rate.points_per_second, 0.0, 1e15);
    within("rate.burst_points", rate.burst_points, 0.0, 1e15);
    within("rate.max_clients", rate.max_clients as f64, 64.0, 1e7);
    within("limits.max_points", limits.max_points as f64, 1.0, 1e15);
    within("limits.max_rows", limits.max_rows as f64, 1.0, 1e12);
    within("limits.max_vertices", limits.max_vertices as f64, 3.0, 1e8);
    within(
        "limits.max_body_bytes",
        limits.max_body_bytes as f64,
        1024.0,
        f64::from(1 << 30),
    );
    within("limits.max_requests", limits.max_requests as f64, 1.0, 1e6);
    // At least one answer and one query of the largest size fit.
    let one = 4 * limits.block_bytes + (19 << 20) + limits.max_body_bytes;
    within(
        "limits.max_bytes_in_flight",
        limits.max_bytes_in_flight as f64,
        one as f64,
        1e15,
    );
    for (name, value) in [
        ("max_connections", per_address.max_connections),
        ("max_requests", per_address.max_requests),
        ("max_streams", per_address.max_streams),
    ] {
        within(&format!("per_address.{name}"), value as f64, 1.0, 1e6);
    }
    within(
        "per_address.max_bytes_in_flight",
        per_address.max_bytes_in_flight as f64,
        one as f64,
        1e15,
    );
    within("limits.max_streams", limits.max_streams as f64, 1.0, 1e6);
    // gRPC clients refuse messages above 4 MiB, and ours stay below 1 MiB.
    within(
        "limits.block_bytes",
        limits.block_bytes as f64,
        4096.0,
        f64::from(512 << 10),
    );
    within("limits.cache_bytes", limits.cache_bytes as f64, 0.0, 1e15);
    within("workers.threads", workers.threads as f64, 0.0, 1024.0);
    within("telemetry.sample_ratio", telemetry.sample_ratio, 0.0, 1.0);
    within(
        "telemetry.max_queued_spans",
        telemetry.max_queued_spans as f64,
        1.0,
        1e6,
    );
    within(
        "telemetry.export_timeout_seconds",
        telemetry.export_timeout_seconds,
        0.1 * second,
        hour,
    );
    within("shutdown.notice_seconds", shutdown.notice_seconds, 0.0, day);
    within("shutdown.drain_seconds", shutdown.drain_seconds, 0.0, day);
    faults.extend(telemetry.fault());
    if let Err(part) = Networks::read(&access.trusted_proxies) {
        faults.push(format!(
            "access.trusted_proxies = {:?}: {part:?} is not one; allowed: {NETWORKS}",
            access.trusted_proxies
        ));
    }
    if let Err(error) = admin.address() {
        faults.push(format!("admin.listen: {error}, or nothing"));
    }
    let wrong = http.origins().find(|origin| !is_origin(origin));
    if let Some(origin) = wrong.filter(|_| http.cors_origins.trim() != "*") {
        faults.push(format!(
            "http.cors_origins = {:?}: {origin:?} is not an origin; allowed: * or origins such as \
             https://a.example and http://localhost:3000, with spaces or commas between them",
            http.cors_origins
        ));
    }
    let is_set = |path: &std::path::Path| !path.as_os_str().is_empty();
    let of_tls = [&tls.certificate, &tls.key, &tls.client_ca].map(|path| is_set(path));
    if let [certificate, key, client_ca] = of_tls
        && (certificate != key || client_ca && !key)
    {
        faults.push(format!(
            "tls.certificate = {:?}, tls.key = {:?}, tls.client_ca = {:?}; allowed: none of them, the \
             first two, or all",
            tls.certificate, tls.key, tls.client_ca
        ));
    }
    if let Err(error) = log.filter.parse::<tracing_subscriber::EnvFilter>() {
        faults.push(format!(
            "log.filter = {:?}; allowed: a level (error, warn, info, debug, trace) or levels by \
             module (info,strew=debug): {error}",
            log.filter
        ));
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(ConfigError::OutOfRange { faults })
    }
}

/// Whether a text is an origin as browsers send it: a scheme, a host, perhaps a port.
fn is_origin(text: &str) -> bool {
    let Some((scheme, authority)) = text.split_once("://") else {
        return false;
    };
    let is_scheme = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
    let is_host = |c: char| c.is_ascii_alphanumeric() || "-._[]:".contains(c);
    !scheme.is_empty()
        && scheme.chars().all(is_scheme)
        && !authority.is_empty()
        && authority.chars().all(is_host)
}
