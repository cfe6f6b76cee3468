//! Elements of `Accept` and `Accept-Encoding` with their quality values (RFC 9110, 12.4.2).

/// An element without its parameters, and its quality in thousandths: 1000 unless it has a `q`.
/// `None` if a parameter is malformed.
pub(super) fn split(element: &str) -> Option<(&str, u16)> {
    let mut parts = element.split(';').map(str::trim);
    let name = parts.next()?;
    let mut quality = 1000;
    for parameter in parts.filter(|part| !part.is_empty()) {
        let (name, value) = parameter.split_once('=')?;
        if name.trim().eq_ignore_ascii_case("q") {
            let value: f64 = value.trim().parse().ok()?;
            quality = (value.clamp(0.0, 1.0) * 1000.0).round() as u16;
        }
    }
    Some((name, quality))
}

#[cfg(test)]
mod tests {
    use super::split;

    #[test]
    fn the_quality_is_one_unless_it_is_given() {
        for (element, expected) in [
            (" gzip ", Some(("gzip", 1000))),
            ("gzip;q=0.5", Some(("gzip", 500))),
            ("gzip ; Q = 0.25 ", Some(("gzip", 250))),
            ("text/csv;header=present;q=2", Some(("text/csv", 1000))),
            ("gzip;", Some(("gzip", 1000))),
            ("gzip;q=x", None),
            ("gzip;q", None),
        ] {
            assert_eq!(split(element), expected, "{element}");
        }
    }
}
