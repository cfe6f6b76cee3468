//! Ids in formats whose integers are small: both halves of an id as 32 bits.

use strew_core::PointId;
use strew_error::{Error, Fault};

use super::{part::Part, rows::Rows};

/// Displacements and the warp move points less than this from their lattice address.
const MOVED: f64 = 65536.0;

/// Refuses points whose ids may take more than 32 bits a half.
///
/// # Errors
/// [`Error::Invalid`] for regions farther than some 600 million spacings from the world's origin.
pub(super) fn check(format: &str, rows: &Rows) -> Result<(), Error> {
    let is_far = |part: &Part| {
        let Some(plan) = part.plan.plane() else {
            return false;
        };
        let region = part.plan.region();
        let corners = [region.min(), region.max()];
        let farthest = corners
            .iter()
            .flatten()
            .fold(0f64, |far, v| far.max(v.abs()));
        let unit = part.plan.spacing() * plan.table().alpha().set_side_f64();
        farthest / unit + MOVED > f64::from(i32::MAX)
    };
    if rows.parts().any(is_far) {
        let detail = "ids in this region have more than 32 bits a half";
        let allowed = format!(
            "{format} within some 600 million spacings of the origin; arrow, csv or f32 beyond"
        );
        return Err(Fault::new("format", format, detail, allowed).into());
    }
    Ok(())
}

/// An id in one integer: the column in the upper half, the row in the lower one.
pub(super) const fn joined(id: PointId) -> i64 {
    (id.x << 32) | (id.y & 0xffff_ffff)
}

/// An id as four integers of 16 bits: the lower and the upper half of the column, then those of the row.
pub(super) fn halves(id: PointId) -> [u8; 8] {
    let (x, y) = (id.x as i32, id.y as i32);
    let mut out = [0; 8];
    out[..4].copy_from_slice(&x.to_le_bytes());
    out[4..].copy_from_slice(&y.to_le_bytes());
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_can_be_read_back() {
        let far = i64::from(i32::MAX);
        for [x, y] in [[0, 0], [5, -7], [-5, 7], [far, -far - 1], [-far - 1, far]] {
            let id = PointId { x, y };
            let joined = joined(id);
            assert_eq!([joined >> 32, i64::from(joined as i32)], [x, y]);
            let halves = halves(id);
            let half = |at: usize| i32::from_le_bytes(halves[at..at + 4].try_into().expect("4"));
            assert_eq!([half(0), half(4)].map(i64::from), [x, y]);
        }
    }
}
