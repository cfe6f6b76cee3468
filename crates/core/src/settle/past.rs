//! How points go past near neighbors, in sets with kinds whose points push each other.

use core::array::from_fn;

use super::{
    cells::Cells,
    plain::{Root, SPARE, SURELY, above_zero, lesser, squares, whole_number, within},
};

/// A neighbor counts as near below the root of this, in local spacings.
const NEAR: f32 = 0.4;

impl<const D: usize> Cells<D> {
    /// Where a point goes that would go farther than half of what separates it from the distance that is kept: past its
    /// nearest neighbor, and up to half of what separates it from the next one. `None` where it may go as it likes, and
    /// where it would leave the box around its place.
    ///
    /// Of two points that go to each other each goes half of what is free along the line between them, if each is the
    /// other's nearest one. If one of them has a nearer one, it goes no farther than half of what is free in any
    /// direction.
    #[inline(always)]
    pub(super) fn pass(
        &self,
        (at, placed): ([f32; D], [f32; D]),
        (wish, nearest): ([f32; D], f32),
        whole: f32,
        clear: f32,
    ) -> Option<[f32; D]> {
        let free = |squared: f32| above_zero((squared.sqrt_() * SURELY - clear) * 0.5 - SPARE);
        if squares(wish).sqrt_() <= free(nearest) {
            return None;
        }
        let offset: [f32; D] = from_fn(|i| at[i] - placed[i]);
        let mut go: [f32; D] = from_fn(|i| within(offset[i] + wish[i], whole) - offset[i]);
        let length = squares(go).sqrt_();
        // Those farther off leave it free.
        let far = (2.0 * length + clear + 2.0 * SPARE) * 1.001;
        let (away, nearest, next) = self.nearest_two(at, far);
        if length <= free(nearest) {
            return None;
        }
        let most = free(next);
        if length > most {
            let part = most / length;
            go = go.map(|v| v * part);
        }
        let (distance, most) = (nearest.sqrt_(), free(nearest));
        let mut along = go[0] * away[0];
        for i in 1..D {
            along += go[i] * away[i];
        }
        let toward = -along / distance;
        if toward > most {
            let back = (toward - most) / distance;
            go = from_fn(|i| go[i] + back * away[i]);
        }
        let is_inside = (0..D).all(|i| (offset[i] + go[i]).abs() <= whole);
        is_inside.then(|| from_fn(|i| at[i] + whole_number(go[i])))
    }

    /// The offset from the nearest point within a distance, its square, and that of the next one. Of equally near
    /// points the one of the lesser offset counts.
    #[inline(always)]
    fn nearest_two(&self, at: [f32; D], far: f32) -> ([f32; D], f32, f32) {
        let cells = from_fn(|axis| self.along[axis].cells(at[axis] - far, at[axis] + far));
        let (mut offset, mut nearest, mut next) = ([0.0; D], f32::INFINITY, f32::INFINITY);
        for row in self.rows_between(&cells) {
            let start = |column: usize| self.starts[row * self.along[0].cells + column] as usize;
            for other in &self.points[start(cells[0].start)..start(cells[0].end)] {
                let away = from_fn(|axis| at[axis] - other.at[axis]);
                let squared = squares(away);
                if squared > 0.0 && squared <= next {
                    let is_less = away < offset;
                    if squared < nearest || (squared == nearest && is_less) {
                        (offset, next, nearest) = (away, nearest, squared);
                    } else {
                        next = squared;
                    }
                }
            }
        }
        (offset, nearest, next)
    }
}

/// The freedom of a point that is too near to another one: up to its fourth root, which is reached where the nearest is
/// at half of the squared distance that counts as near.
#[inline(always)]
pub(super) fn eased(freedom: f32, nearest: f32, spacing: f32) -> f32 {
    let far = nearest / (NEAR * spacing * spacing);
    let part = lesser(2.0 * above_zero(1.0 - far), 1.0);
    freedom + (freedom.sqrt_().sqrt_() - freedom) * part
}
