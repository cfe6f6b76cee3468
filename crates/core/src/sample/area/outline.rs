//! How long an area's outline is: what counting its points costs, since only there points have to be
//! looked at one by one.

use super::{Area, Region};

impl Area {
    /// About half the length along the axes of the outlines of all its shapes, as far as they lie in
    /// `within`: width + height for a box that does.
    ///
    /// Counting takes time in proportion to this and to the area's height.
    #[must_use]
    pub fn outline(&self, within: Region) -> f64 {
        let sides = |region: Region| {
            let ([x0, y0], [x1, y1]) = (region.min(), region.max());
            (x1 - x0) + (y1 - y0)
        };
        match self {
            Self::Region(region) => sides(region.and(within)),
            Self::Circle(circle) => circle.bounds().map_or(0.0, |b| sides(b.and(within))),
            Self::Polygon(polygon) => {
                let all = polygon.sides().map(|side| sides(side.and(within)));
                all.sum::<f64>() / 2.0
            }
            Self::AnyOf(areas) | Self::AllOf(areas) => {
                areas.iter().map(|area| area.outline(within)).sum()
            }
            Self::Outside(area) => area.outline(within),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::sample::{Circle, Polygon};

    use super::*;

    #[test]
    fn outlines_add_up_and_end_where_they_are_not_looked_at() {
        let all = Region::new([-100.0; 2], [100.0; 2]).expect("ordered");
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        let square = Area::from(Region::new([0.0; 2], [2.0, 1.0]).expect("ordered"));
        let ring = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        let same = Area::from(Polygon::new(&[ring]).expect("valid"));
        assert!(near(square.outline(all), 3.0) && near(same.outline(all), 3.0));
        let circle = Area::from(Circle::new([0.0; 2], 5.0).expect("valid"));
        assert!(near(circle.outline(all), 20.0));
        let part = Region::new([0.0; 2], [1.0; 2]).expect("ordered");
        assert!(near(square.outline(part), 2.0));
        let both = circle.without([square]);
        assert!(near(both.outline(all), 23.0));
    }
}
