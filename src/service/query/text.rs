//! Queries as text: the parameters of an address or of a command line.

use std::sync::Arc;

use percent_encoding::percent_decode_str;

use super::{
    AMOUNT, AmountDraft, Around, AroundDraft, AttributesDraft, BOX, Body, Draft, KEEP, Query,
    RegionDraft, Set, SetDraft, ShapeDraft, TableDraft, WARP, WindowDraft,
    amount::COUNT,
    attributes::{SCALE_RANGE, VARIANTS},
    check_parts,
    faults::{Faults, MOST},
    parameters::{
        LIMIT, LOOKS_NAMES, NEAREST, OFFSET, PARTS, PLACE, Parameter, RADIUS, REGION_NAMES, SEED,
        SET_NAMES, Shape, WINDOW_NAMES, names,
    },
    region::{CIRCLE, POLYGON},
    values::{
        finite, integer, no_format, numbers, read_bbox, strength, variants_of, vertices, wrong,
    },
};
use crate::service::{
    Catalog, Encoding, Entry, Error, Fault,
    encode::{
        DECIMALS, MOST_DECIMALS, Options,
        preview::{LEAST_SIZE, MOST_SIZE, SIZE},
    },
};

/// Text parameters by name, each at most once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parameters {
    /// Sorted by name: there are few.
    values: Vec<(&'static str, String)>,
}

/// Parameters with the faults found so far.
pub type Parsed = (Parameters, Vec<Fault>);

/// The parameters of an address: `name=value` joined by `&`, percent-encoded. A plus is a plus, as
/// in `1e+5` and `(1+sqrt(5))/2`, not a space.
#[must_use]
pub fn parse_pairs(text: &str) -> Parsed {
    let mut parameters = Parameters::default();
    let mut faults: Vec<Fault> = vec![];
    for pair in text.split('&').filter(|pair| !pair.is_empty()) {
        if faults.len() == MOST {
            break;
        }
        let (raw_name, raw_value) = pair.split_once('=').unwrap_or((pair, ""));
        let name = percent_decode_str(raw_name).decode_utf8_lossy();
        let Some(parameter) = Parameter::named(&name) else {
            faults.push(Fault::new(
                &name,
                percent_decode_str(raw_value).decode_utf8_lossy(),
                "there is no such parameter",
                names(),
            ));
            continue;
        };
        let Ok(value) = percent_decode_str(raw_value).decode_utf8() else {
            // As it was sent: there is no text to show.
            faults.push(Fault::new(
                &name,
                raw_value,
                "it is not UTF-8 when decoded",
                "percent-encoded UTF-8",
            ));
            continue;
        };
        if let Some(first) = parameters.get(parameter.name) {
            let detail = format!("it is given again; before as `{first}`");
            faults.push(Fault::new(&name, value, detail, "each parameter once"));
            continue;
        }
        parameters.insert(parameter.name, value.into());
    }
    (parameters, faults)
}

impl Parameters {
    /// Parameters from those of a list that are given.
    ///
    /// Names that are no parameter's are left out.
    #[must_use]
    pub fn of<'a>(given: impl IntoIterator<Item = (&'a str, Option<String>)>) -> Self {
        let known =
            |(name, value): (&str, Option<String>)| Some((Parameter::named(name)?.name, value?));
        let mut parameters = Self::default();
        for (name, value) in given.into_iter().filter_map(known) {
            parameters.insert(name, value);
        }
        parameters
    }

    /// The text of a parameter, if it is given.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&str> {
        let mut values = self.values.iter();
        values
            .find(|(known, _)| *known == name)
            .map(|(_, value)| value.as_str())
    }

    fn insert(&mut self, name: &'static str, value: String) {
        match self.values.binary_search_by_key(&name, |(known, _)| known) {
            Ok(place) => self.values[place].1 = value,
            Err(place) => self.values.insert(place, (name, value)),
        }
    }

    /// Faults every parameter that is in none of these lists.
    fn only(&self, allowed: &[&[&str]], faults: &mut Faults) {
        for (name, value) in &self.values {
            if !allowed.iter().any(|list| list.contains(name)) {
                let detail = "it means nothing here";
                let allowed = allowed.concat().join(", ");
                faults.add(Fault::new(name, value, detail, allowed));
            }
        }
    }

    /// The table of a profile that `alpha` and `map` choose; no other parameter may be given.
    ///
    /// # Errors
    /// [`Error::Invalid`] with every fault.
    pub fn entry(
        &self,
        catalog: &Catalog,
        profile: &str,
        found: Vec<Fault>,
    ) -> Result<Arc<Entry>, Error> {
        let mut faults = Faults::new(found);
        self.only(&[&["alpha", "map", "table"]], &mut faults);
        let table = TableDraft {
            profile: Some(profile.into()),
            ..self.table()
        };
        let entry = faults.take_all(table.check(catalog, ""));
        let (Some(entry), true) = (entry, faults.is_empty()) else {
            return Err(faults.into_error());
        };
        table.hold(&entry)?;
        Ok(entry)
    }

    /// The query, and the options of the output; `found` are the faults found before. `region` is
    /// that of the path, where it has one.
    ///
    /// # Errors
    /// [`Error::Invalid`] with every fault, [`Error::OtherTable`] if a pinned table is not loaded.
    pub fn check(
        &self,
        catalog: &Catalog,
        most_vertices: usize,
        region: Option<RegionDraft>,
        found: Vec<Fault>,
    ) -> Result<(Query, Options), Error> {
        let body = self.draft(region, found);
        let query = body.draft.check(catalog, most_vertices, body.faults)?;
        Ok((query, body.options))
    }

    /// The query as far as it can be read, with the faults found on the way and before.
    #[must_use]
    pub fn draft(&self, region: Option<RegionDraft>, found: Vec<Fault>) -> Body {
        let mut faults = Faults::new(found);
        let regions: &[&str] = if region.is_none() { &REGION_NAMES } else { &[] };
        let allowed = [&SET_NAMES[..], &LOOKS_NAMES, &WINDOW_NAMES, regions];
        self.only(&allowed, &mut faults);
        let draft = Draft {
            region: match region {
                Some(region) => Some(region),
                None => self.region(&mut faults),
            },
            set: self.set(&mut faults),
            layers: vec![],
            window: WindowDraft {
                offset: self.read("offset", OFFSET, integer, &mut faults),
                limit: self.read("limit", LIMIT, integer, &mut faults),
                cursor: self.get("cursor").map(Into::into),
            },
        };
        let options = self.options(&mut faults);
        Body {
            draft,
            options,
            faults: faults.into_inner(),
        }
    }

    /// Only the options of the output.
    ///
    /// # Errors
    /// Every fault.
    pub fn looks(&self) -> Result<Options, Vec<Fault>> {
        let mut faults = Faults::default();
        let options = self.options(&mut faults);
        if faults.is_empty() {
            Ok(options)
        } else {
            Err(faults.into_inner())
        }
    }

    /// A set of points without a region, as single points are asked for; `others` may be given,
    /// too.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub fn check_set(
        &self,
        catalog: &Catalog,
        others: &[&str],
        found: Vec<Fault>,
    ) -> Result<Set, Error> {
        let mut faults = Faults::new(found);
        let set: Vec<&str> = SET_NAMES
            .into_iter()
            .filter(|name| *name != "count")
            .collect();
        self.only(&[&set[..], others], &mut faults);
        self.set(&mut faults)
            .check_alone(catalog, faults.into_inner())
    }

    /// The place whose neighbors are asked for, how many of them, and how far away they may be.
    ///
    /// # Errors
    /// Every fault.
    pub fn around(&self) -> Result<Around, Vec<Fault>> {
        let mut faults = Faults::default();
        let draft = AroundDraft {
            at: self.read("at", PLACE, numbers, &mut faults),
            k: self.read("k", NEAREST, integer, &mut faults),
            radius: self.read("radius", RADIUS, finite, &mut faults),
        };
        draft.check(faults.into_inner())
    }

    /// How many parts a query is split into.
    ///
    /// # Errors
    /// A fault if it is missing or not a number that is allowed.
    pub fn parts(&self) -> Result<u32, Vec<Fault>> {
        let mut faults = Faults::default();
        self.only(&[&["parts"]], &mut faults);
        let parts = self.read("parts", PARTS, integer, &mut faults);
        let parts = parts.and_then(|parts| faults.take(check_parts(parts)));
        if self.get("parts").is_none() {
            faults.add(Fault::missing("parts", PARTS));
        }
        parts
            .filter(|_| faults.is_empty())
            .ok_or_else(|| faults.into_inner())
    }

    /// The value of a parameter, if it is given and can be read.
    fn read<T>(
        &self,
        name: &str,
        allowed: &str,
        read: impl FnOnce(&str) -> Option<T>,
        faults: &mut Faults,
    ) -> Option<T> {
        let text = self.get(name)?;
        let value = read(text);
        if value.is_none() {
            let is_list = Parameter::named(name)
                .is_some_and(|parameter| matches!(parameter.shape, Shape::Numbers(_)));
            let detail = if is_list {
                "it is not such a list of numbers"
            } else {
                wrong(text)
            };
            faults.add(Fault::new(name, text, detail, allowed));
        }
        value
    }

    fn region(&self, faults: &mut Faults) -> Option<RegionDraft> {
        let given: Vec<&str> = REGION_NAMES
            .into_iter()
            .filter(|name| self.get(name).is_some())
            .collect();
        let (name, text) = match given.as_slice() {
            [] => {
                faults.add(Fault::missing("bbox", BOX));
                return None;
            }
            [name] => (*name, self.get(name)?),
            [first, second, ..] => {
                let detail = format!("{first} is given, too");
                let allowed = "one of bbox, circle and polygon";
                faults.add(Fault::new(second, self.get(second)?, detail, allowed));
                return None;
            }
        };
        let shape = match name {
            "bbox" => faults.take(read_bbox(Some(text)))?.map(ShapeDraft::Box),
            "circle" => self
                .read(name, CIRCLE, numbers, faults)
                .map(|[x, y, radius]| ShapeDraft::Circle([x, y], radius)),
            _ => self
                .read(name, POLYGON, vertices, faults)
                .map(|ring| ShapeDraft::Polygons(vec![vec![ring]])),
        };
        let path = name.into();
        Some(RegionDraft {
            path,
            shape: shape?,
        })
    }

    fn table(&self) -> TableDraft {
        let text = |name| self.get(name).map(Into::into);
        TableDraft {
            profile: text("profile"),
            alpha: text("alpha"),
            map: text("map"),
            table: text("table"),
        }
    }

    fn set(&self, faults: &mut Faults) -> SetDraft {
        SetDraft {
            amount: AmountDraft {
                density: self.read("density", AMOUNT, finite, faults),
                spacing: self.read("spacing", AMOUNT, finite, faults),
                min_distance: self.read("min_distance", AMOUNT, finite, faults),
                count: self.read("count", COUNT, integer, faults),
            },
            table: self.table(),
            seed: self.read("seed", SEED, integer, faults),
            warp: self.read("warp", WARP, strength, faults),
            keep: self.read("keep", KEEP, finite, faults),
            attributes: AttributesDraft {
                names: self
                    .get("attributes")
                    .map(|text| text.split(',').map(Into::into).collect())
                    .unwrap_or_default(),
                scale_range: self.read("scale_range", SCALE_RANGE, numbers, faults),
                variants: self.read("variants", VARIANTS, variants_of, faults),
            },
        }
    }

    fn options(&self, faults: &mut Faults) -> Options {
        let format =
            |text: &str| Encoding::from_name(text).ok_or_else(|| no_format("format", text));
        let encoding = self.get("format").map(format).transpose();
        let decimals = |text: &str| integer(text).filter(|n| *n <= MOST_DECIMALS);
        let size = |text: &str| integer(text).filter(|n| (LEAST_SIZE..=MOST_SIZE).contains(n));
        Options {
            encoding: faults.take(encoding).flatten(),
            decimals: self.read("decimals", DECIMALS, decimals, faults),
            size: self.read("size", SIZE, size, faults),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::PARAMETERS, *};

    #[test]
    fn every_parameter_of_the_list_is_read_and_its_example_is_in_order() {
        let catalog = Catalog::load(true, None).expect("built in");
        for parameter in PARAMETERS {
            let name = parameter.name;
            let mut text = format!("{name}={}", parameter.example);
            let is_in = |list: &[&str]| list.contains(&name);
            if is_in(&["at", "k", "radius"]) {
                if name != "at" {
                    text += "&at=1,1";
                }
                let (parameters, faults) = parse_pairs(&text);
                assert!(faults.is_empty() && parameters.around().is_ok(), "{text}");
                continue;
            }
            if name == "parts" {
                assert!(parse_pairs(&text).0.parts().is_ok(), "{text}");
                continue;
            }
            if name == "cursor" {
                // Its example is an answer's.
                continue;
            }
            if !is_in(&REGION_NAMES) {
                text += "&bbox=0,0,10,10";
            }
            if !is_in(&["density", "spacing", "min_distance", "count"]) {
                text += "&density=1";
            }
            if name == "scale_range" {
                text += "&attributes=scale";
            }
            if name == "variants" {
                text += "&attributes=variant";
            }
            let (parameters, faults) = parse_pairs(&text);
            let checked = parameters.check(&catalog, 100, None, faults);
            assert!(checked.is_ok(), "{text}: {checked:?}");
        }
        assert_eq!(SEED, format!("an integer from 0 to {}", u64::MAX));
    }
}
