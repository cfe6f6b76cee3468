//! The parts of an answer, and how one is walked: its points, and where each column's values come
//! from.

use std::{fmt, sync::Arc};

use strew_core::{Blocks, F32, Offsets, Point};

use super::{
    coordinates::Coordinates,
    schema::{Column, Kind, Schema, Values},
    shift::Shift,
};
use crate::source::{Source, Walk};

/// A source of further values for the points of a part.
pub trait Attributes: fmt::Debug + Send + Sync {
    /// The columns, each with another name.
    fn columns(&self) -> Vec<Column>;

    /// Appends a value for each point to each of the columns' values. They come empty, one for
    /// each of [`columns`](Self::columns) and of its kind.
    fn fill(&self, points: &[Point], values: &mut [Values]);
}

/// A part of an answer: a plan, with the attributes of its points.
#[derive(Clone, Debug)]
pub struct Part {
    /// The points.
    pub plan: Arc<dyn Source>,
    /// The name of its layer, where there are several.
    pub layer: Option<String>,
    /// The points' further values.
    pub attributes: Option<Arc<dyn Attributes>>,
}

impl Part {
    /// The lower corner of some parts together.
    #[must_use]
    pub fn corner(parts: &[Self]) -> [f64; 2] {
        let corners = parts.iter().map(|part| part.plan.origin());
        let least = corners.reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1])]);
        least.unwrap_or_default()
    }

    pub(super) fn own_columns(&self) -> Vec<Column> {
        let columns = self.attributes.as_ref().map(|own| own.columns());
        columns.unwrap_or_default()
    }
}

/// The part under way.
#[derive(Debug)]
pub(super) struct Current {
    /// The number of the part.
    pub(super) number: usize,
    pub(super) part: Part,
    pub(super) blocks: Box<dyn Walk>,
    near: Option<Blocks<F32>>,
    offsets: Option<(Blocks<Offsets>, Vec<[f64; 2]>)>,
    /// The values of the part's own columns.
    own: Vec<Values>,
    /// Where each column of the schema comes from.
    sources: Vec<Origin>,
}

/// Where a column's values come from.
#[derive(Debug)]
enum Origin {
    /// The column has the layer's values.
    Layer(u32),
    /// The column is one of the part's own, with other indices where its dictionary was joined with others.
    Own(usize, Option<Vec<u32>>),
    /// The part does not have the column.
    Nowhere,
}

impl Current {
    pub(super) fn new(
        number: usize,
        part: Part,
        schema: &Schema,
        coordinates: Coordinates,
    ) -> Self {
        let columns = part.own_columns();
        let layered = usize::from(schema.is_layered());
        let layer = schema.columns().iter().take(layered);
        let layer = layer.map(|_| Origin::Layer(u32::try_from(number).unwrap_or(u32::MAX)));
        let own = schema.columns().iter().skip(layered).map(|column| {
            let same = |own: &Column| own.name == column.name;
            let place = columns.iter().position(same);
            place.map_or(Origin::Nowhere, |place| {
                Origin::own(place, &columns[place].kind, &column.kind)
            })
        });
        let plane = part.plan.plane();
        let is_own = |origin: &[f64; 2]| plane.is_some_and(|plan| *origin == plan.origin());
        let (near, offsets) = match coordinates {
            Coordinates::World => (false, false),
            Coordinates::Relative(origin) => (false, is_own(&origin)),
            Coordinates::Near(origin) => (is_own(&origin), false),
        };
        Self {
            number,
            sources: layer.chain(own).collect(),
            own: columns.iter().map(|c| Values::of(&c.kind)).collect(),
            blocks: part.plan.walk(),
            near: plane.filter(|_| near).map(|plan| plan.blocks()),
            offsets: plane
                .filter(|_| offsets)
                .map(|plan| (plan.blocks(), vec![])),
            part,
        }
    }

    pub(super) fn fill_columns(&mut self, points: &[Point], columns: &mut [Values]) {
        if let Some(attributes) = &self.part.attributes {
            self.own.iter_mut().for_each(Values::clear);
            attributes.fill(points, &mut self.own);
        }
        for (column, source) in columns.iter_mut().zip(&self.sources) {
            match source {
                Origin::Layer(layer) => *column = Values::Indices(vec![*layer; points.len()]),
                Origin::Own(place, None) => std::mem::swap(column, &mut self.own[*place]),
                Origin::Own(place, Some(map)) => {
                    if let Values::Indices(own) = &self.own[*place] {
                        let mapped = own.iter().map(|i| map.get(*i as usize).copied());
                        *column = Values::Indices(mapped.map(Option::unwrap_or_default).collect());
                    }
                }
                Origin::Nowhere => *column = Values::Missing,
            }
        }
    }

    /// Makes the coordinates of the next points relative to `origin`.
    pub(super) fn move_to(&mut self, origin: [f64; 2], points: &mut [Point]) {
        match &mut self.offsets {
            Some((blocks, offsets)) => {
                offsets.resize(points.len().max(offsets.len()), [0.0; 2]);
                blocks.fill(&mut offsets[..points.len()]);
                for (point, offset) in points.iter_mut().zip(offsets) {
                    [point.x, point.y] = *offset;
                }
            }
            None => {
                let shift = Shift::new(&*self.part.plan, origin);
                for point in points {
                    [point.x, point.y] = shift.apply(point);
                }
            }
        }
    }

    pub(super) fn fill_near(&mut self, points: &[Point], origin: [f64; 2], near: &mut [[f32; 2]]) {
        match &mut self.near {
            Some(blocks) => {
                blocks.fill(near);
            }
            None => {
                let shift = Shift::new(&*self.part.plan, origin);
                for (near, point) in near.iter_mut().zip(points) {
                    *near = shift.near(point);
                }
            }
        }
    }
}

impl Origin {
    fn own(place: usize, own: &Kind, joined: &Kind) -> Self {
        match (own, joined) {
            (Kind::Number, Kind::Number) => Self::Own(place, None),
            (Kind::Dictionary(own), Kind::Dictionary(joined)) if joined.starts_with(own) => {
                Self::Own(place, None)
            }
            (Kind::Dictionary(own), Kind::Dictionary(joined)) => {
                let index = |name| joined.iter().position(|joined| joined == name);
                let index = |name| u32::try_from(index(name).unwrap_or_default());
                let map = own.iter().map(|name| index(name).unwrap_or_default());
                Self::Own(place, Some(map.collect()))
            }
            _ => Self::Nowhere,
        }
    }
}
