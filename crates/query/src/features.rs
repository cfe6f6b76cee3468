//! Points by feature: each polygon of a collection, or each class of a raster, with its own points, counted one by one.
//!
//! A feature is a layer of its name, so that everything that holds for layers holds for features: the column `layer`
//! says which feature a point lies in, and amounts, prices and limits are those of layers. Without a number of points
//! for each the features show one pattern, as one region of all of them does.

use std::sync::Arc;

use strew_catalog::field::Document;
use strew_error::Checked;

use super::{
    Draft, LayerDraft, RegionDraft, ShapeDraft, Value, Values, groups,
    parameters::{COUNT, EXCEPT, FIELD, LOD, ONLY},
    region::around,
};

#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    pub name: String,
    /// Its polygons; everywhere if there are none.
    pub region: Option<RegionDraft>,
    /// The field that is 1 in it and 0 elsewhere, if it is one of a raster.
    pub field: Option<Arc<Document>>,
    /// Its number of points, if it has one of its own.
    pub count: Option<u64>,
}

impl Draft {
    /// This query of one set, with that set in each feature; in a box around all of them, unless it has a region. A
    /// query that could not be read stays as it is.
    pub fn in_features(mut self, features: Checked<Vec<Feature>>) -> Self {
        if matches!(self.region, Ok(None)) {
            let known = features.as_deref().unwrap_or_default().iter();
            let frame = around(known.filter_map(|feature| feature.region.as_ref()));
            self.region = Ok(Some(RegionDraft {
                path: "features".into(),
                shape: ShapeDraft::Box(frame.unwrap_or([0.0, 0.0, 1.0, 1.0])),
            }));
        }
        if self.values.read().is_err() {
            return self;
        }
        let set = self.values.clone();
        let stays = [&ONLY, &EXCEPT, &LOD];
        for (parameter, _) in set.given() {
            if groups::SET.contains(&parameter.group) && !stays.contains(&parameter) {
                self.values.replace(parameter, None);
            }
        }
        self.layers = features.map(|features| {
            let layers = features.into_iter();
            let layer = |feature: Feature| {
                let path = match &feature.region {
                    Some(region) => format!("{}.", region.path),
                    None => format!("class {}.", feature.name),
                };
                let mut values = Values::new(groups::SET, &path);
                values.fill_from(&set, groups::SET);
                for parameter in stays {
                    values.replace(parameter, None);
                }
                if let Some(count) = feature.count {
                    values.replace(&COUNT, Some(Value::Integer(count)));
                }
                if let Some(field) = feature.field {
                    values.replace(&FIELD, Some(Value::Field(field)));
                }
                LayerDraft {
                    name: Ok(Some(feature.name)),
                    region: Ok(feature.region),
                    ..LayerDraft::new(values)
                }
            };
            layers.map(layer).collect()
        });
        self
    }
}
