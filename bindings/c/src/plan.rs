//! Planned queries: counted, then written into buffers.

use std::ffi::c_char;

use ::strew_plan::library::{Further, FurtherValues};
use serde_json::json;
use strew_error::integer::Long;
use strew_query::{Draft, RegionDraft, ShapeDraft};

use crate::{
    dimension::Dimension,
    failure::{Code, Failure, guarded},
    handles::{strew_bytes, strew_library, strew_plan},
    memory::{borrowed, listed, place, room, text},
};

/// Plans a query and counts its points. Free the plan with `strew_plan_free`.
///
/// `axes` is 2 for the plane and 3 for space. `query` is the JSON body of `POST /v1/points:query`, or the query string of
/// `GET /v1/points`: `bbox=0,0,10,10&spacing=1&seed=7`; in space those of `/v1/space/points`, such as
/// `ball=5,5,5,3&spacing=1&seed=7`.
///
/// # Safety
/// `library` is a library, `query` a text, `plan` a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_query(
    library: *const strew_library,
    axes: u32,
    query: *const c_char,
    plan: *mut *mut strew_plan,
) -> Code {
    guarded(|| {
        let read = Dimension::of(axes)?;
        // SAFETY: as the caller promises.
        unsafe { planned(library, query, plan, |text| read.query(text)) }
    })
}

/// Plans the points of a chunk, the square or cube of the world grid with this size and these indices along the axes.
/// Coordinates are relative to its corner (`strew_plan_origin`). Neighbors share no point and lose none.
///
/// `query` is as in `strew_plan_query`, without a region: one text serves all chunks.
///
/// # Safety
/// As `strew_plan_query`; `at` has `axes` integers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_chunk(
    library: *const strew_library,
    axes: u32,
    query: *const c_char,
    size: f64,
    at: *const i64,
    plan: *mut *mut strew_plan,
) -> Code {
    guarded(|| {
        let dimension = Dimension::of(axes)?;
        // SAFETY: as the caller promises.
        let at = unsafe { listed(at, dimension.axes(), "at")? };
        let shape = match *at {
            [x, y, z] => ShapeDraft::Cube(size, [x, y, z]),
            _ => ShapeDraft::Chunk(size, [at[0], at[1]]),
        };
        let path = "chunk".into();
        let read = |text: &str| {
            Ok(dimension
                .query(text)?
                .within(Ok(RegionDraft { path, shape })))
        };
        // SAFETY: as the caller promises.
        unsafe { planned(library, query, plan, read) }
    })
}

/// # Safety
/// As [`strew_plan_query`].
unsafe fn planned(
    library: *const strew_library,
    query: *const c_char,
    plan: *mut *mut strew_plan,
    read: impl FnOnce(&str) -> Result<Draft, strew_error::Error>,
) -> Result<(), Failure> {
    // SAFETY: as the caller promises.
    let (library, query, out) = unsafe {
        let library = borrowed(library, "library")?;
        (library, text(query, "query")?, place(plan, "plan")?)
    };
    let (planned, options) = library.0.plan_draft(&read(query)?)?;
    out.put(Box::into_raw(Box::new(strew_plan {
        library: library.0.clone(),
        planned,
        plane: options.plane,
        columns: std::sync::OnceLock::new(),
    })));
    Ok(())
}

/// The number of coordinates of each point: 2 in the plane, 3 in space; 0 for null.
///
/// # Safety
/// `plan` is null or a plan.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_axes(plan: *const strew_plan) -> u32 {
    // SAFETY: as the caller promises.
    unsafe { plan.as_ref() }.map_or(0, |plan| plan.planned.axes() as u32)
}

/// The exact number of points, which can be more than an answer may have.
///
/// Returns `STREW_TOO_MANY_POINTS` for 2^64 points and more; the message has their number.
///
/// # Safety
/// `plan` is a plan, `count` a place for a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_count(plan: *const strew_plan, count: *mut u64) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let (plan, out) = unsafe { (borrowed(plan, "plan")?, place(count, "count")?) };
        let (count, limit) = (plan.planned.count(), u64::MAX);
        let few = u64::try_from(count);
        out.put(few.map_err(|_| strew_error::Error::TooManyPoints { count, limit })?);
        Ok(())
    })
}

/// The place that the `f64` coordinates are relative to: the corner of a chunk, else the origin of the world.
///
/// # Safety
/// `plan` is a plan, `origin` has room for a number of each axis.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_origin(plan: *const strew_plan, origin: *mut f64) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let plan = unsafe { borrowed(plan, "plan")? };
        // SAFETY: as the caller promises.
        let out = unsafe { room(origin, plan.planned.axes(), "origin")? };
        match &plan.planned.query.region.corner {
            Some(corner) => out.copy_from_slice(corner.as_slice()),
            None => out.fill(0.0),
        }
        Ok(())
    })
}

/// Writes the coordinates: x and y by turns, in space x, y and z, for each point, in the fixed order of the query.
///
/// `capacity` is the number of doubles that `coordinates` has room for, 2 or 3 for each point; `STREW_BUFFER_TOO_SMALL`
/// if it is too small. No other memory is needed. Large answers are made on all cores.
///
/// # Safety
/// `plan` is a plan, `coordinates` has room for `capacity` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_fill_coordinates(
    plan: *const strew_plan,
    coordinates: *mut f64,
    capacity: usize,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let (plan, at) = unsafe { filled(plan, coordinates, capacity, "coordinates", None)? };
        plan.library.fill_coordinates(&plan.planned, at)?;
        Ok(())
    })
}

/// Writes the coordinates as `f32`, relative to the lower corner of the region, which is written to `origin` unless
/// that is null. `capacity` counts floats.
///
/// # Safety
/// As `strew_plan_fill_coordinates`; `origin` is null or has room for a number of each axis.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_fill_coordinates_f32(
    plan: *const strew_plan,
    coordinates: *mut f32,
    capacity: usize,
    origin: *mut f64,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let (plan, at) = unsafe { filled(plan, coordinates, capacity, "coordinates", None)? };
        let (_, from) = plan.library.fill_offsets(&plan.planned, at)?;
        if !origin.is_null() {
            // SAFETY: as the caller promises.
            let out = unsafe { room(origin, plan.planned.axes(), "origin")? };
            out.copy_from_slice(from.as_slice());
        }
        Ok(())
    })
}

/// Writes the stable ids: an integer of each axis for each point, which are `x:y` or `x:y:z` in text.
///
/// The first call that needs ids or a column makes all of them; they stay in memory until the plan is freed.
///
/// # Safety
/// `plan` is a plan, `ids` has room for `capacity` integers, 2 or 3 for each point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_fill_ids(
    plan: *const strew_plan,
    ids: *mut i64,
    capacity: usize,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let (plan, ids) = unsafe { filled(plan, ids, capacity, "ids", None)? };
        ids.copy_from_slice(&plan.columns()?.ids);
        Ok(())
    })
}

/// A plan, and the room for `each` numbers of each of its points, or a number of each axis.
///
/// # Safety
/// `plan` is a plan, `numbers` has room for `capacity` numbers.
unsafe fn filled<'a, T: Copy>(
    plan: *const strew_plan,
    numbers: *mut T,
    capacity: usize,
    name: &str,
    each: Option<usize>,
) -> Result<(&'a strew_plan, &'a mut [T]), Failure> {
    // SAFETY: as the caller promises.
    let plan = unsafe { borrowed(plan, "plan")? };
    let points = plan.library.count_to_make(&plan.planned)?;
    let count = points.saturating_mul(each.unwrap_or(plan.planned.axes()));
    if count > capacity {
        return Err(Failure::room(capacity, points, count));
    }
    // SAFETY: as the caller promises.
    Ok((plan, unsafe { room(numbers, count, name)? }))
}

/// Writes a column of numbers, such as `angle` or `scale`; NaN where a layer lacks it.
///
/// Returns `STREW_INVALID_ARGUMENT` if the query has no such column or its values are names.
///
/// # Safety
/// `plan` is a plan, `column` a text, `values` has room for `capacity` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_fill_numbers(
    plan: *const strew_plan,
    column: *const c_char,
    values: *mut f64,
    capacity: usize,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let name = unsafe { text(column, "column")? };
        // SAFETY: as the caller promises.
        let (plan, values) = unsafe { filled(plan, values, capacity, "values", Some(1))? };
        let FurtherValues::Numbers(numbers) = plan.further(name)? else {
            let allowed = "strew_plan_fill_codes for columns of names";
            return Err(Failure::argument("column", "a column of names", allowed));
        };
        values.copy_from_slice(numbers);
        Ok(())
    })
}

/// Writes a column of names, such as `variant` or `layer`, as indices into the list of `strew_plan_columns`; -1
/// where a layer lacks it.
///
/// Returns `STREW_INVALID_ARGUMENT` if the query has no such column or its values are numbers.
///
/// # Safety
/// `plan` is a plan, `column` a text, `codes` has room for `capacity` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_fill_codes(
    plan: *const strew_plan,
    column: *const c_char,
    codes: *mut i32,
    capacity: usize,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let name = unsafe { text(column, "column")? };
        // SAFETY: as the caller promises.
        let (plan, codes) = unsafe { filled(plan, codes, capacity, "codes", Some(1))? };
        let FurtherValues::Names(_, indices) = plan.further(name)? else {
            let allowed = "strew_plan_fill_numbers for columns of numbers";
            return Err(Failure::argument("column", "a column of numbers", allowed));
        };
        codes.copy_from_slice(indices);
        Ok(())
    })
}

/// The columns beside ids and coordinates as JSON: a list of objects with `name` and `names`, which is the list of
/// names, or null for numbers.
///
/// # Safety
/// `plan` is a plan, `columns` a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_columns(
    plan: *const strew_plan,
    columns: *mut *mut strew_bytes,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let made = unsafe { borrowed(plan, "plan")? }.columns()?;
        let column = |column: &Further| match &column.values {
            FurtherValues::Numbers(_) => json!({"name": column.name, "names": null}),
            FurtherValues::Names(names, _) => json!({"name": column.name, "names": &**names}),
        };
        let list: Vec<_> = made.further.iter().map(column).collect();
        // SAFETY: as the caller promises.
        unsafe { strew_bytes::hand_over(json!(list).to_string().into_bytes(), columns) }
    })
}

/// The query with everything filled in, as JSON.
///
/// # Safety
/// `plan` is a plan, `query` a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_resolved(
    plan: *const strew_plan,
    query: *mut *mut strew_bytes,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let plan = unsafe { borrowed(plan, "plan")? };
        let text = json!(plan.planned.resolved()).to_string();
        // SAFETY: as the caller promises.
        unsafe { strew_bytes::hand_over(text.into_bytes(), query) }
    })
}

/// Splits the points into up to `parts` parts of the same size, give or take one, as JSON: a list of objects with
/// the `cursor` and the `limit` that, put into the query, make the part.
///
/// # Safety
/// `plan` is a plan, `list` a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_split(
    plan: *const strew_plan,
    parts: u32,
    list: *mut *mut strew_bytes,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let plan = unsafe { borrowed(plan, "plan")? };
        let parts = plan.library.split(&plan.planned, &parts.to_string())?;
        let part = |(cursor, count): (strew_query::Token, u64)| json!({"cursor": cursor.to_string(), "limit": Long(count)});
        let text = json!(parts.into_iter().map(part).collect::<Vec<_>>()).to_string();
        // SAFETY: as the caller promises.
        unsafe { strew_bytes::hand_over(text.into_bytes(), list) }
    })
}

impl strew_plan {
    pub(crate) fn columns(&self) -> Result<&::strew_plan::Columns, Failure> {
        if let Some(made) = self.columns.get() {
            return Ok(made);
        }
        let made = self.library.columns(&self.planned)?;
        Ok(self.columns.get_or_init(|| made))
    }

    /// The values of a column by its name.
    fn further(&self, name: &str) -> Result<&FurtherValues, Failure> {
        let columns = self.columns()?;
        let found = columns.further.iter().find(|column| column.name == name);
        found.map(|column| &column.values).ok_or_else(|| {
            let names: Vec<&str> = columns.further.iter().map(|column| &*column.name).collect();
            let allowed = match names.as_slice() {
                [] => "columns that the query names in attributes; it names none".into(),
                names => names.join(", "),
            };
            Failure::argument("column", &format!("no column `{name}`"), &allowed)
        })
    }
}
