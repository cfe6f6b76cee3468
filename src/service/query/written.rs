//! Queries written down: a draft as the JSON body that reads back as it.

use serde_json::{Map, Value, json};

use super::{AttributesDraft, Draft, LayerDraft, RegionDraft, SetDraft};
use crate::service::{Encoding, encode::Options};

impl Draft {
    /// The body of `POST /v1/points:query` that asks for this, in an output that looks like that.
    /// What is not there is left out.
    #[must_use]
    pub fn to_body(&self, options: &Options) -> Map<String, Value> {
        let mut body = Map::new();
        let mut put = |name: &str, value: Option<Value>| {
            body.extend(value.map(|value| (name.into(), value)));
        };
        put("region", self.region.as_ref().map(RegionDraft::echo));
        let layers: Vec<Value> = self.layers.iter().map(LayerDraft::written).collect();
        put("layers", (!layers.is_empty()).then(|| layers.into()));
        let window = &self.window;
        put("offset", window.offset.map(Into::into));
        put("limit", window.limit.map(Into::into));
        put("cursor", window.cursor.clone().map(Into::into));
        let format = options.encoding.map(Encoding::name);
        put("format", format.map(Into::into));
        put("decimals", options.decimals.map(Into::into));
        put("size", options.size.map(Into::into));
        body.extend(self.set.written());
        body
    }
}

impl LayerDraft {
    fn written(&self) -> Value {
        let mut members = self.set.written();
        members.insert("name".into(), self.name.clone().into());
        if let Some(region) = &self.region {
            members.insert("region".into(), region.echo());
        }
        if !self.clear_of.is_empty() {
            let pairs = self.clear_of.iter();
            let pairs = pairs.map(|(name, distance)| (name.clone(), json!(distance)));
            members.insert("clear_of".into(), Value::Object(pairs.collect()));
        }
        members.into()
    }
}

impl SetDraft {
    fn written(&self) -> Map<String, Value> {
        let (amount, table) = (&self.amount, &self.table);
        let text = |text: &Option<String>| text.clone().map(Into::into);
        let AttributesDraft {
            names,
            scale_range,
            variants,
        } = &self.attributes;
        // As a list, which keeps the order: it decides which point gets which.
        let variant = |(name, weight): &(String, f64)| json!({ "name": name, "weight": weight });
        let variants = variants
            .as_ref()
            .map(|variants| variants.iter().map(variant).collect());
        let members = [
            ("density", amount.density.map(Into::into)),
            ("spacing", amount.spacing.map(Into::into)),
            ("min_distance", amount.min_distance.map(Into::into)),
            ("count", amount.count.map(Into::into)),
            ("profile", text(&table.profile)),
            ("alpha", text(&table.alpha)),
            ("map", text(&table.map)),
            ("table", text(&table.table)),
            ("seed", self.seed.map(Into::into)),
            ("warp", self.warp.map(Into::into)),
            ("keep", self.keep.map(Into::into)),
            (
                "attributes",
                (!names.is_empty()).then(|| names.clone().into()),
            ),
            ("scale_range", scale_range.map(|range| json!(range))),
            ("variants", variants),
        ];
        let given = members
            .into_iter()
            .filter_map(|(name, value)| Some((name.into(), value?)));
        given.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{PARAMETERS, Parameters, read_body};
    use super::*;

    #[test]
    fn what_is_written_reads_back_the_same() {
        for body in [
            json!({ "region": { "bbox": [0.1, -2.3, 4.0, 5e9] }, "density": 0.1 }),
            json!({
                "region": { "include": [
                    { "circle": { "center": [0.3, 1.1], "radius": 2.7 } },
                    { "polygon": { "type": "Polygon", "coordinates": [
                        [[0, 0], [9, 0], [0, 9], [0, 0]], [[1, 1], [2, 1], [1, 2], [1, 1]],
                    ]}},
                ], "exclude": [{ "chunk": { "size": 0.7, "x": -3, "y": 4 } }] },
                "count": 5, "seed": u64::MAX, "warp": "on", "keep": 0.3, "profile": "spaced",
                "alpha": "sqrt(3)", "map": "s", "attributes": ["scale", "variant"],
                "scale_range": [0.8, 1.2], "variants": "oak:3,birch:0.1", "offset": 3,
                "limit": 4, "cursor": "01", "format": "csv", "decimals": 2, "size": 64,
            }),
            json!({ "region": { "bbox": [0, 0, 4, 4] }, "layers": [
                { "name": "trees", "min_distance": 2.1, "table": "00" },
                { "name": "rocks", "spacing": 0.7, "region": { "bbox": [0, 0, 2, 2] },
                  "clear_of": { "trees": 0.9 } },
            ]}),
        ] {
            let read = read_body(body.to_string().as_bytes()).expect("an object");
            assert_eq!(read.faults, []);
            let written = Value::Object(read.draft.to_body(&read.options));
            let again = read_body(written.to_string().as_bytes()).expect("an object");
            assert_eq!(again, read, "{written}");
        }
    }

    #[test]
    fn every_parameter_of_a_query_has_its_member() {
        for parameter in PARAMETERS {
            let name = parameter.name;
            if ["at", "k", "radius", "parts"].contains(&name) {
                continue;
            }
            let example = Some(parameter.example.to_owned());
            let body = Parameters::of([(name, example)]).draft(None, vec![]);
            let member = match name {
                "bbox" | "circle" | "polygon" => "region",
                name => name,
            };
            let written = body.draft.to_body(&body.options);
            assert!(written.contains_key(member), "{name}: {written:?}");
        }
    }
}
