//! Clusters of pattern points: their shapes and how often each occurs.

use crate::access::Caller;
use schemars::JsonSchema;
use serde::Serialize;
use strew_core::{
    Alpha, ErrorKind,
    map::{Clusters, Shape},
    server::Stop,
};
use strew_error::{Error, Together as _};
use strew_plan::Lane;
use strew_query::{
    Values,
    patterns::{DISTANCE, MOST, UP_TO},
};

use super::{alpha, refused};
use crate::Service;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClustersQuery {
    pub alpha: Alpha,
    pub distance: f64,
    pub most: usize,
    /// Whether shapes that are symmetric to each other are one.
    pub up_to_symmetry: bool,
}

/// The clusters of a pattern.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "Clusters")]
pub struct ClustersDocument {
    /// The number α.
    pub alpha: String,
    /// The largest distance of neighbors, in grid units.
    pub distance: f64,
    /// The number of points up to which clusters were searched.
    pub most: usize,
    /// The half-width of the map that distinguishes the shapes, in grid units.
    pub radius: u32,
    /// The intervals per axis of this map.
    pub intervals: usize,
    /// The number of shapes up to the symmetries of the square.
    pub classes: usize,
    /// The shapes, by the number of points and then by density, densest first.
    pub shapes: Vec<ShapeDocument>,
    /// The share of the pattern's points in clusters of more than `most` points.
    pub larger_share: f64,
}

/// A shape of clusters.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "Shape")]
pub struct ShapeDocument {
    /// The column and row of each point from the first, row by row.
    pub points: Vec<(i64, i64)>,
    /// The number of the shape's class under the symmetries of the square, from 0.
    pub class: usize,
    /// Clusters of this shape for each grid point.
    pub density: f64,
    /// The share of the pattern's points in clusters of this shape.
    pub share_of_points: f64,
    /// The number of its images under these symmetries that differ, if they count as one shape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub images: Option<usize>,
}

impl ClustersQuery {
    pub fn check(values: &Values) -> Result<Self, Error> {
        let parts = (
            values.read(),
            alpha(values),
            values.get::<f64>(&DISTANCE),
            values.get::<u64>(&MOST),
            values.get::<String>(&UP_TO),
        );
        let ((), alpha, distance, most, up_to) = parts.together()?;
        Ok(Self {
            alpha,
            distance: distance.unwrap_or(2.24),
            // The shape bounds it.
            most: most.map_or(Clusters::MAX_POINTS, |most| {
                usize::try_from(most).unwrap_or(usize::MAX)
            }),
            up_to_symmetry: up_to.as_deref() == Some("symmetry"),
        })
    }

    pub(super) fn points(&self) -> u128 {
        // The intervals of a map that sees clusters as wide as this.
        let reach = self.distance * (1.0 + (self.most as f64).sqrt());
        let intervals = 4.0 * self.alpha.set_side_f64() * (reach + 1.0);
        (intervals * intervals * self.most as f64).ceil() as u128
    }

    /// Searches, unless the flag is raised.
    pub fn search(&self, stop: &Stop) -> Result<Clusters, Error> {
        let found = Clusters::until(self.alpha, self.distance, self.most, stop);
        found.map_err(|error| match error.kind() {
            ErrorKind::Clusters => {
                let allowed = format!("{}, or a smaller distance", error.allowed());
                let detail = "clusters of this distance and number of points reach too far";
                strew_error::Fault::new(error.field(), error.value(), detail, allowed).into()
            }
            _ => refused(&error),
        })
    }

    pub fn document(&self, found: &Clusters) -> ClustersDocument {
        let one = |shape: &Shape| ShapeDocument {
            points: shape.points().to_vec(),
            class: shape.class(),
            density: shape.density(),
            share_of_points: shape.share_of_points(),
            images: None,
        };
        let merged = |class: &[Shape]| ShapeDocument {
            density: class.iter().map(Shape::density).sum(),
            share_of_points: class.iter().map(Shape::share_of_points).sum(),
            images: Some(class.len()),
            ..one(&class[0])
        };
        let shapes = match self.up_to_symmetry {
            false => found.shapes().iter().map(one).collect(),
            true => {
                let classes = found.shapes().chunk_by(|a, b| a.class() == b.class());
                classes.map(merged).collect()
            }
        };
        ClustersDocument {
            alpha: self.alpha.to_string(),
            distance: self.distance,
            most: self.most,
            radius: found.map().radius(),
            intervals: found.map().intervals(),
            classes: found.classes(),
            shapes,
            larger_share: found.larger_share(),
        }
    }
}

impl Service {
    /// Searches for the clusters of a pattern, charged, and makes something of them where they are found. The
    /// search stops when its client leaves or its time is over.
    pub async fn clusters<T: Send + 'static>(
        &self,
        caller: &Caller,
        query: ClustersQuery,
        answer: impl FnOnce(&Clusters) -> Result<T, Error> + Send + 'static,
    ) -> Result<T, Error> {
        /// The bytes of a shape's point, in memory and as text.
        const POINT: usize = 96;
        caller.charge(query.points())?;
        let budget = self.own_budget();
        let search = move |stop: &Stop| {
            let found = query.search(stop)?;
            let points = found.shapes().iter().map(|shape| shape.points().len());
            let _held = budget.hold(points.sum::<usize>().saturating_mul(POINT))?;
            answer(&found)
        };
        self.workers().take_turn(Lane::Long, search).await?
    }
}
