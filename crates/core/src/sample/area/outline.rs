//! The length of outlines. Counting tests points one by one only along them, so their length is its cost.

use alloc::vec::Vec;

use super::{Area, Region};

impl Area {
    /// About half the length, along the axes, of the outlines of all shapes inside `within`: width +
    /// height for a box.
    pub(crate) fn outline(&self, within: Region) -> f64 {
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

    /// The sum, over strips of a height, of the [`outline`](Self::outline) in the strip times the number
    /// of edges, boxes and circles that touch it: points beside an outline are compared with all of
    /// these.
    pub(crate) fn comparisons(&self, within: Region, strip: f64) -> f64 {
        let height = within.max()[1] - within.min()[1];
        let mut strips = Strips {
            within,
            strip: strip.max(height / MOST_STRIPS),
            all: Vec::new(),
        };
        self.gather(&mut strips);
        let products = strips.all.iter().map(|[edges, outline]| edges * outline);
        products.sum()
    }

    fn gather(&self, strips: &mut Strips) {
        match self {
            Self::Region(region) => strips.add(*region, 1.0),
            Self::Circle(circle) => circle.bounds().into_iter().for_each(|b| strips.add(b, 1.0)),
            Self::Polygon(polygon) => polygon.sides().for_each(|side| strips.add(side, 0.5)),
            Self::AnyOf(areas) | Self::AllOf(areas) => {
                areas.iter().for_each(|area| area.gather(strips));
            }
            Self::Outside(area) => area.gather(strips),
        }
    }
}

/// The most strips, which bounds the memory. Higher strips overestimate.
const MOST_STRIPS: f64 = 65_536.0;

/// The number of edges and the length of outline of each strip.
struct Strips {
    within: Region,
    strip: f64,
    all: Vec<[f64; 2]>,
}

impl Strips {
    /// Adds `share` of the width and height of an edge's box.
    fn add(&mut self, part: Region, share: f64) {
        let ([x0, y0], [x1, y1]) = (part.min(), part.max());
        let (min, max) = (self.within.min(), self.within.max());
        if x1 < min[0] || x0 > max[0] || y1 < min[1] || y0 > max[1] {
            return;
        }
        let part = part.and(self.within);
        let ([x0, y0], [x1, y1]) = (part.min(), part.max());
        // Casts saturate.
        let [first, last] = [y0, y1].map(|y| ((y - min[1]) / self.strip) as usize);
        if self.all.len() <= last {
            self.all.resize(last + 1, [0.0; 2]);
        }
        let each = share * ((x1 - x0) + (y1 - y0)) / (last - first + 1) as f64;
        for [edges, outline] in &mut self.all[first..=last] {
            *edges += 1.0;
            *outline += each;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{
        super::{Circle, Polygon},
        *,
    };

    #[test]
    fn outlines_add_up_and_are_clipped() {
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
        // The circle touches three strips, the square the second.
        let both = circle.clone().without([square.clone()]);
        let disc = Region::new([-5.0; 2], [5.0; 2]).expect("ordered");
        let compared = both.comparisons(disc, 4.9);
        assert!(near(compared, 4.0 * 20.0 / 3.0 + 2.0 * 3.0), "{compared}");
        let both = circle.without([square]);
        assert!(near(both.outline(all), 23.0));
    }
}
