//! The definitions of coordinate reference systems as PROJJSON, which GeoParquet requires: those of EPSG, projected or
//! geographic, that are not deprecated.
//!
//! They are 122 kB, compressed as one (`crs/make.py` writes them): their parts are much alike. Looking one up unpacks
//! the lines before it, up to 9 MB, a few at a time.

use std::io::{BufRead as _, BufReader};

use serde_json::Value;

/// A line for each: its name, a space, PROJJSON. From the database of PROJ 9.5.1, with EPSG v11.022.
static KNOWN: &[u8] = include_bytes!("../crs/known.zst");

/// The definition of a name such as `EPSG:25832`.
pub(super) fn find(name: &str) -> Option<Value> {
    let unpacked = BufReader::new(zstd::Decoder::new(KNOWN).ok()?);
    unpacked.lines().map_while(Result::ok).find_map(|line| {
        let definition = line.strip_prefix(name)?.strip_prefix(' ')?;
        serde_json::from_str(definition).ok()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions_are_found_by_their_whole_names() {
        for (name, title) in [
            ("OGC:CRS84", "WGS 84 (CRS84)"),
            ("EPSG:2056", "CH1903+ / LV95"),
            ("EPSG:2154", "RGF93 v1 / Lambert-93"),
            ("EPSG:3035", "ETRS89-extended / LAEA Europe"),
            ("EPSG:4326", "WGS 84"),
            ("EPSG:5070", "NAD83 / Conus Albers"),
            ("EPSG:25832", "ETRS89 / UTM zone 32N"),
            ("EPSG:27700", "OSGB36 / British National Grid"),
            ("EPSG:32760", "WGS 84 / UTM zone 60S"),
        ] {
            let found = find(name).expect("known");
            assert_eq!(found["name"], title);
            let (authority, code) = name.split_once(':').expect("two words");
            assert_eq!(found["id"]["authority"], authority);
            assert_eq!(found["id"]["code"].to_string().trim_matches('"'), code);
        }
        for name in ["", "EPSG", "EPSG:", "EPSG:432", "EPSG:43261", "IAU:49900"] {
            assert_eq!(find(name), None, "{name}");
        }
    }
}
