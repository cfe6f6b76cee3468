//! Neighborhood maps of any half-width: blocks, refinement, neighbors, growth.

use crate::access::Caller;
use schemars::JsonSchema;
use serde::Serialize;
use strew_core::{Alpha, Map, server::Stop};
use strew_error::{Error, Fault, Together as _};
use strew_plan::Lane;
use strew_query::{
    Values,
    patterns::{BLOCK, MOST_RADIUS, RADIUS, REFINED},
};

use super::{TURN, alpha, refused};
use crate::Service;

/// The half-width of a map that names none.
pub(super) const DEFAULT_RADIUS: u32 = 20;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapQuery {
    pub alpha: Alpha,
    pub radius: u32,
    pub refined: Option<u32>,
    pub block: Option<[usize; 2]>,
}

/// A neighborhood map. Points whose index is in one block have the same neighbors up to its half-width.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "NeighborhoodMap")]
pub struct MapDocument {
    /// The number α.
    pub alpha: String,
    /// The side t of the set region.
    pub side: f64,
    /// The half-width R, in grid units.
    pub radius: u32,
    /// The number n of intervals per axis; the map has n × n blocks.
    pub intervals: usize,
    /// Where the intervals begin, from 0, in turns of the index torus; the last one ends at the side.
    pub starts: Vec<f64>,
    /// The number of intervals of the maps of half-width 0, 1, … R. At a fraction whose denominator is no power
    /// of two it does not have the few intervals that only the rounding of α makes.
    pub interval_counts: Vec<usize>,
    /// The finer map, if one is wanted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refined: Option<Refinement>,
    /// The neighbors of a block, if they are wanted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub neighbors: Option<Neighborhood>,
}

/// A finer map.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Refinement {
    /// Its half-width.
    pub radius: u32,
    /// Its number of intervals per axis.
    pub intervals: usize,
    /// Where its intervals begin.
    pub starts: Vec<f64>,
    /// For each of its intervals the one of the coarser map that holds it.
    pub parents: Vec<usize>,
}

/// The neighbors of all points of a block.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Neighborhood {
    /// The block: its intervals of dX and dY.
    pub block: [usize; 2],
    /// The offsets up to the half-width at which there is a point, 0,0 included, row by row.
    pub offsets: Vec<(i64, i64)>,
}

impl MapQuery {
    pub fn check(values: &Values) -> Result<Self, Error> {
        let parts = (
            values.read(),
            alpha(values),
            values.get::<u64>(&RADIUS),
            values.get::<u64>(&REFINED),
            values.get::<[f64; 2]>(&BLOCK),
        );
        let ((), alpha, radius, refined, block) = parts.together()?;
        // Their shapes bound them.
        let small = |radius: u64| u32::try_from(radius).unwrap_or(MOST_RADIUS);
        let radius = radius.map_or(DEFAULT_RADIUS, small);
        let refined = refined.map(small);
        if refined.is_some_and(|refined| refined < radius) {
            let detail = format!("below radius, which is {radius}");
            return Err(values.fault(&REFINED, detail).into());
        }
        let intervals = Map::new(alpha, radius).map_err(|error| refused(&error))?;
        let intervals = intervals.intervals();
        let is_inside =
            |block: &[f64; 2]| block.iter().all(|i| (0.0..intervals as f64).contains(i));
        if let Some(block) = block.filter(|block| !is_inside(block)) {
            let value = format!("{},{}", block[0], block[1]);
            let allowed = format!("two integers column,row from 0 to {}", intervals - 1);
            return Err(Fault::new(BLOCK.name, value, "the map has no such block", allowed).into());
        }
        Ok(Self {
            alpha,
            radius,
            refined,
            block: block.map(|block| block.map(|i| i as usize)),
        })
    }

    pub fn document(&self) -> Result<MapDocument, Error> {
        let made = |error: strew_core::Error| refused(&error);
        let map = Map::new(self.alpha, self.radius).map_err(made)?;
        let starts = |map: &Map| -> Vec<f64> {
            let all = 0..map.intervals();
            all.map(|i| map.interval(i).start as f64 / TURN).collect()
        };
        let finer = |radius: u32| -> Result<Refinement, Error> {
            let (finer, parents) = map.refine(radius).map_err(made)?;
            Ok(Refinement {
                radius,
                intervals: finer.intervals(),
                starts: starts(&finer),
                parents,
            })
        };
        Ok(MapDocument {
            alpha: self.alpha.to_string(),
            side: self.alpha.set_side_f64(),
            radius: self.radius,
            intervals: map.intervals(),
            starts: starts(&map),
            interval_counts: Map::interval_counts(self.alpha, self.radius).map_err(made)?,
            refined: self.refined.map(finer).transpose()?,
            neighbors: self.block.map(|block| Neighborhood {
                block,
                offsets: map.neighbors(block),
            }),
        })
    }

    /// The number of neighbors that a block has, about.
    fn neighbors(&self) -> usize {
        let across = 2.0 * f64::from(self.radius) + 1.0;
        let of_block = (across * self.alpha.set_side_f64() + 2.0).powi(2);
        self.block.map_or(0, |_| of_block as usize)
    }
}

impl Service {
    /// Makes a map, and something of it. Neighbors are charged as points.
    pub async fn map<T: Send + 'static>(
        &self,
        caller: &Caller,
        query: MapQuery,
        answer: impl FnOnce(MapDocument) -> Result<T, Error> + Send + 'static,
    ) -> Result<T, Error> {
        /// The bytes of a neighbor and of the intervals, in memory and as text.
        const NEIGHBOR: usize = 64;
        const INTERVALS: usize = 1 << 19;
        let neighbors = query.neighbors();
        caller.charge(neighbors as u128)?;
        let budget = self.own_budget();
        let make = move |_: &Stop| {
            let _held = budget.hold(INTERVALS + neighbors * NEIGHBOR)?;
            answer(query.document()?)
        };
        self.workers().take_turn(Lane::Long, make).await?
    }
}
