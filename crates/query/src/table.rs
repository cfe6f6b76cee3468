//! The choice of the table that answers: by profile, α and map size, and by a pinned digest.

use std::sync::{Arc, LazyLock};

use strew_catalog::{Catalog, Dimension, Entry, Key, MAX_PATTERN_RADIUS, Offer, PATTERN};
use strew_core::{Alpha, map::Size};
use strew_error::{Checked, Error, Fault, Faults, Together as _};

use super::{
    DEFAULT_ALPHA, DEFAULT_PROFILE, Parameter, Values,
    parameters::{ALPHA, MAP, PROFILE, TABLE},
};

/// The table of some values; `profile` where it is not among them.
pub(super) fn check(
    values: &Values,
    profile: Option<&str>,
    catalog: &Catalog,
) -> Checked<(Arc<Entry>, Option<String>)> {
    let (named, text, map, pin) = (
        values.get::<String>(&PROFILE),
        values.get::<String>(&ALPHA),
        values.get::<String>(&MAP),
        digest(values, &TABLE),
    )
        .together()?;
    let profile = profile.or(named.as_deref()).unwrap_or(DEFAULT_PROFILE);
    let alpha_text = text.as_deref().unwrap_or(DEFAULT_ALPHA);
    let fault = |parameter: &Parameter, value: &str, detail: String, allowed: String| -> Faults {
        let field = format!("{}{}", values.path(), parameter.name);
        Fault::new(&field, value, detail, allowed).into()
    };
    let (dimension, offer) = (values.dimension(), Offer(catalog.audience()));
    let is_pattern = profile == PATTERN && dimension == Dimension::Plane;
    let is_known = is_pattern || catalog.has_profile(dimension, profile);
    let alpha = parse(alpha_text).map_err(|error| {
        let allowed = match is_known {
            _ if is_pattern => "any number between 1 and 2".into(),
            true => some(
                catalog
                    .alphas(dimension, profile)
                    .iter()
                    .map(ToString::to_string),
            ),
            false => loaded(catalog, dimension),
        };
        fault(&ALPHA, alpha_text, error.to_string(), allowed)
    });
    let known = match is_known {
        true => Ok(()),
        false => {
            let offer = offer.of_profile(dimension, profile);
            let detail = format!("no such profile is loaded{offer}");
            Err(fault(&PROFILE, profile, detail, loaded(catalog, dimension)))
        }
    };
    let (alpha, ()) = (alpha, known).together()?;
    let wanted = Wanted {
        dimension,
        profile: profile.into(),
        alpha,
        catalog,
    };
    let size = map.as_deref().map(|text| (text, text.parse::<Size>().ok()));
    let found = match size {
        Some((_, size)) => size.and_then(|size| wanted.of_size(size)),
        None => wanted.of_any_size(),
    };
    if let Some(entry) = found {
        return Ok((entry, pin));
    }
    let sizes = catalog.sizes(dimension, profile, alpha);
    if size.is_none() && wanted.is_usual() && !sizes.is_empty() {
        let offer = offer.of_table(dimension, profile, alpha, Some("m"));
        let detail = format!("missing, and the query means map m, which is not loaded{offer}");
        let allowed = some(sizes.iter().map(ToString::to_string));
        let fault = Fault::missing(&format!("{}{}", values.path(), MAP.name), allowed);
        return Err(Fault { detail, ..fault }.into());
    }
    let size = size.filter(|_| is_pattern || !sizes.is_empty());
    let Some((text, size)) = size else {
        let offer = offer.of_table(dimension, profile, alpha, map.as_deref());
        let detail = format!("the profile `{profile}` is not loaded for this alpha{offer}");
        let allowed = some(
            catalog
                .alphas(dimension, profile)
                .iter()
                .map(ToString::to_string),
        );
        return Err(fault(&ALPHA, alpha_text, detail, allowed));
    };
    let offer = size.map_or(String::new(), |_| {
        offer.of_table(dimension, profile, alpha, Some(text))
    });
    let detail = format!("the profile `{profile}` is not loaded with this map size{offer}");
    let allowed = match is_pattern {
        true => format!("s, m, l, or r and R from 0 to {MAX_PATTERN_RADIUS}"),
        false => some(sizes.iter().map(ToString::to_string)),
    };
    Err(fault(&MAP, text, detail, allowed))
}

struct Wanted<'a> {
    dimension: Dimension,
    profile: Arc<str>,
    alpha: Alpha,
    catalog: &'a Catalog,
}

impl Wanted<'_> {
    fn loaded(&self, size: Size) -> Option<Arc<Entry>> {
        self.catalog.entry(&Key {
            dimension: self.dimension,
            profile: self.profile.clone(),
            alpha: self.alpha,
            size,
            mix: None,
        })
    }

    /// The pattern itself needs no table.
    fn derived(&self, size: Size) -> Option<Arc<Entry>> {
        let is_pattern = *self.profile == *PATTERN && self.dimension == Dimension::Plane;
        is_pattern.then(|| self.catalog.pattern(self.alpha, size))?
    }

    fn of_size(&self, size: Size) -> Option<Arc<Entry>> {
        self.loaded(size).or_else(|| self.derived(size))
    }

    /// Whether the query means the table that it means everywhere: the one of map m.
    fn is_usual(&self) -> bool {
        let is_plane = self.dimension == Dimension::Plane;
        let is_alpha = || parse(DEFAULT_ALPHA).is_ok_and(|usual| usual == self.alpha);
        is_plane && *self.profile == *DEFAULT_PROFILE && is_alpha()
    }

    /// The usual sizes first, then the smallest.
    fn of_any_size(&self) -> Option<Arc<Entry>> {
        if self.is_usual() {
            return self.loaded(Size::M);
        }
        // Much power at low frequencies makes the returns of a small map conspicuous.
        let sizes: &[Size] = match &*self.profile {
            "pink" => &[Size::L, Size::M, Size::S],
            _ => &[Size::M, Size::S],
        };
        let usual = sizes.iter().find_map(|&size| self.loaded(size));
        let smallest = || {
            let sizes = self
                .catalog
                .sizes(self.dimension, &self.profile, self.alpha);
            self.loaded(*sizes.first()?)
        };
        usual.or_else(smallest).or_else(|| self.derived(Size::S))
    }
}

pub fn chosen(values: &Values, catalog: &Catalog) -> Result<Arc<Entry>, Error> {
    let ((), (entry, pin)) = (values.read(), check(values, None, catalog)).together()?;
    hold(&entry, pin.as_deref())?;
    Ok(entry)
}

/// A digest that something must have, in lower case.
pub fn digest(values: &Values, parameter: &'static Parameter) -> Checked<Option<String>> {
    let Some(text) = values.get::<String>(parameter)? else {
        return Ok(None);
    };
    if is_digest(&text) {
        return Ok(Some(text.to_ascii_lowercase()));
    }
    Err(values.fault(parameter, "not a digest").into())
}

/// Whether a text is a BLAKE3 digest.
pub(super) fn is_digest(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit())
}

pub(super) fn hold(entry: &Entry, pin: Option<&str>) -> Result<(), Error> {
    match pin {
        Some(pin) if pin != entry.digest => Err(Error::OtherTable {
            pinned: pin.into(),
            loaded: entry.digest.clone(),
        }),
        _ => Ok(()),
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

fn loaded(catalog: &Catalog, dimension: Dimension) -> String {
    let of = |profile: &str| {
        let alphas = some(
            catalog
                .alphas(dimension, profile)
                .iter()
                .map(ToString::to_string),
        );
        format!("{profile} (alpha {alphas})")
    };
    match catalog.profiles(dimension).as_slice() {
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
