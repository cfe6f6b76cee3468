//! GeoJSON (RFC 7946): one collection, or a text sequence (RFC 8142) of features.
//!
//! Coordinates are the world's, in whatever unit it has. Readers take them for degrees unless the member
//! `crs` of GeoJSON 2008 names another plane; GDAL, QGIS and geopandas read it. What an answer says about
//! itself stands in foreign members of the collection; a sequence has no room for it, since some readers
//! refuse texts that are not GeoJSON.

use super::{
    head::Head,
    members::{Members, write_json},
    rows::Row,
    text::TextFormat,
    writer::Writer,
};

/// A collection: the head's members, then a feature a line.
#[derive(Debug)]
pub(super) struct Collection {
    pub(super) head: Head,
    pub(super) members: Members,
}

impl TextFormat for Collection {
    fn begin(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(b"{\"type\":\"FeatureCollection\",");
        let head = out.len();
        write_json(&self.head, out);
        // The head's members join the collection's, and its closing brace comes after the features.
        out.remove(head);
        out.pop();
        if let Some(crs) = &self.head.crs {
            out.extend_from_slice(b",\"crs\":");
            write_json(&crs.to_geojson(), out);
        }
        out.extend_from_slice(b",\"features\":[");
    }

    fn row(&self, row: Row<'_>, first: bool, out: &mut Writer<'_>) {
        out.text(if first { b"\n" } else { b",\n" });
        write_feature(&self.members, row, out);
    }

    fn end(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(b"\n]}\n");
    }

    fn row_bytes(&self) -> usize {
        ROW_BYTES + self.members.bytes()
    }
}

/// A text sequence: each feature between a record separator and a line feed.
#[derive(Debug)]
pub(super) struct Sequence {
    pub(super) members: Members,
}

impl TextFormat for Sequence {
    fn row(&self, row: Row<'_>, _first: bool, out: &mut Writer<'_>) {
        out.push(0x1e);
        write_feature(&self.members, row, out);
        out.push(b'\n');
    }

    fn row_bytes(&self) -> usize {
        ROW_BYTES + self.members.bytes()
    }
}

/// More than a feature without columns takes.
const ROW_BYTES: usize = 240;

fn write_feature(members: &Members, row: Row<'_>, out: &mut Writer<'_>) {
    out.constant(b"{\"type\":\"Feature\",\"id\":\"");
    out.id(row);
    out.constant(b"\",\"geometry\":{\"type\":\"Point\",");
    out.constant(b"\"coordinates\":[");
    out.number(members.digits(), row.point.x);
    out.push(b',');
    out.number(members.digits(), row.point.y);
    if let Some(height) = row.height {
        out.push(b',');
        out.number(members.digits(), height.z);
    }
    out.constant(b"]},\"properties\":");
    members.write_object(row, out);
    out.push(b'}');
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use crate::{Encoding, Output, sample_rows::answer};

    #[test]
    fn a_sequence_has_the_features_of_the_collection() {
        let (collection, _) = answer(&Output::new(Encoding::Geojson), 4096);
        let (sequence, _) = answer(&Output::new(Encoding::Geojsonseq), 4096);
        let collection: Value = serde_json::from_slice(&collection).expect("JSON");
        assert_eq!(collection["type"], "FeatureCollection");
        assert_eq!(collection["query"]["bbox"][0], -10.0);
        let features = collection["features"].as_array().expect("a list");
        assert_eq!(collection["count"], features.len());
        let mut texts = sequence.split(|byte| *byte == 0x1e);
        assert_eq!(texts.next(), Some(&b""[..]), "a separator comes first");
        let texts: Vec<Value> = texts
            .map(|text| {
                assert_eq!(text.last(), Some(&b'\n'));
                serde_json::from_slice(text).expect("JSON")
            })
            .collect();
        assert_eq!(&texts, features);
    }

    #[test]
    fn columns_are_properties() {
        let (collection, _) = answer(&Output::new(Encoding::Geojson), 4096);
        let collection: Value = serde_json::from_slice(&collection).expect("JSON");
        for feature in collection["features"].as_array().expect("a list") {
            assert_eq!(feature["type"], "Feature");
            assert_eq!(feature["geometry"]["type"], "Point");
            let properties = feature["properties"].as_object().expect("an object");
            let names: Vec<&str> = properties.keys().map(String::as_str).collect();
            let expected: &[&str] = match properties["layer"].as_str() {
                Some("trees") => &["layer", "angle", "variant"],
                _ => &["layer", "variant"],
            };
            assert_eq!(names, expected);
        }
    }
}
