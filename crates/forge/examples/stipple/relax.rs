//! Weighted Voronoi stippling (Secord 2002): each point goes to the centroid of its cell, weighted by the picture.

use std::error::Error;

use spade::{
    DelaunayTriangulation, HasPosition, Point2, Triangulation, handles::FixedVertexHandle,
};

use crate::pictures::Ground;

/// The weight of a place.
#[derive(Clone, Copy)]
pub enum Weight {
    /// The darkness, as published. The density tends to the root of the weight, so long steps would lighten what is
    /// dark.
    Darkness,
    /// Its square, so that the density tends to the darkness.
    Squared,
}

/// A point with its number.
struct Site {
    at: Point2<f64>,
    number: usize,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// A step of all points. A point without weight around it stays.
pub fn step(
    ground: &Ground,
    points: &[[f64; 2]],
    weight: Weight,
) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let sites = points.iter().enumerate().map(|(number, &[x, y])| Site {
        at: Point2::new(x, y),
        number,
    });
    let sites = DelaunayTriangulation::<Site>::bulk_load(sites.collect())?;
    let mut sums = vec![[0.0; 3]; points.len()];
    let mut first = FixedVertexHandle::from_index(0);
    for (row, densities) in ground.densities.chunks_exact(ground.columns).enumerate() {
        let y = (row as f64 + 0.5) * ground.cell[1];
        // The nearest point of a cell is near that of the cell before, in each row near that of the row before.
        let mut nearest = first;
        for (column, density) in densities.iter().enumerate() {
            let x = (column as f64 + 0.5) * ground.cell[0];
            nearest = nearest_from(&sites, nearest, Point2::new(x, y));
            if column == 0 {
                first = nearest;
            }
            let weight = match weight {
                Weight::Darkness => *density,
                Weight::Squared => density * density,
            };
            let sum = &mut sums[sites.vertex(nearest).data().number];
            *sum = [sum[0] + weight * x, sum[1] + weight * y, sum[2] + weight];
        }
    }
    let moved = points
        .iter()
        .zip(&sums)
        .map(|(point, [x, y, all])| match *all > 0.0 {
            true => [x / all, y / all],
            false => *point,
        });
    Ok(moved.collect())
}

/// The point nearest to a place. In a Delaunay triangulation each other point has a neighbor that is nearer.
fn nearest_from(
    sites: &DelaunayTriangulation<Site>,
    start: FixedVertexHandle,
    at: Point2<f64>,
) -> FixedVertexHandle {
    let far = |site: Point2<f64>| (site.x - at.x).powi(2) + (site.y - at.y).powi(2);
    let mut best = sites.vertex(start);
    let mut least = far(best.position());
    loop {
        let neighbors = best.out_edges().map(|edge| edge.to());
        let near = neighbors.map(|site| (far(site.position()), site));
        match near.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((distance, site)) if distance < least => (least, best) = (distance, site),
            _ => return best.fix(),
        }
    }
}
