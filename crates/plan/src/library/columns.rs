//! The points of an answer as columns in memory.

use std::sync::Arc;

use rayon::prelude::*;
use strew_core::{F32, F64};
use strew_encode::{Batch, Coordinates, Kind, Part, Place, Rows, Source, Values};
use strew_error::Error;

use super::work::Work;
use crate::Planned;

#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// The number of coordinates of each point: 2, or 3 in space.
    pub axes: usize,
    /// The origin of the coordinates, if it is not the world's: the corner of a chunk.
    pub origin: Option<Place>,
    /// The stable ids, lattice addresses: `axes` integers for each point, `x:y` or `x:y:z` in text.
    pub ids: Vec<i64>,
    /// The coordinates, `axes` numbers for each point.
    pub at: Vec<f64>,
    /// The layer, if there are layers, then attributes, in the order of the query.
    pub further: Vec<Further>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Further {
    pub name: String,
    pub is_optional: bool,
    pub values: FurtherValues,
}

#[derive(Clone, Debug, PartialEq)]
pub enum FurtherValues {
    /// Numbers; NaN where a layer lacks them.
    Numbers(Vec<f64>),
    /// Names out of a list: indices into it, −1 where a layer lacks them.
    Names(Arc<[String]>, Vec<i32>),
}

/// Rows that are made at once.
const BATCH: usize = 4096;
/// Values that are written over at once.
const AT_ONCE: usize = 1 << 22;
/// Fewer points than this are made by one thread.
const FEW: usize = 1 << 16;

impl Columns {
    /// The `count` points of a plan.
    pub(super) fn of(planned: &Planned, count: usize, work: &Work) -> Result<Self, Error> {
        let parts = planned.parts()?;
        let (axes, coordinates) = (planned.axes(), coordinates_of(planned));
        let numbers = count.saturating_mul(axes);
        let (mut ids, mut at) = (room::<i64>(numbers, work)?, room::<f64>(numbers, work)?);
        let size = piece(count);
        let pieces = ids.par_chunks_mut(axes * size);
        let pieces = pieces.zip(at.par_chunks_mut(axes * size));
        let pieces = pieces.enumerate().map(|(i, (ids, at))| {
            let mut rows = Rows::new(window(&parts, i * size, at.len() / axes), coordinates);
            fill(&mut rows, ids, at, work)
        });
        let pieces: Vec<Vec<Further>> = work.finished(pieces.collect())?;
        let mut pieces = pieces.into_iter();
        // Columns exist even without points.
        let empty = || columns(&Rows::new(window(&parts, 0, 0), coordinates));
        let mut further = pieces.next().unwrap_or_else(empty);
        for piece in pieces {
            for (column, more) in further.iter_mut().zip(piece) {
                column.values.append(more.values);
            }
        }
        Ok(Self {
            axes,
            origin: coordinates.origin(),
            ids,
            at,
            further,
        })
    }

    pub const fn len(&self) -> usize {
        self.at.len() / self.axes
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.at.is_empty()
    }
}

/// The coordinates of the `count` points of a plan, as many numbers for each as it has axes.
pub(super) fn coordinates(planned: &Planned, count: usize, work: &Work) -> Result<Vec<f64>, Error> {
    let mut at = room::<f64>(count.saturating_mul(planned.axes()), work)?;
    fill_coordinates(planned, &mut at, work)?;
    Ok(at)
}

/// Writes the coordinates of a plan's points to `at`, which has exactly the room for them.
pub(super) fn fill_coordinates(
    planned: &Planned,
    at: &mut [f64],
    work: &Work,
) -> Result<(), Error> {
    let (axes, coordinates) = (planned.axes(), coordinates_of(planned));
    let parts = bare(planned)?;
    let size = piece(at.len() / axes);
    let pieces = at.par_chunks_mut(axes * size).enumerate();
    pieces.for_each(|(i, at)| {
        let parts = window(&parts, i * size, at.len() / axes);
        if let ([part], Coordinates::World) = (parts.as_slice(), coordinates)
            && write_world(&*part.plan, at, work)
        {
            return;
        }
        let mut rows = Rows::new(parts, coordinates);
        let mut filled = 0;
        while let Some(batch) = rows.next(BATCH) {
            write_places(&batch, &mut at[filled..]);
            filled += axes * batch.points.len();
            if !work.goes_on(batch.points.len()) {
                return;
            }
        }
    });
    work.finished(())
}

/// Writes coordinates of the world as the kernel makes them. Returns false, without them, for a period.
fn write_world(plan: &dyn Source, at: &mut [f64], work: &Work) -> bool {
    if let Some(plan) = plan.plane() {
        let mut blocks = plan.blocks::<F64>();
        fill_by_batches(at.as_chunks_mut().0, work, |at| blocks.fill(at));
    } else if let Some(plan) = plan.space() {
        let mut blocks = plan.blocks::<F64>();
        fill_by_batches(at.as_chunks_mut().0, work, |at| blocks.fill(at));
    } else {
        return false;
    }
    true
}

fn fill_by_batches<T>(at: &mut [T], work: &Work, mut fill: impl FnMut(&mut [T]) -> usize) {
    for at in at.chunks_mut(BATCH) {
        if !work.goes_on(fill(at)) {
            return;
        }
    }
}

/// Writes the offsets of a plan's points to `at`, which has exactly the room for them. Returns their origin.
pub(super) fn fill_offsets(planned: &Planned, at: &mut [f32]) -> Result<Place, Error> {
    let (axes, parts) = (planned.axes(), bare(planned)?);
    let corner = planned.query.region.corner;
    let origin = corner.unwrap_or_else(|| Part::corner(&parts));
    let size = piece(at.len() / axes);
    let pieces = at.par_chunks_mut(axes * size).enumerate();
    pieces.for_each(|(i, at)| {
        let parts = window(&parts, i * size, at.len() / axes);
        if let [part] = parts.as_slice()
            && write_offsets(&*part.plan, origin, at)
        {
            return;
        }
        let mut rows = Rows::new(parts, Coordinates::Near(origin));
        let mut filled = 0;
        while let Some(batch) = rows.next(BATCH) {
            write_near(&batch, &mut at[filled..]);
            filled += axes * batch.points.len();
        }
    });
    Ok(origin)
}

/// Writes offsets as the kernel makes them. Returns false, without them, if its origin is another one.
fn write_offsets(plan: &dyn Source, origin: Place, at: &mut [f32]) -> bool {
    match (plan.plane(), plan.space(), origin) {
        (Some(plan), _, Place::Plane(origin)) if plan.origin() == origin => {
            plan.blocks::<F32>().fill(at.as_chunks_mut().0);
        }
        (_, Some(plan), Place::Space(origin)) if plan.origin() == origin => {
            plan.blocks::<F32>().fill(at.as_chunks_mut().0);
        }
        _ => return false,
    }
    true
}

/// The parts of a plan without layers and attributes.
fn bare(planned: &Planned) -> Result<Vec<Part>, Error> {
    let bare = planned.parts()?.into_iter().map(|part| Part {
        attributes: None,
        layer: None,
        ..part
    });
    Ok(bare.collect())
}

const fn coordinates_of(planned: &Planned) -> Coordinates {
    match planned.query.region.corner {
        Some(corner) => Coordinates::Relative(corner),
        None => Coordinates::World,
    }
}

/// Values to be written over, if there is memory for them.
fn room<T: Clone + Default>(count: usize, work: &Work) -> Result<Vec<T>, Error> {
    let mut values = vec![];
    let reserved = values.try_reserve_exact(count);
    reserved.map_err(|_| Error::Internal("there is not enough memory for all points"))?;
    while values.len() < count {
        values.resize(count.min(values.len() + AT_ONCE), T::default());
        work.finished(())?;
    }
    Ok(values)
}

fn piece(count: usize) -> usize {
    count.div_ceil(rayon::current_num_threads()).max(FEW)
}

/// A range of the points of all parts. Every part stays, so that columns are the same.
fn window(parts: &[Part], first: usize, count: usize) -> Vec<Part> {
    let (mut skip, mut room) = (first as u128, count as u128);
    let cut = |part: &Part| {
        let plan = part.plan.window(skip, Some(room));
        skip -= skip.min(part.plan.count());
        room -= plan.count();
        Part {
            plan,
            ..part.clone()
        }
    };
    parts.iter().map(cut).collect()
}

/// The columns of some rows, without values. Heights of points in space are among the coordinates.
fn columns(rows: &Rows) -> Vec<Further> {
    let column = |column: &strew_encode::Column| Further {
        name: column.name.clone(),
        is_optional: column.optional,
        values: match &column.kind {
            Kind::Number => FurtherValues::Numbers(vec![]),
            Kind::Dictionary(names) => FurtherValues::Names(names.clone(), vec![]),
        },
    };
    let schema = rows.schema();
    let heights = usize::from(schema.is_in_space());
    schema.columns()[heights..].iter().map(column).collect()
}

/// Writes all rows; returns the values of their columns.
fn fill(rows: &mut Rows, ids: &mut [i64], at: &mut [f64], work: &Work) -> Vec<Further> {
    let mut further = columns(rows);
    let heights = usize::from(rows.schema().is_in_space());
    let axes = 2 + heights;
    let mut filled = 0;
    while let Some(batch) = rows.next(BATCH) {
        write_ids(&batch, &mut ids[filled..]);
        write_places(&batch, &mut at[filled..]);
        let count = batch.points.len();
        for (column, values) in further.iter_mut().zip(&batch.columns[heights..]) {
            column.values.extend(values, count);
        }
        filled += axes * count;
        if !work.goes_on(count) {
            break;
        }
    }
    further
}

fn write_ids(batch: &Batch<'_>, ids: &mut [i64]) {
    if batch.heights.is_empty() {
        for (own, point) in ids.as_chunks_mut().0.iter_mut().zip(batch.points) {
            *own = [point.id.x, point.id.y];
        }
        return;
    }
    let points = batch.points.iter().zip(batch.heights);
    for (own, (point, height)) in ids.as_chunks_mut().0.iter_mut().zip(points) {
        *own = [point.id.x, point.id.y, height.address];
    }
}

fn write_places(batch: &Batch<'_>, at: &mut [f64]) {
    if batch.heights.is_empty() {
        for (at, point) in at.as_chunks_mut().0.iter_mut().zip(batch.points) {
            *at = [point.x, point.y];
        }
        return;
    }
    let points = batch.points.iter().zip(batch.heights);
    for (at, (point, height)) in at.as_chunks_mut().0.iter_mut().zip(points) {
        *at = [point.x, point.y, height.z];
    }
}

fn write_near(batch: &Batch<'_>, at: &mut [f32]) {
    if batch.heights.is_empty() {
        at[..2 * batch.near.len()].copy_from_slice(batch.near.as_flattened());
        return;
    }
    let places = batch.near.iter().zip(batch.heights);
    for (at, ([x, y], height)) in at.as_chunks_mut().0.iter_mut().zip(places) {
        // Heights beside `f32` coordinates are of that precision.
        *at = [*x, *y, height.z as f32];
    }
}

impl FurtherValues {
    fn extend(&mut self, from: &Values, count: usize) {
        match (self, from) {
            (Self::Numbers(all), Values::Numbers(values)) => all.extend_from_slice(values),
            (Self::Numbers(all), _) => all.resize(all.len() + count, f64::NAN),
            (Self::Names(_, all), Values::Indices(indices)) => {
                let index = |index: &u32| i32::try_from(*index).unwrap_or(-1);
                all.extend(indices.iter().map(index));
            }
            (Self::Names(_, all), _) => all.resize(all.len() + count, -1),
        }
    }

    fn append(&mut self, more: Self) {
        match (self, more) {
            (Self::Numbers(all), Self::Numbers(mut more)) => all.append(&mut more),
            (Self::Names(_, all), Self::Names(_, mut more)) => all.append(&mut more),
            _ => {}
        }
    }
}
