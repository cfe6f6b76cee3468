//! Which table answers: by profile, α and map size, and by a pinned digest.

use std::sync::{Arc, LazyLock};

use strew_core::{Alpha, map::Size};

use super::{
    Checked, DEFAULT_ALPHA, DEFAULT_PROFILE, Faults, Parameter, Together as _, Values,
    parameters::{ALPHA, MAP, PROFILE, TABLE},
};
use crate::service::{Catalog, Entry, Error, Fault, Key};

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
        pin(values),
    )
        .together()?;
    let profile = profile.map(Into::into).or(named);
    let profile = profile.unwrap_or_else(|| DEFAULT_PROFILE.into());
    let text = text.unwrap_or_else(|| DEFAULT_ALPHA.into());
    let fault = |parameter: &Parameter, value: &str, detail: String, allowed: String| -> Faults {
        let field = format!("{}{}", values.path(), parameter.name);
        Fault::new(&field, value, detail, allowed).into()
    };
    let is_loaded = (catalog.entries()).any(|entry| *entry.key.profile == *profile);
    let allowed = || match is_loaded {
        true => some(catalog.alphas(&profile).iter().map(ToString::to_string)),
        false => loaded(catalog),
    };
    let alpha = parse(&text).map_err(|error| fault(&ALPHA, &text, error.to_string(), allowed()));
    let known = match is_loaded {
        true => Ok(()),
        false => Err(fault(
            &PROFILE,
            &profile,
            "no such profile is loaded".into(),
            loaded(catalog),
        )),
    };
    let (alpha, ()) = (alpha, known).together()?;
    let sizes = catalog.sizes(&profile, alpha);
    let Some(&smallest) = sizes.first() else {
        let detail = format!("the profile `{profile}` is not loaded for this alpha");
        return Err(fault(&ALPHA, &text, detail, allowed()));
    };
    let size = match map.as_deref() {
        Some(text) => {
            let size = text.parse::<Size>().ok();
            size.filter(|size| sizes.contains(size)).ok_or_else(|| {
                let detail = format!("the profile `{profile}` is not loaded with this map size");
                fault(
                    &MAP,
                    text,
                    detail,
                    some(sizes.iter().map(ToString::to_string)),
                )
            })?
        }
        None => *[Size::M, Size::S]
            .iter()
            .find(|size| sizes.contains(size))
            .unwrap_or(&smallest),
    };
    let key = Key {
        profile: profile.as_str().into(),
        alpha,
        size,
        mix: None,
    };
    let entry = catalog.entry(&key);
    let gone = || {
        fault(
            &PROFILE,
            &profile,
            "no such profile is loaded".into(),
            loaded(catalog),
        )
    };
    Ok((entry.ok_or_else(gone)?, pin))
}

/// The digest that the table must have, in lower case.
fn pin(values: &Values) -> Checked<Option<String>> {
    let Some(text) = values.get::<String>(&TABLE)? else {
        return Ok(None);
    };
    if text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return Ok(Some(text.to_ascii_lowercase()));
    }
    Err(values.fault(&TABLE, "not a digest").into())
}

/// Checks that a table is the pinned one.
///
/// # Errors
/// [`Error::OtherTable`] if it is not.
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
