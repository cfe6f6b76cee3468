//! The parts of an answer, and how one is walked: its points, and where each column's values come
//! from.

use std::{fmt, sync::Arc};

use strew_core::{Blocks, F32, Offsets, Point, space};

use super::{
    place::{Coordinates, Height, Located, Place},
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
    fn fill(&self, places: Located<'_>, values: &mut [Values]);
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
    pub fn corner(parts: &[Self]) -> Place {
        let corners = parts.iter().map(|part| origin(&*part.plan));
        corners
            .reduce(Place::least)
            .unwrap_or(Place::Plane([0.0; 2]))
    }

    /// The bounds of the heights of some parts in space.
    pub(super) fn heights(parts: &[Self]) -> Option<[f64; 2]> {
        let all = parts.iter().filter_map(|part| part.plan.heights());
        all.reduce(|[low, high], [a, b]| [low.min(a), high.max(b)])
    }

    pub(super) fn own_columns(&self) -> Vec<Column> {
        let columns = self.attributes.as_ref().map(|own| own.columns());
        columns.unwrap_or_default()
    }
}

/// The lower corner of a box around the points of a source.
fn origin(plan: &dyn Source) -> Place {
    let [x, y] = plan.origin();
    match plan.heights() {
        Some([z, _]) => Place::Space([x, y, z]),
        None => Place::Plane([x, y]),
    }
}

/// The part under way.
#[derive(Debug)]
pub(super) struct Current {
    /// The number of the part.
    pub(super) number: usize,
    pub(super) part: Part,
    pub(super) blocks: Box<dyn Walk>,
    near: Option<Near>,
    offsets: Option<Exact>,
    /// The values of the part's own columns.
    own: Vec<Values>,
    /// Where each column of the schema comes from.
    sources: Vec<Provider>,
}

/// The coordinates of a part as exact offsets, rounded once.
#[derive(Debug)]
enum Exact {
    Plane(Blocks<Offsets>, Vec<[f64; 2]>),
    Space(space::Blocks<Offsets>, Vec<[f64; 3]>),
}

/// The coordinates of a part as the kernel makes them for `f32`.
#[derive(Debug)]
enum Near {
    Plane(Blocks<F32>),
    Space(space::Blocks<F32>, Vec<[f32; 3]>),
}

/// Where a column's values come from.
#[derive(Debug)]
enum Provider {
    /// The column has the heights of points in space.
    Height,
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
        let height = schema.is_in_space().then_some(Provider::Height);
        let layer = schema.layer();
        let layer = layer.map(|_| Provider::Layer(u32::try_from(number).unwrap_or(u32::MAX)));
        let own = schema.own().iter().map(|column| {
            let same = |own: &Column| own.name == column.name;
            let place = columns.iter().position(same);
            place.map_or(Provider::Nowhere, |place| {
                Provider::own(place, &columns[place].kind, &column.kind)
            })
        });
        let is_own = |wanted: Place| wanted == origin(&*part.plan);
        let (near, offsets) = match coordinates {
            Coordinates::World => (None, None),
            Coordinates::Relative(origin) if is_own(origin) => (None, Exact::of(&*part.plan)),
            Coordinates::Near(origin) if is_own(origin) => (Near::of(&*part.plan), None),
            Coordinates::Relative(_) | Coordinates::Near(_) => (None, None),
        };
        Self {
            number,
            sources: height.into_iter().chain(layer).chain(own).collect(),
            own: columns.iter().map(|c| Values::of(&c.kind)).collect(),
            blocks: part.plan.walk(),
            near,
            offsets,
            part,
        }
    }

    /// Makes the values of the part's own columns, which depend on the coordinates of the world.
    pub(super) fn fill_attributes(&mut self, places: Located<'_>) {
        if let Some(attributes) = &self.part.attributes {
            self.own.iter_mut().for_each(Values::clear);
            attributes.fill(places, &mut self.own);
        }
    }

    /// Fills in the values of all columns. The heights are those of the answer.
    pub(super) fn fill_columns(&mut self, places: Located<'_>, columns: &mut [Values]) {
        for (column, source) in columns.iter_mut().zip(&self.sources) {
            match source {
                Provider::Height => {
                    let heights = places.heights.iter().map(|height| height.z);
                    match column {
                        Values::Numbers(numbers) => {
                            numbers.clear();
                            numbers.extend(heights);
                        }
                        _ => *column = Values::Numbers(heights.collect()),
                    }
                }
                Provider::Layer(layer) => {
                    *column = Values::Indices(vec![*layer; places.points.len()]);
                }
                Provider::Own(place, None) => std::mem::swap(column, &mut self.own[*place]),
                Provider::Own(place, Some(map)) => {
                    if let Values::Indices(own) = &self.own[*place] {
                        let mapped = own.iter().map(|i| map.get(*i as usize).copied());
                        *column = Values::Indices(mapped.map(Option::unwrap_or_default).collect());
                    }
                }
                Provider::Nowhere => *column = Values::Missing,
            }
        }
    }

    /// Makes the coordinates of the next points relative to `origin`.
    pub(super) fn move_to(&mut self, origin: Place, points: &mut [Point], heights: &mut [Height]) {
        match &mut self.offsets {
            Some(Exact::Plane(blocks, offsets)) => {
                offsets.resize(points.len().max(offsets.len()), [0.0; 2]);
                blocks.fill(&mut offsets[..points.len()]);
                for (point, offset) in points.iter_mut().zip(offsets) {
                    [point.x, point.y] = *offset;
                }
            }
            Some(Exact::Space(blocks, offsets)) => {
                offsets.resize(points.len().max(offsets.len()), [0.0; 3]);
                blocks.fill(&mut offsets[..points.len()]);
                for ((point, height), offset) in points.iter_mut().zip(heights).zip(offsets) {
                    [point.x, point.y, height.z] = *offset;
                }
            }
            None => {
                let shift = Shift::new(&*self.part.plan, origin);
                for point in points {
                    [point.x, point.y] = shift.apply(point);
                }
                for height in heights {
                    height.z = shift.height(height.z);
                }
            }
        }
    }

    /// Fills in the coordinates of the next points as `f32` relative to `origin`, and makes their heights relative.
    pub(super) fn fill_near(
        &mut self,
        points: &[Point],
        heights: &mut [Height],
        origin: Place,
        near: &mut [[f32; 2]],
    ) {
        match &mut self.near {
            Some(Near::Plane(blocks)) => {
                blocks.fill(near);
            }
            Some(Near::Space(blocks, places)) => {
                places.resize(points.len().max(places.len()), [0.0; 3]);
                blocks.fill(&mut places[..points.len()]);
                for ((near, height), [x, y, z]) in near.iter_mut().zip(heights).zip(places) {
                    *near = [*x, *y];
                    height.z = f64::from(*z);
                }
            }
            None => {
                let shift = Shift::new(&*self.part.plan, origin);
                for (near, point) in near.iter_mut().zip(points) {
                    *near = shift.near(point);
                }
                for height in heights {
                    height.z = f64::from(shift.near_height(height.z));
                }
            }
        }
    }
}

impl Exact {
    fn of(plan: &dyn Source) -> Option<Self> {
        let plane = plan.plane().map(|plan| Self::Plane(plan.blocks(), vec![]));
        plane.or_else(|| Some(Self::Space(plan.space()?.blocks(), vec![])))
    }
}

impl Near {
    fn of(plan: &dyn Source) -> Option<Self> {
        let plane = plan.plane().map(|plan| Self::Plane(plan.blocks()));
        plane.or_else(|| {
            let plan = plan.space()?;
            Some(Self::Space(plan.blocks_f32(), vec![]))
        })
    }
}

impl Provider {
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
