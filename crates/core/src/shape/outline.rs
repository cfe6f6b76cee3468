//! The length of outlines. Counting tests points one by one only along them, so their length is its cost.

use alloc::vec::Vec;

use super::{Area, Region};

impl Area {
    /// About half the length, along the axes and in world units, of the outlines of all shapes inside `within`: width +
    /// height for a box. Counting takes time in proportion to this and to the height.
    #[must_use]
    pub fn outline(&self, within: Region) -> f64 {
        let mut all = 0.0;
        self.sides(&within, &mut |side| all += length(side));
        all / 2.0
    }

    /// About how many comparisons of points with sides of polygons, boxes and circles it takes to count this area inside
    /// `within`, at a mean spacing: points beside an outline are compared with all sides in their patch. It takes time in
    /// proportion to the sides and to the outline.
    #[must_use]
    pub fn comparisons(&self, within: Region, spacing: f64) -> f64 {
        /// About the lattice units in a mean spacing.
        const UNITS: f64 = 3.0;
        let unit = spacing / UNITS;
        let least = within.min();
        // Larger cells overestimate.
        let cells = self.outline(within) / (PATCH[1] * unit);
        let scale = unit * (cells / MOST_CELLS).max(1.0);
        let mut all: Vec<([u32; 2], f64)> = Vec::new();
        self.sides(&within, &mut |side| {
            // Casts saturate.
            let cell =
                |p: [f64; 2]| [0, 1].map(|i| ((p[i] - least[i]) / (PATCH[i] * scale)) as u32);
            let [a, b] = side.map(cell);
            let rows = a[1].min(b[1])..=a[1].max(b[1]);
            let along = length(side) / scale;
            for row in rows.clone() {
                // From where the side enters the row to where it leaves it.
                let column = |row: u32| {
                    let y = least[1] + f64::from(row) * PATCH[1] * scale;
                    let part = ((y - side[0][1]) / (side[1][1] - side[0][1])).clamp(0.0, 1.0);
                    let x = side[0][0] + (side[1][0] - side[0][0]) * part;
                    cell([x, y])[0]
                };
                let [from, to] = match rows.start() == rows.end() {
                    true => [a[0], b[0]],
                    false => [column(row), column(row + 1)],
                };
                let columns = from.min(to)..=from.max(to);
                let crossed = (rows.clone().count() * columns.clone().count()) as f64;
                all.extend(columns.map(|column| ([row, column], along / crossed)));
            }
        });
        all.sort_unstable_by_key(|&(cell, _)| cell);
        // The places of a cell, and those beside sides of any length.
        let [width, height] =
            [0, 1].map(|i| (PATCH[i] * scale).min(within.sides()[i]) / unit + REACH);
        let compared = all.chunk_by(|a, b| a.0 == b.0).map(|sides| {
            let beside = sides
                .iter()
                .map(|(_, along)| REACH * (REACH + along * scale / unit));
            sides.len() as f64 * beside.sum::<f64>().min(width * height) * DENSITY
        });
        compared.sum()
    }

    /// Calls `visit` for the parts inside `within` of all sides of polygons and boxes. Circles have those of the boxes
    /// around them.
    fn sides(&self, within: &Region, visit: &mut impl FnMut([[f64; 2]; 2])) {
        let mut of_box = |region: Region| {
            // A circle may cross a part of its box that has none of the sides.
            let part = region.and(*within);
            if part.is_empty() {
                return;
            }
            let ([x0, y0], [x1, y1]) = (part.min(), part.max());
            let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
            (0..4).for_each(|i| visit([corners[i], corners[(i + 1) % 4]]));
        };
        match self {
            Self::Region(region) => of_box(*region),
            Self::Ball(circle) => circle.bounds().into_iter().for_each(of_box),
            Self::Outlined(polygon) => {
                let sides = polygon.sides().filter_map(|side| clipped(side, within));
                sides.for_each(visit);
            }
            Self::AnyOf(areas) | Self::AllOf(areas) => {
                areas.iter().for_each(|area| area.sides(within, visit));
            }
            Self::Outside(area) => area.sides(within, visit),
        }
    }
}

/// The sides of a patch, in lattice units.
const PATCH: [f64; 2] = [1024.0, 256.0];
/// About the most cells of the size of a patch that outlines cross, which bounds the memory.
const MOST_CELLS: f64 = 65_536.0;
/// Points to be compared lie this far from a side, in lattice units, on both sides together.
const REACH: f64 = 26.0;
/// About the points in a lattice unit squared.
const DENSITY: f64 = 0.1;

/// The length of a side along the axes.
const fn length([a, b]: [[f64; 2]; 2]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).abs()
}

/// The part of a side inside a box.
fn clipped([a, b]: [[f64; 2]; 2], within: &Region) -> Option<[[f64; 2]; 2]> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for i in 0..2 {
        let (min, max, along) = (within.min()[i], within.max()[i], b[i] - a[i]);
        if a[i].max(b[i]) < min || a[i].min(b[i]) > max {
            return None;
        }
        if along != 0.0 {
            let ends = [min, max].map(|end| (end - a[i]) / along);
            from = from.max(ends[0].min(ends[1]));
            to = to.min(ends[0].max(ends[1]));
        }
    }
    let at = |part: f64| [0, 1].map(|i| a[i] + (b[i] - a[i]) * part);
    (from <= to).then(|| [at(from), at(to)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Circle, Polygon};

    #[test]
    fn outlines_add_up_and_are_clipped() {
        let all = Region::new([-100.0; 2], [100.0; 2]).expect("ordered");
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
        let square = Area::from(Region::new([0.0; 2], [2.0, 1.0]).expect("ordered"));
        let ring = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        let same = Area::from(Polygon::new(&[ring]).expect("valid"));
        assert!(near(square.outline(all), 3.0) && near(same.outline(all), 3.0));
        let circle = Area::from(Circle::new([0.0; 2], 5.0).expect("valid"));
        assert!(near(circle.outline(all), 20.0));
        let part = Region::new([0.0; 2], [1.0; 2]).expect("ordered");
        assert!(near(square.outline(part), 2.0));
        // A triangle across the plane crosses patches; many short sides in one are compared with all points there.
        let triangle = |at: f64, side: f64| {
            let ring = [[at, 0.0], [at + side, 0.0], [at, side]];
            Area::from(Polygon::new(&[ring]).expect("valid"))
        };
        let one = triangle(0.0, 1e-3).comparisons(all, 3.0);
        let beside = REACH * (3.0 * REACH + 4e-3);
        assert!(near(one, 3.0 * beside * DENSITY), "{one}");
        let apart = Area::any_of([triangle(-99.0, 1e-3), triangle(0.0, 1e-3)]);
        let twice = 2.0 * triangle(0.0, 1e-3).comparisons(all, 0.15);
        assert!(near(apart.comparisons(all, 0.15), twice), "{twice}");
        let many = Area::any_of((0..1000).map(|_| triangle(0.0, 1e-3)));
        let points = DENSITY * (200.0 + REACH) * (200.0 + REACH);
        assert!(near(many.comparisons(all, 3.0), 3000.0 * points));
        let both = circle.without([square]);
        assert!(near(both.outline(all), 23.0));
    }
}
