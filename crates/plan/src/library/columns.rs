//! The points of an answer as columns in memory.

use std::sync::Arc;

use rayon::prelude::*;
use strew_core::{F32, F64, Point};
use strew_encode::{Coordinates, Encoding, Kind, Output, Part, Place, Rows, Values};
use strew_error::Error;

use crate::Planned;

/// Points as columns of the same length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    /// The origin of the coordinates, if it is not the world's: the corner of a chunk.
    pub origin: Option<[f64; 2]>,
    /// The stable ids: lattice addresses, `x:y` in text.
    pub ids: Vec<[i64; 2]>,
    /// The coordinates.
    pub at: Vec<[f64; 2]>,
    /// The layer, if there are layers, then attributes, in the order of the query.
    pub further: Vec<Further>,
}

/// A column beside ids and coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Further {
    /// Its name.
    pub name: String,
    /// Whether some layer lacks it.
    pub is_optional: bool,
    /// Its values.
    pub values: FurtherValues,
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum FurtherValues {
    /// Numbers; NaN where a layer lacks them.
    Numbers(Vec<f64>),
    /// Names out of a list: indices into it, −1 where a layer lacks them.
    Names(Arc<[String]>, Vec<i32>),
}

/// Rows that are made at once.
const BATCH: usize = 4096;
/// Fewer points than this are made by one thread.
const FEW: usize = 1 << 16;

impl Columns {
    /// The `count` points of a plan.
    pub(super) fn of(planned: &Planned, count: usize) -> Result<Self, Error> {
        let parts = planned.parts()?;
        let coordinates = coordinates_of(planned);
        let (mut ids, mut at) = (room::<[i64; 2]>(count)?, room::<[f64; 2]>(count)?);
        let size = piece(count);
        let pieces = ids.par_chunks_mut(size).zip(at.par_chunks_mut(size));
        let pieces = pieces.enumerate().map(|(i, (ids, at))| {
            let mut rows = Rows::new(window(&parts, i * size, ids.len()), coordinates);
            fill(&mut rows, ids, at)
        });
        let pieces: Vec<Vec<Further>> = pieces.collect();
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
            origin: coordinates.origin().map(Place::flat),
            ids,
            at,
            further,
        })
    }

    /// The number of points.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.at.len()
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.at.is_empty()
    }
}

/// The coordinates of the `count` points of a plan.
pub(super) fn coordinates(planned: &Planned, count: usize) -> Result<Vec<[f64; 2]>, Error> {
    let mut at = room::<[f64; 2]>(count)?;
    fill_coordinates(planned, &mut at)?;
    Ok(at)
}

/// Writes the coordinates of a plan's points to `at`, which has one place for each.
pub(super) fn fill_coordinates(planned: &Planned, at: &mut [[f64; 2]]) -> Result<(), Error> {
    let coordinates = coordinates_of(planned);
    let parts = bare(planned)?;
    let size = piece(at.len());
    at.par_chunks_mut(size).enumerate().for_each(|(i, at)| {
        let parts = window(&parts, i * size, at.len());
        if let ([part], Coordinates::World) = (parts.as_slice(), coordinates)
            && let Some(plan) = part.plan.plane()
        {
            plan.blocks::<F64>().fill(at);
            return;
        }
        let mut rows = Rows::new(parts, coordinates);
        let mut filled = 0;
        while let Some(batch) = rows.next(BATCH) {
            for point in batch.points {
                at[filled] = [point.x, point.y];
                filled += 1;
            }
        }
    });
    Ok(())
}

/// Writes the offsets of a plan's points to `at`, which has one place for each. Returns their origin.
pub(super) fn fill_offsets(planned: &Planned, at: &mut [[f32; 2]]) -> Result<[f64; 2], Error> {
    let parts = bare(planned)?;
    let output = Output {
        relative_to: planned.query.region.corner,
        ..Output::new(Encoding::F32)
    };
    let coordinates = Coordinates::of(&output, || Part::corner(&parts));
    let size = piece(at.len());
    at.par_chunks_mut(size).enumerate().for_each(|(i, at)| {
        let parts = window(&parts, i * size, at.len());
        if let [part] = parts.as_slice()
            && let Some(plan) = part.plan.plane()
            && coordinates.origin() == Some(Place::Plane(plan.origin()))
        {
            plan.blocks::<F32>().fill(at);
            return;
        }
        let mut rows = Rows::new(parts, coordinates);
        let mut filled = 0;
        while let Some(batch) = rows.next(BATCH) {
            at[filled..filled + batch.near.len()].copy_from_slice(batch.near);
            filled += batch.near.len();
        }
    });
    Ok(coordinates.origin().map_or([0.0; 2], Place::flat))
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
fn room<T: Clone + Default>(count: usize) -> Result<Vec<T>, Error> {
    let mut values = vec![];
    let reserved = values.try_reserve_exact(count);
    reserved.map_err(|_| Error::Internal("there is not enough memory for all points"))?;
    values.resize(count, T::default());
    Ok(values)
}

/// The number of points that one thread makes.
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

/// The columns of some rows, without values.
fn columns(rows: &Rows) -> Vec<Further> {
    let column = |column: &strew_encode::Column| Further {
        name: column.name.clone(),
        is_optional: column.optional,
        values: match &column.kind {
            Kind::Number => FurtherValues::Numbers(vec![]),
            Kind::Dictionary(names) => FurtherValues::Names(names.clone(), vec![]),
        },
    };
    rows.schema().columns().iter().map(column).collect()
}

/// Writes all rows; returns the values of their columns.
fn fill(rows: &mut Rows, ids: &mut [[i64; 2]], at: &mut [[f64; 2]]) -> Vec<Further> {
    let mut further = columns(rows);
    let mut filled = 0;
    while let Some(batch) = rows.next(BATCH) {
        let count = batch.points.len();
        let (ids, at) = (&mut ids[filled..], &mut at[filled..]);
        for ((id, at), point) in ids.iter_mut().zip(at).zip(batch.points) {
            let Point { id: own, x, y } = *point;
            (*id, *at) = ([own.x, own.y], [x, y]);
        }
        for (column, values) in further.iter_mut().zip(batch.columns) {
            column.values.extend(values, count);
        }
        filled += count;
    }
    further
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
