//! Lists of points with names: those of the configuration and of a folder, and those that clients have sent.
//!
//! A list is text, an id a line: `12:-3`, in space `12:-3:7`, or `trees/12:-3` for a point of a layer. What follows `#`
//! is a comment. Or it is an object of JSON with these ids: `{"ids": ["12:-3"]}`.

use std::{borrow::Cow, collections::BTreeMap, iter, mem::size_of, ops::Deref, sync::Arc};

use schemars::JsonSchema;
use serde::Deserialize;
use strew_config::{Except as Settings, name::is_title};
use strew_error::Fault;

use super::{Id, Ids};
use crate::{
    bounded_list::look,
    named::{self, Loaded, NamedError, Names, Places, Reread},
    sent::{Sendable, Sender, Sent},
};

const MOST_LAYERS: usize = 1000;

/// The lists that are loaded, by name, and those that were sent.
#[derive(Clone, Debug, Default)]
pub struct Lists {
    entries: Names<NamedList>,
    sent: Arc<Sent<NamedList>>,
    most: usize,
}

#[derive(Clone, Debug)]
pub struct NamedList {
    /// Its name; of one that was sent, its digest.
    pub name: String,
    /// The BLAKE3 digest of its ids, in hexadecimal.
    pub digest: String,
    /// The ids by layer; those of no layer under an empty name.
    by_layer: BTreeMap<String, Arc<Ids>>,
}

/// A list as an object.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "SentList")]
pub struct Section<'a> {
    /// Ids of points: column:row, in space x:y:z, or layer/column:row for a point of a layer.
    #[serde(borrow)]
    ids: Vec<Item<'a>>,
}

/// An item of a list, which is not copied.
#[derive(Deserialize, JsonSchema)]
#[serde(transparent)]
struct Item<'a>(#[serde(borrow)] Cow<'a, str>);

impl Lists {
    /// Loads the lists that the settings name.
    pub fn load(settings: &Settings) -> Result<Self, NamedError> {
        let empty = Self {
            sent: Arc::new(Sent::new(settings.max_sent_bytes)),
            ..Self::default()
        };
        named::all_of(empty.reload(settings))
    }

    pub fn reload(&self, settings: &Settings) -> Reread<Self> {
        let places = Places {
            section: "except",
            named: &settings.named,
            folder: settings.folder(),
            endings: &["txt"],
            rasters: &[],
            // A line has up to 110 bytes.
            most_bytes: settings.max_ids as u64 * 110,
        };
        let (entries, refused) = self.entries.read(&places, |found, text| {
            let list = NamedList::read(text, settings.max_ids);
            let list = list.map_err(|fault| fault.to_string())?;
            let name = found.name.clone();
            Ok(NamedList { name, ..list })
        });
        let changes = self.entries.changes_to(&entries);
        let after = Self {
            entries,
            sent: self.sent.clone(),
            most: settings.max_ids,
        };
        (after, changes, refused)
    }

    /// The list of a digest that was sent, or of a name. What a digest names is never another list.
    pub fn get(&self, name: &str) -> Option<Arc<NamedList>> {
        let sent = self.sent.get(name);
        sent.or_else(|| self.entries.get(name).cloned())
    }

    /// The memory that it takes to read a list that is sent, at most, in bytes.
    pub fn reading(&self, body: &[u8]) -> usize {
        /// An id is held as text, then as a number, in lists that double as they grow.
        const ID: usize = 3 * (size_of::<Item<'_>>() + size_of::<Id>());
        let ends = body.iter().filter(|&&byte| matches!(byte, b'\n' | b','));
        // Text that is not Unicode is copied.
        4 * body.len() + ID * ends.take(self.most).count() + MOST_LAYERS * LAYER
    }

    /// Reads a list that was sent, and holds it.
    pub fn hold(&self, text: &str, sender: Sender) -> Result<Arc<NamedList>, Fault> {
        let list = NamedList::read(text, self.most)?;
        let size = list.size();
        self.sent.hold(list, sender).ok_or_else(|| {
            let detail = format!("takes {size} bytes, which there is no room for");
            let allowed = "a smaller list, or except.max_sent_bytes raised";
            Fault::new("ids", "", detail, allowed)
        })
    }
}

impl Deref for Lists {
    type Target = Names<NamedList>;

    fn deref(&self) -> &Self::Target {
        &self.entries
    }
}

impl Loaded for NamedList {
    const KIND: &'static str = "list";

    fn digest(&self) -> String {
        self.digest.clone()
    }
}

impl NamedList {
    fn read(text: &str, most: usize) -> Result<Self, Fault> {
        // Editors of Windows begin files with this mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut list = Unsorted::default();
        let not_wanted = |detail| Fault::new("body", "", detail, "a list");
        if text.trim_start().starts_with('{') {
            // No id has a comma, so several are counted before they take memory.
            let commas = text.bytes().filter(|&byte| byte == b',').count();
            if commas > 0 {
                check_count(commas + 1, most)?;
            }
            let section: Section<'_> = serde_json::from_str(text).map_err(|error| {
                let allowed = "an object of ids, or text with an id a line";
                Fault::new("body", "", error.to_string(), allowed)
            })?;
            check_count(section.ids.len(), most)?;
            for (i, Item(item)) in section.ids.iter().enumerate() {
                look(i).map_err(not_wanted)?;
                list.add(item, || format!("ids[{i}]"))?;
            }
        } else {
            for (i, (item, rest)) in lines(text).enumerate() {
                look(i).map_err(not_wanted)?;
                if item.is_empty() {
                    continue;
                }
                if list.1 == most {
                    let others = lines(rest).filter(|(item, _)| !item.is_empty());
                    check_count(most + 1 + others.count(), most)?;
                }
                let before = &text[..text.len() - rest.len()];
                let line = || before.trim_end_matches('\n').matches('\n').count() + 1;
                list.add(item, || format!("line {}", line()))?;
            }
        }
        let ids = |(layer, ids)| (layer, Arc::new(Ids::new(ids)));
        let by_layer: BTreeMap<String, Arc<Ids>> = list.0.into_iter().map(ids).collect();
        let mut hasher = blake3::Hasher::new();
        for (layer, ids) in &by_layer {
            hasher.update(&(layer.len() as u64).to_le_bytes());
            hasher.update(layer.as_bytes());
            hasher.update(ids.digest().as_bytes());
        }
        let digest = hasher.finalize().to_hex().to_string();
        Ok(Self {
            name: digest.clone(),
            digest,
            by_layer,
        })
    }

    /// Whether another list may have its name later.
    pub fn may_change(&self) -> bool {
        self.name != self.digest
    }

    pub fn len(&self) -> usize {
        self.by_layer.values().map(|ids| ids.len()).sum()
    }

    /// Whether it has no ids.
    pub fn is_empty(&self) -> bool {
        self.by_layer.is_empty()
    }

    /// The ids of a layer, or with an empty name those of no layer.
    pub fn of(&self, layer: &str) -> Option<&Arc<Ids>> {
        self.by_layer.get(layer)
    }

    pub fn layers(&self) -> impl Iterator<Item = &str> {
        let names = self.by_layer.keys().map(String::as_str);
        names.filter(|name| !name.is_empty())
    }
}

/// The most bytes of a layer of a list, besides its ids.
const LAYER: usize = 512;

impl Sendable for NamedList {
    fn name(&self) -> &str {
        &self.name
    }

    fn size(&self) -> usize {
        /// The most bytes of a list, besides its layers.
        const LIST: usize = 4 << 10;
        let ids = self.by_layer.values().map(|ids| ids.size());
        LIST + LAYER * self.by_layer.len() + ids.sum::<usize>()
    }
}

/// The ids of a list by layer, as they are read, and their number.
#[derive(Default)]
struct Unsorted(BTreeMap<String, Vec<Id>>, usize);

impl Unsorted {
    /// Adds the item of a place.
    fn add(&mut self, item: &str, place: impl Fn() -> String) -> Result<(), Fault> {
        let Some((layer, id)) = split(item) else {
            let allowed = "column:row, in space x:y:z, or layer/column:row";
            return Err(Fault::new(&place(), item, "not an id", allowed));
        };
        let layer = layer.unwrap_or_default();
        self.1 += 1;
        if let Some(ids) = self.0.get_mut(layer) {
            ids.push(id);
        } else if self.0.len() == MOST_LAYERS {
            let allowed = format!("ids of at most {MOST_LAYERS} layers");
            return Err(Fault::new(&place(), item, "one layer too many", allowed));
        } else {
            self.0.insert(layer.into(), vec![id]);
        }
        Ok(())
    }
}

/// The item of each line of a text that is not blank, without its comment, and the lines after it.
fn lines(text: &str) -> impl Iterator<Item = (&str, &str)> {
    let mut rest = text;
    iter::from_fn(move || {
        rest = rest.trim_start();
        if rest.is_empty() {
            return None;
        }
        let (line, after) = rest.split_once('\n').unwrap_or((rest, ""));
        rest = after;
        let item = line.split('#').next().unwrap_or_default();
        Some((item.trim_end(), after))
    })
}

fn check_count(count: usize, most: usize) -> Result<(), Fault> {
    if count <= most {
        return Ok(());
    }
    let allowed = format!("at most {most} ids in a list (except.max_ids)");
    Err(Fault::new("ids", count, "too many", allowed))
}

/// The layer and the id of an item: `12:-3`, `trees/12:-3` or in space `12:-3:7`.
pub fn split(item: &str) -> Option<(Option<&str>, Id)> {
    let (layer, id) = match item.rsplit_once('/') {
        Some((layer, id)) if is_title(layer) => (Some(layer), id),
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
        assert!(felled.contains("at most 3 ids"), "{felled}");
        let felled = list("[felled]\nids = ['3:4', 'oak/-5:6', '1:2']").expect("valid");
        assert_eq!(
            (felled.len(), felled.layers().collect::<Vec<_>>()),
            (3, vec!["oak"])
        );
        assert_eq!(
            felled.of("").map(|ids| Id::Plane(ids.plane[0])),
            "1:2".parse().ok()
        );
        let other = list("[felled]\nids = ['1:2', '3:4', 'oak/-5:6']").expect("valid");
        assert_eq!(other.digest, felled.digest);
        let other = list("[felled]\nids = ['1:2', '3:4', 'elm/-5:6']").expect("valid");
        assert_ne!(other.digest, felled.digest);
        // Ids of the plane and of space may stand together.
        let mined = list("[mined]\nids = ['7:8:9', '1:2', '-7:8:9']").expect("valid");
        let ids = mined.of("").expect("of no layer");
        let space: Vec<_> = ids.in_space().iter().map(ToString::to_string).collect();
        assert_eq!(
            (ids.len(), ids.plane.len(), space),
            (3, 1, vec!["-7:8:9".into(), "7:8:9".into()])
        );
    }

    #[test]
    fn what_is_no_id_is_named() {
        for (text, expected) in [
            ("[a]\nids = ['x']", "`ids[0]` = `x`: not an id"),
            (
                "[a]\nids = ['1:2', \"a\\u0000b/1:2\"]",
                "[except.a] of the configuration: `ids[1]`",
            ),
            ("[a]\nids = 3", "invalid type"),
            ("[a]\nid = ['1:2']", "unknown field `id`"),
        ] {
            let error = list(text).expect_err(text);
            assert!(error.contains(expected), "{error}");
        }
    }
}
