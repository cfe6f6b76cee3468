//! Single points: by id, and near a place.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};
use strew_core::{
    Attribute, ErrorKind, Member, Neighbor, PointId,
    server::{self, Stop, Visits},
};
use strew_error::{Error, Fault, number};
use strew_query::{Nearest, parameters};

use crate::{Placed, PlacedPoints, resolve, terrain::ANGLE};

/// A point with its attributes.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Found {
    /// Its stable id: the lattice address.
    #[schemars(regex(pattern = "^-?[0-9]+:-?[0-9]+$"))]
    pub id: String,
    /// Its x.
    pub x: f64,
    /// Its y.
    pub y: f64,
    /// Its distance from the given place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// Its block of the neighborhood map, column and row, where a single point is requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub block: Option<[usize; 2]>,
    /// Its attributes by name.
    #[serde(flatten)]
    pub attributes: Map<String, Value>,
}

/// The most points within a radius.
pub const MOST_WITHIN: usize = 10_000;

impl Placed {
    /// The point of an id.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a text that is no id, [`Error::NoSuchPoint`] if the set has no point
    /// there.
    pub fn point(&self, id: &str) -> Result<Found, Error> {
        const ID: &str = "two integers joined by a colon, such as -31:52";
        let read = id
            .parse::<PointId>()
            .map_err(|_| Fault::new("id", id, "not a point id", ID))?;
        let member = self.points.point(read);
        let member = member.ok_or_else(|| Error::NoSuchPoint { id: id.into() })?;
        self.check_reach([&member])?;
        let mut found = self.found(&member, None);
        found.block = self.points.block(member.id());
        Ok(found)
    }

    /// The nearest points of a place, nearest first: `k` at most and within `radius`, where these
    /// are given; else the nearest one.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a place too far out or too many points.
    pub fn nearest(&self, nearest: Nearest) -> Result<Vec<Found>, Error> {
        self.nearest_visiting(nearest, &Visits::new(usize::MAX, Stop::default()))
    }

    /// [`nearest`](Self::nearest) that visits a bounded number of points.
    ///
    /// # Errors
    /// As `nearest`, also for more points than may be visited.
    pub fn nearest_visiting(&self, nearest: Nearest, visits: &Visits) -> Result<Vec<Found>, Error> {
        let Nearest { at, k, radius } = nearest;
        let PlacedPoints::Plane(points) = &self.points else {
            return Err(Error::Internal("neighbors of a period were not refused"));
        };
        let found = match (k, radius) {
            (None, Some(radius)) => server::around(points, at, radius, MOST_WITHIN, visits),
            (k, radius) => server::nearest(points, at, k.unwrap_or(1), radius, visits),
        };
        let found = found.map_err(|error| fault(nearest, &error))?;
        self.check_reach(found.iter().map(|neighbor| &neighbor.member))?;
        let found = found.iter().map(|Neighbor { member, distance }| {
            if visits.is_stopped() {
                return Err(Error::Internal(
                    "a search was stopped before its request ended",
                ));
            }
            Ok(self.found(member, Some(*distance)))
        });
        found.collect()
    }

    /// Refuses a least distance that the coordinates of some points do not keep.
    fn check_reach<'a>(&self, members: impl IntoIterator<Item = &'a Member>) -> Result<(), Error> {
        let coordinates = members.into_iter().flat_map(|member| member.at());
        let reach = coordinates.map(f64::abs).fold(0.0, f64::max);
        resolve::check_reach(&self.set, reach)
    }

    fn found(&self, member: &Member, distance: Option<f64>) -> Found {
        let point = member.point();
        let list = self.set.attributes.as_slice();
        let value = |(i, attribute): (usize, &Attribute)| {
            let number = self.attributes.value(i, point.id).unwrap_or_default();
            let value = match attribute.variants() {
                Some(variants) => variants.name(number as u32).into(),
                None => number.into(),
            };
            (attribute.name().to_owned(), value)
        };
        let attributes = list.iter().enumerate().map(value);
        let ground = self.ground.iter().flat_map(|ground| {
            let angle = list.iter().position(|attribute| attribute.name() == ANGLE);
            let angle = angle.and_then(|i| self.attributes.value(i, point.id));
            let values = ground.values([point.x, point.y], angle.unwrap_or(0.0));
            ground.names().map(Into::into).zip(values.map(Into::into))
        });
        Found {
            id: point.id.to_string(),
            x: point.x,
            y: point.y,
            distance,
            block: None,
            attributes: attributes.chain(ground).collect(),
        }
    }
}

fn fault(nearest: Nearest, error: &strew_core::Error) -> Error {
    let Nearest { at, k, radius } = nearest;
    let k = k.unwrap_or(1);
    let fault = match (error.kind(), radius) {
        (ErrorKind::Radius, Some(radius)) => {
            let allowed = parameters::RADIUS.allowed();
            Fault::new("radius", number(radius), error.to_string(), allowed)
        }
        (ErrorKind::Neighbors, _) => Fault::new("k", k, error.to_string(), parameters::K.allowed()),
        (ErrorKind::TooMany, Some(radius)) if nearest.k.is_none() => {
            let allowed = format!("a radius with at most {MOST_WITHIN} points within");
            Fault::new("radius", number(radius), error.problem(), allowed)
        }
        (ErrorKind::TooMany, _) => Fault::new(
            "k",
            k,
            error.to_string(),
            "fewer neighbors, a larger share to keep, or a place nearer to where the field leaves points",
        ),
        _ => {
            let value = format!("{},{}", number(at[0]), number(at[1]));
            let allowed = "a place near enough to the origin for points to be distinct";
            Fault::new("at", value, error.to_string(), allowed)
        }
    };
    fault.into()
}
