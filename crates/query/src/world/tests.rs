//! Tests of worlds: what queries take from them, and which are refused.

use strew_catalog::{Catalog, named::NamedError};
use strew_config::Worlds as Settings;
use strew_error::Error;

use super::Worlds;
use crate::{Assets, Draft, groups, parse_pairs};

fn loaded(text: &str) -> Result<Assets, NamedError> {
    let catalog = Catalog::load(true, None).expect("built in");
    let table: toml::Table = text.parse().expect("TOML");
    let named = table.into_iter().filter_map(|(name, value)| {
        let toml::Value::Table(table) = value else {
            return None;
        };
        Some((name, table))
    });
    let settings = Settings {
        named: named.collect(),
        ..Settings::default()
    };
    let worlds = Worlds::load(&settings, &catalog, 100)?;
    Ok(Assets::from(catalog).with_worlds(worlds))
}

fn body(catalog: &Assets, address: &str) -> serde_json::Value {
    let draft = Draft::of(parse_pairs(address, groups::POINTS));
    let (filled, world) = draft.filled(&catalog.worlds).expect("known");
    assert!(world.is_some());
    filled.to_body().into()
}

const FOREST: &str = "[meadow]\nspacing = 2\nseed = 7\nformat = 'csv'\n\
    [[forest.layers]]\nname = 'trees'\nspacing = 3.5\n\
    [[forest.layers]]\nname = 'rocks'\nspacing = 5\nclear_of = { trees = 1.5 }\n";

#[test]
fn what_a_query_lacks_comes_from_the_world() {
    let worlds = loaded(FOREST).expect("valid");
    let meadow = body(&worlds, "bbox=0,0,1,1&world=meadow&density=4&seed=8");
    assert_eq!(meadow["density"], 4.0, "an amount replaces the world's");
    assert_eq!(meadow.get("spacing"), None);
    assert_eq!(
        (&meadow["seed"], &meadow["format"]),
        (&8.into(), &"csv".into())
    );
    let forest = body(&worlds, "bbox=0,0,1,1&world=forest");
    assert_eq!(forest["layers"][1]["clear_of"]["trees"], 1.5);
    let names = worlds.worlds.iter().map(|world| world.name.as_str());
    assert_eq!(names.collect::<Vec<_>>(), ["forest", "meadow"]);
}

#[test]
fn a_common_seed_gives_each_layer_one_of_its_own() {
    let worlds = loaded(FOREST).expect("valid");
    let seeds = |address: &str| {
        let draft = Draft::of(parse_pairs(address, groups::POINTS));
        let (query, _) = draft.check(&worlds, 100).expect("valid");
        query.sets.iter().map(|set| set.seed.0).collect::<Vec<_>>()
    };
    let forest = "bbox=0,0,1,1&world=forest";
    assert_eq!(seeds(forest), [0, 0]);
    let [one, two] = ["&seed=1", "&seed=2"].map(|seed| seeds(&format!("{forest}{seed}")));
    // Pinned: the seed is part of what a point is.
    assert_eq!(one, [3_490_233_296_317_490, 4_459_607_685_058_723]);
    assert!(one.iter().all(|seed| !two.contains(seed)));
}

#[test]
fn names_that_are_not_there_are_refused_with_those_that_are() {
    let worlds = loaded("[forest]\nspacing = 2").expect("valid");
    let draft = Draft::of(parse_pairs("bbox=0,0,1,1&world=forrest", groups::POINTS));
    let error = draft.filled(&worlds.worlds).expect_err("unknown");
    let fault = &error.faults()[0];
    assert_eq!(
        (fault.field.as_str(), fault.allowed.as_str()),
        ("world", "forest")
    );
    assert_eq!(fault.detail, "unknown world; did you mean `forest`?");
}

#[test]
fn a_digest_follows_the_document_and_what_it_is_made_of() {
    let digest = |text: &str| {
        let catalog = loaded(text).expect("valid");
        catalog.worlds.get("a").expect("there").digest.clone()
    };
    let one = digest("[a]\nspacing = 2");
    assert_eq!(digest("[a]\nspacing = 2\n[b]\nspacing = 3"), one);
    assert_ne!(digest("[a]\nspacing = 3"), one);
    assert_ne!(digest("[a]\nspacing = 2\nprofile = 'step'"), one);
    let catalog = loaded("[a]\nspacing = 2").expect("valid");
    let address = format!("bbox=0,0,1,1&world=a&world_digest={one}");
    let check = |address: &str| {
        let draft = Draft::of(parse_pairs(address, groups::POINTS));
        draft
            .check(&catalog, 100)
            .map(|(query, _)| query.is_pinned())
    };
    assert_eq!(check(&address), Ok(true));
    assert_eq!(check(&format!("{address}&profile=step")), Ok(false));
    assert_eq!(check("bbox=0,0,1,1&world=a"), Ok(false));
    let other = address.replace(&one, &"0".repeat(64));
    assert!(matches!(check(&other), Err(Error::OtherWorld { .. })));
}

#[test]
fn broken_worlds_are_refused_at_the_start() {
    for (text, expected) in [
        (
            "[forest]\nspacin = 2",
            "`worlds.forest.spacin` = `2`: unknown member",
        ),
        ("[forest]\nspacing = -2", "`worlds.forest.spacing` = `-2"),
        (
            "[[forest.layers]]\nname = 'oak'\nspacing = -2",
            "`worlds.forest.layers.oak.spacing` = `-2",
        ),
        (
            "[[forest.layers]]\nname = 'oak'\nspacing = 2\nclear_of = { elm = 1 }",
            "`worlds.forest.layers.oak.clear_of` = `elm: 1.0`: no earlier layer has this name",
        ),
        (
            "[forest]\nregion = { bbox = [0, 0, 1, 1] }",
            "`worlds.forest.region`",
        ),
        ("[forest]\nworld = 'a'", "`worlds.forest.world`"),
        (
            "[forest]\ncount = 300",
            "`worlds.forest.count` = `300`: not allowed in a world",
        ),
        ("[forest]\noffset = 3", "`worlds.forest.offset` = `3`"),
        (
            "[[forest.layers]]\nname = 'oak'\ncount = 300",
            "`worlds.forest.layers.oak.count` = `300`: not allowed in a world",
        ),
        (
            "[forest]\nprofile = 'plaid'",
            "`worlds.forest.profile` = `plaid`",
        ),
        ("['a b']\nspacing = 1", "`a b` is no name"),
    ] {
        let error = loaded(text).expect_err(text).to_string();
        let (place, error) = error.split_once("configuration: ").expect(text);
        assert!(place.starts_with("[worlds."), "{place}");
        assert!(error.starts_with(expected), "{error}");
    }
}

#[test]
fn checked_layers_are_those_of_a_new_check() {
    let assets = loaded(FOREST).expect("valid");
    let check = |address: &str| {
        let draft = Draft::of(parse_pairs(address, groups::POINTS));
        draft.check(&assets, 100)
    };
    let is_kept = |address: &str| {
        let (query, _) = check(address).expect("valid");
        let world = assets.worlds.get("forest").expect("loaded");
        let kept = world.sets.as_ref().expect("layers");
        (query.sets.as_ptr() == kept.as_ptr(), query)
    };
    let whole = "bbox=3,4,9,9&world=forest";
    let (kept, query) = is_kept(whole);
    assert!(kept);
    // The same as the whole body, checked by itself.
    let filled = Draft::of(parse_pairs(whole, groups::POINTS));
    let (filled, world) = filled.filled(&assets.worlds).expect("known");
    let (mut alone, _) = filled.check(&assets, 100).expect("valid");
    assert!(alone.sets.as_ptr() != query.sets.as_ptr());
    alone.world = world;
    assert_eq!(query, alone);
    // The window, the layer and the form of the answer are the query's own.
    for own in ["limit=5", "only=rocks", "format=csv", "offset=2"] {
        let (kept, query) = is_kept(&format!("{whole}&{own}"));
        assert!(kept, "{own}");
        let (other, _) = check(&format!("{whole}&{own}")).expect("valid");
        assert_eq!(query, other);
    }
    for own in ["seed=5", "lod=0.5"] {
        let (kept, query) = is_kept(&format!("{whole}&{own}"));
        assert!(!kept, "{own}");
        assert!(query.sets != alone.sets, "{own}");
    }
    assert!(check(&format!("{whole}&spacing=2")).is_err());
    // Faults are still found, as is a layer that is not there.
    for wrong in ["seed=red", "only=elm", "limit=-1", "decimals=x"] {
        assert!(check(&format!("{whole}&{wrong}")).is_err(), "{wrong}");
    }
    // A world over other tables has their sets.
    let catalog = Catalog::load(true, None).expect("built in");
    let over = assets.worlds.over(&catalog);
    let sets = |worlds: &Worlds| worlds.get("forest").and_then(|world| world.sets.clone());
    assert_eq!(sets(&over), sets(&assets.worlds));
    assert!(
        sets(&over).map(|sets| sets.as_ptr()) != sets(&assets.worlds).map(|sets| sets.as_ptr())
    );
    // Without layers, the query may have the amount, so nothing is kept.
    assert!(assets.worlds.get("meadow").expect("loaded").sets.is_none());
}
