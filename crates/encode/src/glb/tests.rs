//! Whole files, taken apart again.

use serde_json::Value;

use crate::{Encoding, Output, sample_rows::answer};

/// The document and the buffer of a file.
fn opened(file: &[u8]) -> (Value, Vec<u8>) {
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().expect("4")) as usize;
    assert_eq!(&file[..4], b"glTF");
    assert_eq!((word(4), word(8)), (2, file.len()));
    let json = word(12);
    assert_eq!((&file[16..20], json % 4), (&b"JSON"[..], 0));
    let document = serde_json::from_slice(&file[20..20 + json]).expect("JSON");
    let rest = &file[20 + json..];
    assert_eq!(&rest[4..8], b"BIN\0");
    assert_eq!(word(20 + json), rest.len() - 8);
    (document, rest[8..].to_vec())
}

#[test]
fn nodes_hold_every_point_once_with_its_thing() {
    let (file, size) = answer(&Output::new(Encoding::Glb), 4096);
    assert_eq!(size, None, "variants are counted first");
    let (document, buffer) = opened(&file);
    assert_eq!(document["buffers"][0]["byteLength"], buffer.len());
    let (csv, _) = answer(&Output::new(Encoding::Csv), 4096);
    let csv = String::from_utf8(csv).expect("UTF-8");
    let mut expected: Vec<String> = csv
        .lines()
        .skip(1)
        .map(|line| {
            let mut fields = line.split(',');
            let (layer, id) = (
                fields.next().expect("a layer"),
                fields.next().expect("an id"),
            );
            let name = match line.rsplit(',').next().expect("a variant") {
                " \"\"old\"\"\"" => "grey, \"old\"",
                name => name,
            };
            format!("{layer} {id} {name}")
        })
        .collect();
    let number = |value: &Value| value.as_u64().expect("an integer") as usize;
    let mut found = vec![];
    for node in &document["nodes"].as_array().expect("nodes")[1..] {
        let attributes = &node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        let accessor = &document["accessors"][number(&attributes["_ID"])];
        let view = &document["bufferViews"][number(&accessor["bufferView"])];
        let first = number(&view["byteOffset"]) + number(&accessor["byteOffset"]);
        for i in 0..number(&accessor["count"]) {
            let half = |at: usize| {
                let at = first + 8 * i + at;
                i32::from_le_bytes(buffer[at..at + 4].try_into().expect("4"))
            };
            let (layer, name) = (&node["extras"]["layer"], &node["name"]);
            let text = |v: &Value| v.as_str().expect("a name").to_owned();
            found.push(format!(
                "{} {}:{} {}",
                text(layer),
                half(0),
                half(4),
                text(name)
            ));
        }
    }
    expected.sort();
    found.sort();
    assert_eq!(found, expected);
    let children = document["nodes"][0]["children"].as_array().map(Vec::len);
    assert_eq!(
        children,
        Some(document["nodes"].as_array().expect("nodes").len() - 1)
    );
    assert_eq!(answer(&Output::new(Encoding::Glb), 100).0, file);
}
