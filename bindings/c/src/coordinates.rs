//! Coordinates and ids of plans, written once for the plane and for space: `AXES` numbers for each point.

use crate::{
    failure::Failure,
    handles::strew_plan,
    memory::{borrowed, room},
};

/// Writes the place that coordinates are relative to.
///
/// # Safety
/// `plan` is a plan, `origin` has room for `AXES` numbers.
pub unsafe fn origin_of<const AXES: usize>(
    plan: *const strew_plan,
    origin: *mut f64,
) -> Result<(), Failure> {
    // SAFETY: as the caller promises.
    let (plan, out) = unsafe { (borrowed(plan, "plan")?, room(origin, AXES, "origin")?) };
    plan.check_axes(AXES)?;
    match &plan.planned.query.region.corner {
        Some(corner) => out.copy_from_slice(corner.as_slice()),
        None => out.fill(0.0),
    }
    Ok(())
}

/// A plan, and the room for `AXES` numbers of each of its points.
///
/// # Safety
/// `plan` is a plan, `numbers` has room for `AXES * capacity` numbers.
unsafe fn filled<'a, const AXES: usize, T: Copy>(
    plan: *const strew_plan,
    numbers: *mut T,
    capacity: usize,
    name: &str,
) -> Result<(&'a strew_plan, &'a mut [T]), Failure> {
    // SAFETY: as the caller promises.
    let plan = unsafe { borrowed(plan, "plan")? };
    plan.check_axes(AXES)?;
    let count = plan.count_for(capacity)?;
    // SAFETY: as the caller promises.
    Ok((plan, unsafe { room(numbers, AXES * count, name)? }))
}

/// Writes coordinates.
///
/// # Safety
/// As [`filled`].
pub unsafe fn fill<const AXES: usize>(
    plan: *const strew_plan,
    at: *mut f64,
    capacity: usize,
    name: &str,
) -> Result<(), Failure> {
    // SAFETY: as the caller promises.
    let (plan, at) = unsafe { filled::<AXES, _>(plan, at, capacity, name)? };
    plan.library.fill_coordinates(&plan.planned, at)?;
    Ok(())
}

/// Writes coordinates as `f32`, and their origin unless it is null.
///
/// # Safety
/// As [`filled`]; `origin` is null or has room for `AXES` numbers.
pub unsafe fn fill_f32<const AXES: usize>(
    plan: *const strew_plan,
    at: *mut f32,
    capacity: usize,
    origin: *mut f64,
    name: &str,
) -> Result<(), Failure> {
    // SAFETY: as the caller promises.
    let (plan, at) = unsafe { filled::<AXES, _>(plan, at, capacity, name)? };
    let (_, from) = plan.library.fill_offsets(&plan.planned, at)?;
    if !origin.is_null() {
        // SAFETY: as the caller promises.
        unsafe { room(origin, AXES, "origin")? }.copy_from_slice(from.as_slice());
    }
    Ok(())
}

/// Writes ids.
///
/// # Safety
/// As [`filled`].
pub unsafe fn fill_ids<const AXES: usize>(
    plan: *const strew_plan,
    ids: *mut i64,
    capacity: usize,
) -> Result<(), Failure> {
    // SAFETY: as the caller promises.
    let (plan, ids) = unsafe { filled::<AXES, _>(plan, ids, capacity, "ids")? };
    ids.copy_from_slice(&plan.columns()?.ids);
    Ok(())
}

impl strew_plan {
    fn check_axes(&self, axes: usize) -> Result<(), Failure> {
        let (detail, allowed) = match self.planned.axes() {
            own if own == axes => return Ok(()),
            2 => ("points of the plane", "a plan of strew_space_plan_query"),
            _ => ("points in space", "a plan of strew_plan_query"),
        };
        Err(Failure::argument("plan", detail, allowed))
    }
}
