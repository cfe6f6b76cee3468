//! Names that are not known.

/// Words for an unknown name, with the known one that is most like it.
pub fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> String {
    // `minDistance` and `min-distance` are `min_distance` in other notations.
    let plain = |name: &str| name.to_lowercase().replace(['_', '-', ' '], "");
    // Longer names are not typing errors, and comparing them costs time.
    let wanted = plain(name.get(..name.len().min(40)).unwrap_or_default());
    let likeness = |known: &str| strsim::jaro_winkler(&plain(known), &wanted);
    let scored = known.map(|known| (likeness(known), known));
    let best = scored.max_by(|a, b| a.0.total_cmp(&b.0));
    match best.filter(|(likeness, _)| *likeness > 0.8) {
        Some((_, known)) => format!("unknown {what}; did you mean `{known}`?"),
        None => format!("unknown {what}"),
    }
}
