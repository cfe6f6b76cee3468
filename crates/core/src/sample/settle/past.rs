//! How points go past near neighbors, in sets with kinds whose points push each other.

use super::{
    cells::Cells,
    plain::{Root, SPARE, SURELY, above_zero, lesser, whole_number, within},
};

/// A neighbor counts as near below the root of this, in local spacings.
const NEAR: f32 = 0.4;

impl Cells {
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
        (at, placed): ([f32; 2], [f32; 2]),
        (wish, nearest): ([f32; 2], f32),
        whole: f32,
        clear: f32,
    ) -> Option<[f32; 2]> {
        let free = |squared: f32| above_zero((squared.sqrt_() * SURELY - clear) * 0.5 - SPARE);
        if (wish[0] * wish[0] + wish[1] * wish[1]).sqrt_() <= free(nearest) {
            return None;
        }
        let offset = [0, 1].map(|i| at[i] - placed[i]);
        let [mut x, mut y] = [0, 1].map(|i| within(offset[i] + wish[i], whole) - offset[i]);
        let length = (x * x + y * y).sqrt_();
        // Those farther off leave it free.
        let far = (2.0 * length + clear + 2.0 * SPARE) * 1.001;
        let ([dx, dy], nearest, next) = self.nearest_two(at, far);
        if length <= free(nearest) {
            return None;
        }
        let most = free(next);
        if length > most {
            let part = most / length;
            (x, y) = (x * part, y * part);
        }
        let (distance, most) = (nearest.sqrt_(), free(nearest));
        let toward = -(x * dx + y * dy) / distance;
        if toward > most {
            let back = (toward - most) / distance;
            (x, y) = (x + back * dx, y + back * dy);
        }
        let is_inside = (offset[0] + x).abs() <= whole && (offset[1] + y).abs() <= whole;
        is_inside.then(|| [at[0] + whole_number(x), at[1] + whole_number(y)])
    }

    /// The offset from the nearest point within a distance, its square, and that of the next one. Of equally near
    /// points the one of the lesser offset counts.
    #[inline(always)]
    fn nearest_two(&self, [x, y]: [f32; 2], far: f32) -> ([f32; 2], f32, f32) {
        let [columns, rows] =
            [(0, x), (1, y)].map(|(axis, v)| self.along[axis].cells(v - far, v + far));
        let (mut offset, mut nearest, mut next) = ([0.0; 2], f32::INFINITY, f32::INFINITY);
        for row in rows {
            let start = |column: usize| self.starts[row * self.along[0].cells + column] as usize;
            for other in &self.points[start(columns.start)..start(columns.end)] {
                let dx = x - other.at[0];
                let dy = y - other.at[1];
                let squared = dx * dx + dy * dy;
                if squared > 0.0 && squared <= next {
                    let is_less = [dx, dy] < offset;
                    if squared < nearest || (squared == nearest && is_less) {
                        (offset, next, nearest) = ([dx, dy], nearest, squared);
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
