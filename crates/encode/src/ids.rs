//! Ids in formats whose integers are small: each part of an id as 32 bits, or three of them in 64.

use strew_core::PointId;
use strew_error::{Error, Fault};

use super::{
    part::Part,
    rows::{Row, Rows},
};

/// Displacements and the warp move points less than this from their lattice address.
const MOVED: f64 = 65536.0;
/// As [`MOVED`] for points in space.
const MOVED_IN_SPACE: f64 = 131_072.0;

/// Refuses points of which a part of the id may take more than `bits`, 21 or 32.
///
/// # Errors
/// [`Error::Invalid`] for regions farther than some 600 million spacings from the world's origin, or 300,000 with
/// 21 bits.
pub(super) fn check(format: &str, rows: &Rows, bits: u32) -> Result<(), Error> {
    let limit = (1i64 << (bits - 1)) as f64;
    let is_far = |part: &Part| {
        let region = part.plan.region();
        let heights = part.plan.heights().unwrap_or_default();
        let corners = [region.min(), region.max(), heights];
        let farthest = corners
            .iter()
            .flatten()
            .fold(0f64, |far, v| far.max(v.abs()));
        let (side, moved) = match (part.plan.plane(), part.plan.space()) {
            (Some(plan), _) => (plan.table().alpha().set_side_f64(), MOVED),
            (None, Some(plan)) => (plan.table().map().alpha().set_side_f64(), MOVED_IN_SPACE),
            (None, None) => return false,
        };
        let unit = part.plan.spacing() * side;
        farthest / unit + moved > limit
    };
    if rows.parts().any(is_far) {
        let detail = format!("parts of ids in this region have more than {bits} bits");
        let most = if bits < 32 { "300,000" } else { "600 million" };
        let allowed =
            format!("{format} within some {most} spacings of the origin; arrow, csv or f32 beyond");
        return Err(Fault::new("format", format, detail, allowed).into());
    }
    Ok(())
}

/// The bits that each part of an id has in one integer of 64.
pub(super) const fn bits_joined(is_in_space: bool) -> u32 {
    if is_in_space { 21 } else { 32 }
}

/// The id of a row in one integer: the column in the upper half, the row in the lower one; in space 21 bits for each
/// of x, y and z, x in the highest.
pub(super) fn joined(row: Row<'_>) -> i64 {
    let PointId { x, y } = row.point.id;
    match row.height {
        Some(height) => {
            let low = |v: i64| v & 0x1f_ffff;
            low(x) << 42 | low(y) << 21 | low(height.address)
        }
        None => (x << 32) | (y & 0xffff_ffff),
    }
}

/// A part of an id as two integers of 16 bits, the lower half first.
pub(super) const fn halves(part: i64) -> [u8; 4] {
    (part as i32).to_le_bytes()
}

#[cfg(test)]
mod tests {
    use strew_core::Point;

    use super::*;
    use crate::place::Height;

    #[test]
    fn ids_can_be_read_back() {
        let far = i64::from(i32::MAX);
        for [x, y] in [[0, 0], [5, -7], [-5, 7], [far, -far - 1], [-far - 1, far]] {
            let id = PointId { x, y };
            let point = Point {
                id,
                ..Point::default()
            };
            let row = Row {
                point: &point,
                height: None,
                index: 0,
                columns: &[],
            };
            let flat = joined(row);
            assert_eq!([flat >> 32, i64::from(flat as i32)], [x, y]);
            assert_eq!(
                [x, y].map(|part| i64::from(i32::from_le_bytes(halves(part)))),
                [x, y]
            );
        }
    }

    #[test]
    fn ids_in_space_have_21_bits_a_part() {
        let far = 1 << 20;
        for [x, y, z] in [[0, 0, 0], [5, -7, 9], [-5, 7, -1], [far - 1, -far, -far]] {
            let point = Point {
                id: PointId { x, y },
                ..Point::default()
            };
            let height = Height { address: z, z: 0.0 };
            let row = Row {
                point: &point,
                height: Some(&height),
                index: 0,
                columns: &[],
            };
            let id = joined(row);
            let part = |shift: u32| id << (43 - shift) >> 43;
            assert_eq!([part(42), part(21), part(0)], [x, y, z]);
        }
    }
}
