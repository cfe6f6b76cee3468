//! Checking a query, whose missing members come from the world that it names.

use std::borrow::Cow;

use strew_catalog::field::Allowance;
use strew_error::{Error, Fault, Faults, unknown};

use crate::{
    Options,
    assets::Assets,
    draft::Draft,
    field::Loaded,
    parameter::{Group, Parameter},
    parameters::{EXCEPT, FIELD, ONLY, PERIODIC, TERRAIN, WORLD, WORLD_DIGEST},
    query::{Named, Query},
    table,
    world::Worlds,
};

impl Draft {
    /// Checks everything against what is loaded; `most_vertices` bounds the polygons of all regions.
    pub fn check(&self, assets: &Assets, most_vertices: usize) -> Result<(Query, Options), Error> {
        self.check_within(assets, most_vertices, Allowance::UNLIMITED)
    }

    /// As [`check`](Self::check), with no more than is allowed.
    pub fn check_within(
        &self,
        assets: &Assets,
        most_vertices: usize,
        allowance: Allowance<'_>,
    ) -> Result<(Query, Options), Error> {
        let (draft, world) = self.filled(&assets.worlds)?;
        let named = world.as_ref().filter(|_| self.leaves_sets());
        let named = named.and_then(|world| assets.worlds.get(&world.name));
        let known = named.and_then(|world| world.sets.clone());
        let loaded = Loaded::new(&assets.catalog, allowance);
        let (mut query, options) = draft.check_whole(&loaded, most_vertices, known)?;
        query.world = world;
        Ok((query, options))
    }

    /// The draft, completed from the world that it names, and that world.
    pub fn filled(&self, worlds: &Worlds) -> Result<(Cow<'_, Self>, Option<Named>), Error> {
        let Ok(named) = self.values.get::<String>(&WORLD) else {
            // A name that could not be read is a fault of the draft.
            return Ok((Cow::Borrowed(self), None));
        };
        let pin = table::digest(&self.values, &WORLD_DIGEST)?;
        let Some(name) = named else {
            return match pin {
                Some(_) => {
                    let detail = "has no effect without world";
                    Err(self.values.fault(&WORLD_DIGEST, detail).into())
                }
                None => Ok((Cow::Borrowed(self), None)),
            };
        };
        let Some(world) = worlds.get(&name) else {
            return Err(self.no_world(worlds).into());
        };
        if let Some(pinned) = pin.as_ref().filter(|pin| **pin != world.digest) {
            return Err(Error::OtherWorld {
                name,
                pinned: pinned.clone(),
                loaded: world.digest.clone(),
            });
        }
        let whole = &world.draft;
        let has_periods = self.values.takes().any(|known| *known == PERIODIC);
        if whole.values.has(&PERIODIC) && !has_periods {
            let detail = "the world is a period, which has neither chunks nor neighbors";
            return Err(Fault::new(WORLD.name, &name, detail, "a world without periodic").into());
        }
        let used = Named {
            is_pinned: pin.is_some() && self.adds_nothing(),
            digest: world.digest.clone(),
            name,
        };
        let mut draft = self.clone();
        draft.fill_from(whole);
        Ok((Cow::Owned(draft), Some(used)))
    }

    fn no_world(&self, worlds: &Worlds) -> Faults {
        let name = self.values.text(&WORLD);
        let names = worlds.iter().map(|world| world.name.as_str());
        let fault = Fault {
            allowed: worlds.names(),
            ..self.values.fault(&WORLD, unknown("world", &name, names))
        };
        fault.into()
    }

    /// Whether all that a server could change comes from the world.
    fn adds_nothing(&self) -> bool {
        let own = [
            Group::Profile,
            Group::Table,
            Group::Attributes,
            Group::Choices,
        ];
        let is_own = |(parameter, _): (&'static _, &_)| {
            let parameter: &Parameter = parameter;
            [&FIELD, &TERRAIN, &EXCEPT].contains(&parameter)
                || own.contains(&parameter.group) && *parameter != ONLY
        };
        matches!(&self.layers, Ok(layers) if layers.is_empty()) && !self.values.given().any(is_own)
    }
}
