//! Layers as they were read: one of several sets of points of a query.

use std::borrow::Cow;

use serde_json::Value as Json;
use strew_config::name::is_title;
use strew_error::{Checked, Fault, Faults, Together as _, faults::all, number};

use super::{
    RegionDraft, Set, Value, Values,
    field::Loaded,
    parameter::{Group, Parameter},
    parameters::{COUNT, FIELD, SEED},
};

#[derive(Clone, Debug, PartialEq)]
pub struct LayerDraft {
    /// Its name; it must be there.
    pub name: Checked<Option<String>>,
    /// Where it is; everywhere by default.
    pub region: Checked<Option<RegionDraft>>,
    pub values: Values,
    pub clear_of: Checked<Vec<(String, f64)>>,
}

pub(super) const NAME: &str = "1 to 64 characters, none of them a control character or a line break, another name for each layer";
/// The rule for `clear_of`, in words.
const CLEAR_OF: &str = "names of layers before this one, each with a finite distance above 0";

impl LayerDraft {
    /// A layer without a name yet.
    pub const fn new(values: Values) -> Self {
        Self {
            name: Ok(None),
            region: Ok(None),
            values,
            clear_of: Ok(vec![]),
        }
    }

    /// The layer with a seed of its own under a common one, unless it says its seed: the first 53 bits of
    /// BLAKE3 over the common seed, as eight bytes, and the name. So long numbers survive JSON.
    pub(super) fn seeded(&self, common: u64) -> Cow<'_, Self> {
        let Some(name) = self.known_name().filter(|_| !self.values.has(&SEED)) else {
            return Cow::Borrowed(self);
        };
        let mut hasher = blake3::Hasher::new();
        hasher.update(&common.to_be_bytes()).update(name.as_bytes());
        let mut first = [0; 8];
        hasher.finalize_xof().fill(&mut first);
        let seed = u64::from_be_bytes(first) >> 11;
        let mut layer = self.clone();
        layer.values.replace(&SEED, Some(Value::Integer(seed)));
        Cow::Owned(layer)
    }

    /// Checks the layer after some others.
    pub(super) fn check(&self, before: &[Self], loaded: &Loaded<'_>) -> Checked<Set> {
        let names: Vec<Option<&str>> = before.iter().map(Self::known_name).collect();
        let region = match &self.region {
            Ok(region) => region.as_ref().map(RegionDraft::check).transpose(),
            Err(faults) => Err(faults.clone()),
        };
        let (read, set, name, region, clear_of) = (
            self.values.read(),
            Set::of(&self.values, loaded),
            self.name(&names),
            region,
            self.clear_of(&names),
        );
        let ((), set, name, region, clear_of) = (read, set, name, region, clear_of).together()?;
        Ok(Set {
            name,
            region,
            clear_of,
            ..*set
        })
    }

    /// Whether another layer differs in name, region, amount, seed and field alone, and neither keeps clear of others.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let is_own = |parameter: &Parameter| {
            [Group::Amount, Group::Count].contains(&parameter.group)
                || [&SEED, &FIELD].contains(&parameter)
        };
        let common = |layer: &Self| -> Vec<(&'static Parameter, Value)> {
            let given = layer
                .values
                .given()
                .filter(|(parameter, _)| !is_own(parameter));
            given
                .map(|(parameter, value)| (parameter, value.clone()))
                .collect()
        };
        let is_free = |layer: &Self| matches!(&layer.clear_of, Ok(pairs) if pairs.is_empty());
        is_free(self) && is_free(other) && common(self) == common(other)
    }

    pub(super) fn given_region(&self) -> Option<&RegionDraft> {
        self.region.as_ref().ok()?.as_ref()
    }

    pub(super) fn known_name(&self) -> Option<&str> {
        self.name.as_ref().ok()?.as_deref()
    }

    fn field(&self, name: &str) -> String {
        format!("{}{name}", self.values.path())
    }

    fn name(&self, before: &[Option<&str>]) -> Checked<String> {
        let Some(name) = self.name.clone()? else {
            return Err(Fault::missing(&self.field("name"), NAME).into());
        };
        let detail = if before.contains(&Some(&name)) {
            "an earlier layer has this name"
        } else if !is_title(&name) {
            "not a name of layers"
        } else {
            return Ok(name);
        };
        Err(Fault::new(&self.field("name"), name, detail, NAME).into())
    }

    fn clear_of(&self, before: &[Option<&str>]) -> Checked<Vec<(usize, f64)>> {
        let pairs = self.clear_of.clone()?;
        let field = self.field("clear_of");
        let place = |(name, distance): &(String, f64)| {
            let fault = |detail: &str| {
                let value = format!("{name}: {}", number(*distance));
                Faults::from(Fault::new(&field, value, detail, CLEAR_OF))
            };
            let place = before.iter().position(|earlier| *earlier == Some(name));
            let place = place.ok_or_else(|| fault("no earlier layer has this name"))?;
            if *distance > 0.0 && distance.is_finite() {
                return Ok((place, *distance));
            }
            Err(fault("the distance must be finite and above 0"))
        };
        let places = all(pairs.iter().map(place))?;
        if !places.is_empty() && self.values.has(&COUNT) {
            let detail = "not with clear_of: earlier layers decide how many points remain";
            let text = self.values.text(&COUNT);
            let allowed = "density, spacing or min_distance";
            return Err(Fault::new(&self.field(COUNT.name), text, detail, allowed).into());
        }
        Ok(places)
    }

    pub(super) fn to_json(&self) -> Json {
        let mut members = self.values.written();
        members.extend(self.known_name().map(|name| ("name".into(), name.into())));
        if let Ok(Some(region)) = &self.region {
            members.insert("region".into(), region.echo());
        }
        if let Ok(pairs) = &self.clear_of
            && !pairs.is_empty()
        {
            let pairs = pairs
                .iter()
                .map(|(name, distance)| (name.clone(), (*distance).into()));
            members.insert("clear_of".into(), Json::Object(pairs.collect()));
        }
        members.into()
    }
}
