//! Drafts: queries as typed fields, not checked yet.

use strew_core::{Keep, Placement, Seed, Warp};

use super::{
    AmountDraft, AttributesDraft, KEEP, MOST_LAYERS, Query, RegionDraft, Set, TableDraft, WARP,
    Window,
    cursor::Token,
    faults::Faults,
    number,
    region::{Budget, REGION},
};
use crate::service::{Catalog, Error, Fault};

/// A query as typed fields. What is absent takes its default; a region and an amount, its own or of
/// every layer, must be there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Draft {
    /// Where.
    pub region: Option<RegionDraft>,
    /// The points, if there are no layers.
    pub set: SetDraft,
    /// The layers, if there are any.
    pub layers: Vec<LayerDraft>,
    /// Which of the points.
    pub window: WindowDraft,
}

/// A set of points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SetDraft {
    /// How many.
    pub amount: AmountDraft,
    /// The table.
    pub table: TableDraft,
    /// The seed; 0 by default.
    pub seed: Option<u64>,
    /// The strength of the warp; by default 0 for seed 0 and 1 for every other.
    pub warp: Option<f64>,
    /// The share of points to keep; all by default.
    pub keep: Option<f64>,
    /// The further values of points.
    pub attributes: AttributesDraft,
}

/// A layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerDraft {
    /// Its name.
    pub name: String,
    /// Where it is; everywhere by default.
    pub region: Option<RegionDraft>,
    /// Its points.
    pub set: SetDraft,
    /// Names of earlier layers and the distances kept from their points.
    pub clear_of: Vec<(String, f64)>,
}

/// Which part of the points is asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WindowDraft {
    /// How many are left out at the beginning.
    pub offset: Option<u64>,
    /// How many are wanted at most.
    pub limit: Option<u64>,
    /// Where an earlier answer ended.
    pub cursor: Option<String>,
}

/// What layers may be called.
const NAME: &str = "1 to 64 ASCII letters, digits, _, - and ., another name for each layer";
/// What clear_of may be.
const CLEAR_OF: &str = "names of layers before this one, each with a distance above 0";

impl Draft {
    /// Checks everything against what is loaded. `found` are the faults found on the way here; a
    /// field that one of them names is not faulted again. `most_vertices` bounds polygons.
    ///
    /// # Errors
    /// [`Error::Invalid`] with every fault, [`Error::OtherTable`] if a pinned table is not loaded.
    pub fn check(
        &self,
        catalog: &Catalog,
        most_vertices: usize,
        found: Vec<Fault>,
    ) -> Result<Query, Error> {
        let mut faults = Faults::new(found);
        let mut budget = Budget {
            vertices: most_vertices,
        };
        let region = match &self.region {
            Some(region) => region.check(&mut budget, &mut faults),
            None => {
                faults.add(Fault::missing("region", REGION));
                None
            }
        };
        let window = self.window.check(&mut faults);
        let is_layered = !self.layers.is_empty();
        let sets = if is_layered {
            self.layers(catalog, &mut budget, &mut faults)
        } else {
            let set = self.set.check(catalog, String::new(), &mut faults);
            set.into_iter().collect()
        };
        let (Some(region), Some(window), true) = (region, window, faults.is_empty()) else {
            return Err(faults.into_error());
        };
        let drafts = self.layers.iter().map(|layer| &layer.set);
        let drafts = drafts.chain((!is_layered).then_some(&self.set));
        for (set, draft) in sets.iter().zip(drafts) {
            draft.table.hold(&set.entry)?;
        }
        Ok(Query {
            region,
            sets: sets.into(),
            is_layered,
            window,
        })
    }

    fn layers(&self, catalog: &Catalog, budget: &mut Budget, faults: &mut Faults) -> Vec<Set> {
        if self.layers.len() > MOST_LAYERS {
            let detail = "there are too many layers";
            let allowed = format!("at most {MOST_LAYERS} layers");
            faults.add(Fault::new("layers", self.layers.len(), detail, allowed));
            return vec![];
        }
        for (name, value) in self.set.given() {
            let detail = "it means nothing beside layers: each layer has its own";
            faults.add(Fault::new(name, value, detail, "either layers or one set"));
        }
        let mut sets = vec![];
        for (i, layer) in self.layers.iter().enumerate() {
            let path = format!("layers[{i}].");
            let earlier: Vec<&str> = self.layers[..i].iter().map(|l| l.name.as_str()).collect();
            let field = |name: &str| format!("{path}{name}");
            if !is_name(&layer.name) || earlier.contains(&layer.name.as_str()) {
                let detail = if earlier.contains(&layer.name.as_str()) {
                    "an earlier layer has this name"
                } else {
                    "it is not such a name"
                };
                faults.add(match layer.name.as_str() {
                    "" => Fault::missing(&field("name"), NAME),
                    name => Fault::new(&field("name"), name, detail, NAME),
                });
            }
            let own = layer.region.as_ref();
            let region = own.map(|region| region.check(budget, faults));
            let mut clear_of = vec![];
            for (name, distance) in &layer.clear_of {
                let wrong = match earlier.iter().position(|earlier| earlier == name) {
                    Some(place) if *distance > 0.0 && distance.is_finite() => {
                        clear_of.push((place, *distance));
                        continue;
                    }
                    Some(_) => "the distance is not a finite number above 0",
                    None => "no earlier layer has this name",
                };
                let value = format!("{name}: {}", number(*distance));
                faults.add(Fault::new(&field("clear_of"), value, wrong, CLEAR_OF));
            }
            if let (Some(count), false) = (layer.set.amount.count, clear_of.is_empty()) {
                let detail = "a layer that keeps clear of others has as many points as they leave";
                let allowed = "density, spacing or min_distance";
                faults.add(Fault::new(&field("count"), count, detail, allowed));
            }
            if let Some(set) = layer.set.check(catalog, path.clone(), faults) {
                sets.push(Set {
                    name: layer.name.clone(),
                    region: region.flatten(),
                    clear_of,
                    ..set
                });
            }
        }
        sets
    }
}

impl SetDraft {
    /// Checks a set without a region. `found` are the faults found on the way here.
    ///
    /// # Errors
    /// As [`Draft::check`].
    pub fn check_alone(&self, catalog: &Catalog, found: Vec<Fault>) -> Result<Set, Error> {
        let mut faults = Faults::new(found);
        let set = self.check(catalog, String::new(), &mut faults);
        let (Some(set), true) = (set, faults.is_empty()) else {
            return Err(faults.into_error());
        };
        self.table.hold(&set.entry)?;
        Ok(set)
    }

    fn check(&self, catalog: &Catalog, path: String, faults: &mut Faults) -> Option<Set> {
        let seed = Seed(self.seed.unwrap_or(0));
        let amount = faults.take(self.amount.check(&path));
        let field = |name: &str| format!("{path}{name}");
        let warp = self.warp.map(|strength| {
            let detail = "it is out of range";
            let fault = |_| Fault::new(&field("warp"), number(strength), detail, WARP);
            Warp::new(strength).map_err(fault)
        });
        let warp = faults.take(warp.transpose());
        let keep = self.keep.map(|share| {
            let detail = "it is out of range";
            let fault = |_| Fault::new(&field("keep"), number(share), detail, KEEP);
            Keep::new(share).map_err(fault)
        });
        let keep = faults.take(keep.transpose());
        let attributes = faults.take(self.attributes.check(&path));
        let entry = faults.take_all(self.table.check(catalog, &path));
        let by_default = || Placement::default_warp(seed);
        Some(Set {
            amount: amount?,
            warp: warp?.unwrap_or_else(by_default),
            keep: keep?.unwrap_or(Keep::ALL),
            attributes: attributes?,
            entry: entry?,
            is_pinned: self.table.table.is_some(),
            path,
            name: String::new(),
            seed,
            region: None,
            clear_of: vec![],
        })
    }

    /// The fields that are given, by name, with their values.
    fn given(&self) -> Vec<(&'static str, String)> {
        let AmountDraft {
            density,
            spacing,
            min_distance,
            count,
        } = self.amount;
        let TableDraft {
            profile,
            alpha,
            map,
            table,
        } = self.table.clone();
        let names = &self.attributes.names;
        let all = [
            ("density", density.map(number)),
            ("spacing", spacing.map(number)),
            ("min_distance", min_distance.map(number)),
            ("count", count.map(|v| v.to_string())),
            ("profile", profile),
            ("alpha", alpha),
            ("map", map),
            ("table", table),
            ("seed", self.seed.map(|v| v.to_string())),
            ("warp", self.warp.map(number)),
            ("keep", self.keep.map(number)),
            ("attributes", (!names.is_empty()).then(|| names.join(","))),
        ];
        let given = all
            .into_iter()
            .filter_map(|(name, value)| Some((name, value?)));
        given.collect()
    }
}

impl WindowDraft {
    fn check(&self, faults: &mut Faults) -> Option<Window> {
        if self.limit == Some(0) {
            let allowed = "an integer from 1 on";
            faults.add(Fault::new("limit", 0, "it is out of range", allowed));
        }
        let cursor = self.cursor.as_deref().map(Token::parse).transpose();
        Some(Window {
            offset: self.offset.unwrap_or(0),
            limit: self.limit,
            cursor: faults.take(cursor)?,
        })
    }
}

fn is_name(text: &str) -> bool {
    let fine = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
    (1..=64).contains(&text.len()) && text.chars().all(fine)
}
