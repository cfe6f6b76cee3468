//! Which table answers: by profile, α and map size, and by a pinned digest.

use std::sync::{Arc, LazyLock};

use strew_core::{Alpha, map::Size};

use super::{DEFAULT_ALPHA, DEFAULT_PROFILE, pin};
use crate::service::{Catalog, Entry, Error, Fault, Key};

/// The table as it was asked for, not checked. What is absent takes its default.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TableDraft {
    /// The name of the noise profile.
    pub profile: Option<String>,
    /// The number α, in any form that is read.
    pub alpha: Option<String>,
    /// The size of the map: `s`, `m`, `l`; the size S if it is loaded, else the smallest, by
    /// default.
    pub map: Option<String>,
    /// The digest that the table must have.
    pub table: Option<String>,
}

impl TableDraft {
    /// The table that is asked for; `path` is put before the names of fields.
    pub(super) fn check(&self, catalog: &Catalog, path: &str) -> Result<Arc<Entry>, Vec<Fault>> {
        let fault = |name: &str, value: &str, detail: String, allowed: String| {
            Fault::new(&format!("{path}{name}"), value, detail, allowed)
        };
        let profile = self.profile.as_deref().unwrap_or(DEFAULT_PROFILE);
        let text = self.alpha.as_deref().unwrap_or(DEFAULT_ALPHA);
        let is_loaded = catalog
            .entries()
            .any(|entry| *entry.key.profile == *profile);
        let mut faults = vec![];
        faults.extend(pin::read(self.table.as_deref(), path).err());
        if !is_loaded {
            let detail = "no such profile is loaded".into();
            faults.push(fault("profile", profile, detail, loaded(catalog)));
        }
        let allowed = || {
            if is_loaded {
                some(catalog.alphas(profile).iter().map(ToString::to_string))
            } else {
                loaded(catalog)
            }
        };
        let alpha = parse(text).map_err(|error| {
            faults.push(fault("alpha", text, error.to_string(), allowed()));
        });
        let (Ok(alpha), true) = (alpha, faults.is_empty()) else {
            return Err(faults);
        };
        let sizes = catalog.sizes(profile, alpha);
        let Some(&smallest) = sizes.first() else {
            let detail = format!("the profile `{profile}` is not loaded for this alpha");
            return Err(vec![fault("alpha", text, detail, allowed())]);
        };
        let size = match self.map.as_deref() {
            Some(text) => {
                let size = text.parse::<Size>().ok();
                size.filter(|size| sizes.contains(size)).ok_or_else(|| {
                    let detail =
                        format!("the profile `{profile}` is not loaded with this map size");
                    let allowed = some(sizes.iter().map(ToString::to_string));
                    vec![fault("map", text, detail, allowed)]
                })?
            }
            None => *[Size::M, Size::S]
                .iter()
                .find(|size| sizes.contains(size))
                .unwrap_or(&smallest),
        };
        let entry = catalog.entry(&Key {
            profile: profile.into(),
            alpha,
            size,
        });
        entry.ok_or_else(Vec::new)
    }

    /// Checks that a table is the pinned one.
    ///
    /// # Errors
    /// [`Error::OtherTable`] if it is not.
    pub(super) fn hold(&self, entry: &Entry) -> Result<(), Error> {
        pin::compare(self.table.as_deref(), entry)
    }
}

/// The number of a text; that of most queries has been read before.
fn parse(text: &str) -> Result<Alpha, strew_core::Error> {
    static DEFAULT: LazyLock<Option<Alpha>> = LazyLock::new(|| DEFAULT_ALPHA.parse().ok());
    match *DEFAULT {
        Some(alpha) if text == DEFAULT_ALPHA => Ok(alpha),
        _ => text.parse(),
    }
}

/// What is loaded, for an error.
fn loaded(catalog: &Catalog) -> String {
    let of = |profile: &str| {
        let alphas = some(catalog.alphas(profile).iter().map(ToString::to_string));
        format!("{profile} (alpha {alphas})")
    };
    match catalog.profiles().as_slice() {
        [] => "nothing: no table is loaded".into(),
        profiles => some(profiles.iter().map(|profile| of(profile))),
    }
}

/// A list, but not a long one: errors travel in headers, too.
fn some(items: impl Iterator<Item = String>) -> String {
    const SHOWN: usize = 16;
    let mut items: Vec<String> = items.collect();
    let more = items.len().saturating_sub(SHOWN);
    if more > 0 {
        items.truncate(SHOWN);
        items.push(format!("and {more} more (see the list of profiles)"));
    }
    items.join(", ")
}
