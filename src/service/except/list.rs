//! Lists of points with names: those of the configuration and of a folder.
//!
//! A list is text, an id a line: `12:-3`, or `trees/12:-3` for a point of a layer. What follows `#` is a comment.

use std::{collections::BTreeMap, sync::Arc};

use serde::Deserialize;
use strew_core::PointId;

use super::Ids;
use crate::{
    config::Except as Settings,
    name::is_name,
    service::named::{self, Changes, Found, NamedError, Places, Refused, Source},
};

/// The lists that are loaded, by name.
#[derive(Clone, Debug, Default)]
pub struct Lists {
    entries: BTreeMap<String, Arc<NamedList>>,
}

/// A list of points.
#[derive(Clone, Debug)]
pub struct NamedList {
    /// Its name.
    pub name: String,
    /// Where it comes from.
    pub source: Source,
    /// The BLAKE3 digest of its ids, in hexadecimal.
    pub digest: String,
    /// The ids by layer; those of no layer under an empty name.
    by_layer: BTreeMap<String, Arc<Ids>>,
}

/// A list in the configuration.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    ids: Vec<String>,
}

impl Lists {
    /// Loads the lists that the settings name.
    ///
    /// # Errors
    /// The first that is not valid.
    pub fn load(settings: &Settings) -> Result<Self, NamedError> {
        let (lists, _, refused) = Self::default().reload(settings);
        match refused.into_iter().next() {
            Some((error, _)) => Err(error),
            None => Ok(lists),
        }
    }

    /// The lists after reading everything again, what changed, and what was refused: the list of before stays in
    /// its place.
    #[must_use]
    pub fn reload(&self, settings: &Settings) -> (Self, Changes, Vec<Refused<NamedError>>) {
        let digest = |list: &NamedList| list.digest.clone();
        let places = Places {
            section: "except",
            named: &settings.named,
            folder: settings.folder(),
            endings: &["txt"],
            // A line has up to 110 bytes.
            most_bytes: settings.max_ids as u64 * 110,
        };
        let read = places.over(&self.entries, digest, |found, text| {
            NamedList::read(found, text, settings.max_ids)
        });
        let (after, refused) = match read {
            Ok((entries, refused)) => (Self { entries }, refused),
            // All of them stay.
            Err(error) => (self.clone(), vec![(error, None)]),
        };
        let changes = Changes::between(&self.entries, &after.entries, digest);
        (after, changes, refused)
    }

    /// The list of a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Arc<NamedList>> {
        self.entries.get(name)
    }

    /// All lists, by name.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Arc<NamedList>> {
        self.entries.values()
    }

    /// The names, for faults.
    #[must_use]
    pub fn names(&self) -> String {
        named::listed("list", self.entries.keys().map(String::as_str))
    }
}

impl NamedList {
    /// Reads a list.
    fn read(found: &Found, text: &str, most: usize) -> Result<Self, String> {
        // Editors of Windows begin files with this mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut by_layer: BTreeMap<String, Vec<PointId>> = BTreeMap::new();
        let mut count = 0;
        let mut add = |place: &str, item: &str| {
            let (layer, id) = split(item).ok_or_else(|| {
                format!("{place}: `{item}` is not an id; allowed: column:row, or layer/column:row")
            })?;
            count += 1;
            if count > most {
                return Err(format!("more than {most} ids; allowed: except.max_ids"));
            }
            by_layer
                .entry(layer.unwrap_or_default().into())
                .or_default()
                .push(id);
            Ok(())
        };
        match &found.source {
            Source::File(_) => {
                for (i, line) in text.lines().enumerate() {
                    let item = line.split('#').next().unwrap_or_default().trim();
                    if !item.is_empty() {
                        add(&format!("line {}", i + 1), item)?;
                    }
                }
            }
            _ => {
                let section: Section =
                    serde_json::from_str(text).map_err(|error| error.to_string())?;
                for (i, item) in section.ids.iter().enumerate() {
                    add(&format!("except.{}.ids[{i}]", found.name), item)?;
                }
            }
        }
        let ids = |(layer, ids)| (layer, Arc::new(Ids::new(ids)));
        let by_layer: BTreeMap<String, Arc<Ids>> = by_layer.into_iter().map(ids).collect();
        let mut hasher = blake3::Hasher::new();
        for (layer, ids) in &by_layer {
            hasher.update(&(layer.len() as u64).to_le_bytes());
            hasher.update(layer.as_bytes());
            hasher.update(ids.digest().as_bytes());
        }
        Ok(Self {
            name: found.name.clone(),
            source: found.source.clone(),
            digest: hasher.finalize().to_hex().to_string(),
            by_layer,
        })
    }

    /// How many ids it has.
    #[must_use]
    pub fn len(&self) -> usize {
        self.by_layer.values().map(|ids| ids.len()).sum()
    }

    /// Whether it has no ids.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.by_layer.is_empty()
    }

    /// The ids of a layer, or with an empty name those of no layer.
    #[must_use]
    pub fn of(&self, layer: &str) -> Option<&Arc<Ids>> {
        self.by_layer.get(layer)
    }

    /// The layers that it has ids of.
    pub fn layers(&self) -> impl Iterator<Item = &str> {
        let names = self.by_layer.keys().map(String::as_str);
        names.filter(|name| !name.is_empty())
    }
}

/// The layer and the id of an item: `12:-3` or `trees/12:-3`.
#[must_use]
pub fn split(item: &str) -> Option<(Option<&str>, PointId)> {
    let (layer, id) = match item.rsplit_once('/') {
        Some((layer, id)) if is_name(layer) => (Some(layer), id),
        Some(_) => return None,
        None => (None, item),
    };
    Some((layer, id.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(text: &str) -> Result<NamedList, String> {
        let settings = Settings {
            max_ids: 3,
            named: text.parse::<toml::Table>().map_or_else(
                |error| panic!("{error}"),
                |table| {
                    let tables = table.into_iter();
                    let table =
                        |(name, value): (_, toml::Value)| Some((name, value.as_table()?.clone()));
                    tables.filter_map(table).collect()
                },
            ),
            ..Settings::default()
        };
        let lists = Lists::load(&settings).map_err(|error| error.to_string())?;
        let first = lists.iter().next().expect("a list");
        Ok(NamedList::clone(first))
    }

    #[test]
    fn ids_are_sorted_by_layer() {
        let felled = list("[felled]\nids = ['3:4', 'oak/-5:6', '1:2', '1:2']").expect_err("4 ids");
        assert!(felled.contains("more than 3 ids"), "{felled}");
        let felled = list("[felled]\nids = ['3:4', 'oak/-5:6', '1:2']").expect("valid");
        assert_eq!(
            (felled.len(), felled.layers().collect::<Vec<_>>()),
            (3, vec!["oak"])
        );
        assert_eq!(
            felled.of("").map(|ids| ids.sorted[0]),
            Some(PointId { x: 1, y: 2 })
        );
        let other = list("[felled]\nids = ['1:2', '3:4', 'oak/-5:6']").expect("valid");
        assert_eq!(other.digest, felled.digest);
        let other = list("[felled]\nids = ['1:2', '3:4', 'elm/-5:6']").expect("valid");
        assert_ne!(other.digest, felled.digest);
    }

    #[test]
    fn what_is_no_id_is_named() {
        for (text, expected) in [
            ("[a]\nids = ['x']", "except.a.ids[0]: `x` is not an id"),
            ("[a]\nids = ['1:2', 'a b/1:2']", "except.a.ids[1]"),
            ("[a]\nids = 3", "invalid type"),
            ("[a]\nid = ['1:2']", "unknown field `id`"),
        ] {
            let error = list(text).expect_err(text);
            assert!(error.contains(expected), "{error}");
        }
    }
}
