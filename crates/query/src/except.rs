//! Reading what sets are without: ids of points and names of lists.

use std::{collections::BTreeSet, sync::Arc};

use strew_catalog::{
    Catalog,
    except::{Except, Id, Ids, MOST_GIVEN, NamedList, split},
};
use strew_error::{Checked, Fault, Faults, all, unknown};

use super::{Set, Values, parameters::EXCEPT, rules, table::is_digest};

/// An item of `except`.
enum Item {
    Id(Option<String>, Id),
    List(Arc<NamedList>),
}

struct Items(Vec<(String, Item)>);

impl Items {
    fn of(values: &Values, catalog: &Catalog) -> Checked<Self> {
        let texts = values.get::<Vec<String>>(&EXCEPT)?.unwrap_or_default();
        let field = |i: usize| format!("{}{}[{i}]", values.path(), EXCEPT.name);
        if texts.len() > MOST_GIVEN {
            let allowed = format!("at most {MOST_GIVEN}; more in a list");
            let name = format!("{}{}", values.path(), EXCEPT.name);
            return Err(Fault::new(&name, texts.len(), "too many", allowed).into());
        }
        let mut seen = BTreeSet::new();
        let twice = texts.iter().position(|text| !seen.insert(text.as_str()));
        if let Some(i) = twice {
            let allowed = "each id and list once";
            return Err(Fault::new(&field(i), &texts[i], "given twice", allowed).into());
        }
        let lists = catalog.except();
        let item = |(i, text): (usize, &String)| {
            let wrong = |detail: String, allowed: String| {
                Faults::from(Fault::new(&field(i), text, detail, allowed))
            };
            let read = match split(text) {
                Some((layer, id)) => Item::Id(layer.map(Into::into), id),
                None if text.contains(':') => {
                    return Err(wrong("not an id".into(), EXCEPT.allowed()));
                }
                None => {
                    let names = lists.iter().map(|list| list.name.as_str());
                    let list = lists.get(text).ok_or_else(|| {
                        let (detail, allowed) = (unknown("list", text, names), lists.names());
                        match is_digest(text) {
                            true => wrong(detail + catalog.audience().list, allowed),
                            false => wrong(detail, allowed),
                        }
                    })?;
                    Item::List(list)
                }
            };
            Ok((field(i), read))
        };
        Ok(Self(all(texts.iter().enumerate().map(item))?))
    }

    /// Refuses what has no effect in a set, or beside layers of these names: an id or a list of another one.
    fn check(&self, layers: Option<&[&str]>) -> Checked<()> {
        let check = |(field, item): &(String, Item)| {
            let wrong = |value: &str, detail: &str, allowed: String| {
                Err(Fault::new(field, value, detail, allowed).into())
            };
            match (item, layers) {
                (Item::Id(None, id), Some(layers)) => {
                    let detail = "beside layers an id needs the name of its layer";
                    let layer = layers.first().copied().unwrap_or("layer");
                    wrong(&id.to_string(), detail, format!("such as {layer}/{id}"))
                }
                (Item::Id(Some(layer), _), Some(layers)) if !layers.contains(&layer.as_str()) => {
                    let detail = unknown("layer", layer, layers.iter().copied());
                    wrong(layer, &detail, layers.join(", "))
                }
                (Item::Id(Some(layer), id), None) => {
                    let detail = "there are no layers here";
                    wrong(&format!("{layer}/{id}"), detail, format!("such as {id}"))
                }
                (Item::List(list), Some(_)) if list.of("").is_some() => {
                    let detail = "the list has ids without a layer";
                    wrong(
                        &list.name,
                        detail,
                        "beside layers, lists of layer/id".into(),
                    )
                }
                (Item::List(list), None) if list.of("").is_none() && !list.is_empty() => {
                    let detail = "the list has ids of layers only";
                    wrong(&list.name, detail, "lists of ids without a layer".into())
                }
                _ => Ok(()),
            }
        };
        all(self.0.iter().map(check)).map(drop)
    }

    /// Adds the points to leave out of one layer, or of a single set if its name is empty. Ids without a layer count
    /// only with `bare`.
    fn add_to(&self, except: &mut Except, layer: &str, bare: bool) {
        let mut given = vec![];
        for (field, item) in &self.0 {
            match item {
                Item::Id(named, id) => {
                    let is_here = named.as_deref().map_or(bare, |named| named == layer);
                    given.extend(is_here.then(|| (field.clone(), *id)));
                }
                Item::List(list) => {
                    let parts = [
                        bare.then_some(""),
                        Some(layer).filter(|name| !name.is_empty()),
                    ];
                    let parts = parts.into_iter().flatten().filter_map(|name| list.of(name));
                    except.parts.extend(parts.cloned());
                    except.names.push(list.name.clone());
                    except.may_change |= list.may_change();
                }
            }
        }
        if !given.is_empty() {
            let ids = given.iter().map(|(_, id)| *id).collect();
            except.parts.push(Arc::new(Ids::new(ids)));
            except.given.extend(given);
        }
    }
}

pub(super) fn of_set(values: &Values, catalog: &Catalog) -> Checked<Option<Except>> {
    if !values.has(&EXCEPT) {
        return Ok(None);
    }
    let items = Items::of(values, catalog)?;
    items.check(None)?;
    let mut except = Except::default();
    items.add_to(&mut except, "", true);
    fits(values, except)
}

/// Adds to each layer the points that it leaves out: by its own values and by those that all layers have in common.
pub(super) fn of_layers(
    common: &Values,
    layers: &[&Values],
    sets: &mut [Set],
    catalog: &Catalog,
) -> Checked<()> {
    let shared = Items::of(common, catalog)?;
    let names: Vec<&str> = sets.iter().map(|set| set.name.as_str()).collect();
    shared.check(Some(&names))?;
    let of_layer = |(values, name): (&&Values, &&str)| {
        let own = Items::of(values, catalog)?;
        own.check_layer(name)?;
        let mut except = Except::default();
        shared.add_to(&mut except, name, false);
        own.add_to(&mut except, name, true);
        fits(values, except)
    };
    let all = all(layers.iter().zip(&names).map(of_layer))?;
    for (set, except) in sets.iter_mut().zip(all) {
        set.except = except;
    }
    Ok(())
}

impl Items {
    fn check_layer(&self, name: &str) -> Checked<()> {
        let other = self.0.iter().find_map(|(field, item)| match item {
            Item::Id(Some(layer), _) if layer != name => Some((field, layer)),
            _ => None,
        });
        match other {
            None => Ok(()),
            Some((field, layer)) => {
                let detail = "this is the layer of another name";
                Err(Fault::new(field, layer, detail, name).into())
            }
        }
    }
}

/// Nothing if nothing is left out; refuses what cannot go together.
fn fits(values: &Values, except: Except) -> Checked<Option<Except>> {
    if except.parts.is_empty() && except.names.is_empty() {
        return Ok(None);
    }
    rules::check_as_given(values, &EXCEPT)?;
    Ok(Some(except))
}
