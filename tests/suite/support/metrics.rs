//! Samples of `/metrics`.

use std::collections::BTreeMap;

use super::daemon::Daemon;

/// The samples of a daemon, by name with labels as written.
pub fn samples(daemon: &Daemon) -> BTreeMap<String, f64> {
    let answer = daemon.get("/metrics");
    assert_eq!(answer.status, 200);
    let content_type = answer.header("content-type");
    assert!(
        content_type.starts_with("text/plain; version=0.0.4"),
        "{content_type}"
    );
    assert_eq!(answer.header("cache-control"), "no-store");
    let lines = answer
        .text()
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    let sample = |line: &str| {
        let (name, value) = line.rsplit_once(' ').unwrap_or_else(|| panic!("{line}"));
        (
            name.to_owned(),
            value.parse().unwrap_or_else(|e| panic!("{line}: {e}")),
        )
    };
    lines.map(sample).collect()
}

/// The sum of the samples with this name and all of these labels.
pub fn sum(samples: &BTreeMap<String, f64>, name: &str, labels: &[&str]) -> f64 {
    let is_it = |sample: &str| {
        let own = sample.split_once('{').map_or(sample, |(own, _)| own);
        own == name && labels.iter().all(|label| sample.contains(label))
    };
    let of = samples.iter().filter(|(sample, _)| is_it(sample));
    of.map(|(_, value)| value).sum()
}
