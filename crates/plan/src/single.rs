//! Single points: by id, and near a place.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};
use strew_core::{
    ErrorKind, Neighbor, Point, PointId,
    server::{Stop, Visits},
    space,
};
use strew_encode::{Attributes as _, Column, Height, Kind, Located, Place, Values};
use strew_error::{Error, Fault, number};
use strew_query::{Nearest, parameters};

use crate::{Placed, PlacedPoints, attributes::PointAttributes, resolve, terrain::ANGLE};

/// A point with its attributes.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Found {
    /// Its stable id: the lattice address.
    #[schemars(regex(pattern = "^-?[0-9]+:-?[0-9]+(:-?[0-9]+)?$"))]
    pub id: String,
    /// Its x.
    pub x: f64,
    /// Its y.
    pub y: f64,
    /// Its z, in space.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z: Option<f64>,
    /// Its distance from the given place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// Its block of the neighborhood map, column and row, where a single point of the plane is requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub block: Option<[usize; 2]>,
    /// Its attributes by name.
    #[serde(flatten)]
    pub attributes: Map<String, Value>,
}

pub const MOST_WITHIN: usize = 10_000;

/// Points that were found, with the distances from a place, if there is one.
#[derive(Default)]
struct Spots {
    points: Vec<Point>,
    heights: Vec<Height>,
    distances: Vec<Option<f64>>,
}

impl Spots {
    fn push(&mut self, point: Point, distance: Option<f64>) {
        self.points.push(point);
        self.distances.push(distance);
    }

    fn push_in_space(&mut self, point: space::Point, distance: Option<f64>) {
        let (flat, height) = Located::parted(&point);
        self.push(flat, distance);
        self.heights.push(height);
    }

    /// The largest absolute coordinate.
    fn reach(&self) -> f64 {
        let flat = self.points.iter().flat_map(|point| [point.x, point.y]);
        let all = flat.chain(self.heights.iter().map(|height| height.z));
        all.map(f64::abs).fold(0.0, f64::max)
    }
}

impl Placed {
    pub fn point(&self, id: &str) -> Result<Found, Error> {
        const ID: &str = "two integers joined by a colon, such as -31:52";
        const ID_IN_SPACE: &str = "three integers joined by colons, such as -31:52:7";
        let wrong = |allowed| Fault::new("id", id, "not a point id", allowed);
        let (mut spots, mut block) = (Spots::default(), None);
        let found = match &self.points {
            PlacedPoints::Space(points) => {
                let read: space::PointId = id.parse().map_err(|_| wrong(ID_IN_SPACE))?;
                let found = points.point(read);
                found.map(|member| spots.push_in_space(member.point(), None))
            }
            flat => {
                let read: PointId = id.parse().map_err(|_| wrong(ID))?;
                flat.point(read).map(|member| {
                    block = flat.block(member.id());
                    spots.push(member.point(), None);
                })
            }
        };
        found.ok_or_else(|| Error::NoSuchPoint { id: id.into() })?;
        let found = self.described(&spots, &Visits::new(usize::MAX, Stop::default()))?;
        let found = found.into_iter().next();
        let found = found.ok_or(Error::Internal("a found point is not described"))?;
        Ok(Found { block, ..found })
    }

    /// The nearest points of a place, nearest first: `k` at most and within `radius`, where these
    /// are given; else the nearest one.
    pub fn nearest(&self, nearest: Nearest) -> Result<Vec<Found>, Error> {
        self.nearest_visiting(nearest, &Visits::new(usize::MAX, Stop::default()))
    }

    /// [`nearest`](Self::nearest) that visits a bounded number of points.
    pub fn nearest_visiting(&self, nearest: Nearest, visits: &Visits) -> Result<Vec<Found>, Error> {
        let mut spots = Spots::default();
        let Nearest { k, radius, .. } = nearest;
        let refused = |error| fault(nearest, &error);
        match (&self.points, nearest.at) {
            (PlacedPoints::Plane(points), Place::Plane(at)) => {
                let found = match (k, radius) {
                    (None, Some(radius)) => points.around_visiting(at, radius, MOST_WITHIN, visits),
                    _ => points.nearest_visiting(at, k.unwrap_or(1), radius, visits),
                };
                for Neighbor { member, distance } in found.map_err(refused)? {
                    spots.push(member.point(), Some(distance));
                }
            }
            (PlacedPoints::Space(points), Place::Space(at)) => {
                let found = match (k, radius) {
                    (None, Some(radius)) => points.around_visiting(at, radius, MOST_WITHIN, visits),
                    _ => points.nearest_visiting(at, k.unwrap_or(1), radius, visits),
                };
                for Neighbor { member, distance } in found.map_err(refused)? {
                    spots.push_in_space(member.point(), Some(distance));
                }
            }
            _ => return Err(Error::Internal("neighbors of a period were not refused")),
        }
        self.described(&spots, visits)
    }

    fn described(&self, spots: &Spots, visits: &Visits) -> Result<Vec<Found>, Error> {
        resolve::check_reach(&self.set, spots.reach())?;
        let attributes = PointAttributes::new(&self.set.attributes, self.attributes.clone());
        let columns = attributes.columns();
        let mut values: Vec<Values> = columns.iter().map(|c| Values::of(&c.kind)).collect();
        let located = Located {
            points: &spots.points,
            heights: &spots.heights,
        };
        attributes.fill(located, &mut values);
        let angle = columns.iter().position(|column| column.name == ANGLE);
        let found = spots.points.iter().enumerate().map(|(i, point)| {
            if visits.is_stopped() {
                return Err(Error::Internal(
                    "a search was stopped before its request ended",
                ));
            }
            let height = spots.heights.get(i);
            let own = columns.iter().zip(&values);
            let own = own.map(|(column, values)| (column.name.clone(), value(column, values, i)));
            let ground = self.ground.iter().flat_map(|ground| {
                let angle = angle.and_then(|column| values[column].number(i));
                let values = ground.values([point.x, point.y], angle.unwrap_or(0.0));
                ground.names().map(Into::into).zip(values.map(Into::into))
            });
            Ok(Found {
                id: strew_encode::id_text(point.id, height),
                x: point.x,
                y: point.y,
                z: height.map(|height| height.z),
                distance: spots.distances[i],
                block: None,
                attributes: own.chain(ground).collect(),
            })
        });
        found.collect()
    }
}

fn value(column: &Column, values: &Values, row: usize) -> Value {
    match &column.kind {
        Kind::Number => values.number(row).unwrap_or_default().into(),
        Kind::Dictionary(names) => {
            let name = values
                .index(row)
                .and_then(|index| names.get(index as usize));
            name.map(String::as_str).into()
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
            let coordinates = at.as_slice().iter().copied().map(number);
            let value = coordinates.collect::<Vec<_>>().join(",");
            let allowed = "a place near enough to the origin for points to be distinct";
            Fault::new("at", value, error.to_string(), allowed)
        }
    };
    fault.into()
}
