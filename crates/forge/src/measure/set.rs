//! Point sets to measure.

/// The points of a square at unit density: one period of a set that repeats, or a window of an unbounded one.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    side: f64,
    points: Vec<[f64; 2]>,
    is_periodic: bool,
}

impl Sample {
    /// Rescales the points of one period, a torus of side `side`, to unit density: to a side of √N mean spacings.
    /// Coordinates may lie outside [0, side); they are taken modulo the side.
    #[must_use]
    pub fn torus(side: f64, points: Vec<[f64; 2]>) -> Self {
        let unit_side = (points.len() as f64).sqrt();
        Self::scaled(unit_side, unit_side / side, points, true)
    }

    /// Rescales the points in the box [0, `side`)² of a set with `density` points per unit area to
    /// unit density. Points outside the box are dropped; none inside may be missing.
    #[must_use]
    pub fn window(side: f64, density: f64, mut points: Vec<[f64; 2]>) -> Self {
        points.retain(|p| p.iter().all(|v| (0.0..side).contains(v)));
        let scale = density.sqrt();
        Self::scaled(side * scale, scale, points, false)
    }

    fn scaled(side: f64, scale: f64, mut points: Vec<[f64; 2]>, is_periodic: bool) -> Self {
        for p in &mut points {
            *p = p.map(|v| v * scale);
        }
        Self {
            side,
            points,
            is_periodic,
        }
    }

    /// The side of the square, in mean spacings.
    #[must_use]
    pub const fn side(&self) -> f64 {
        self.side
    }

    /// Whether the set repeats outside the square.
    #[must_use]
    pub const fn is_periodic(&self) -> bool {
        self.is_periodic
    }

    /// Whether all is there within `margin` of a point: on a torus always, in a window away from its edge.
    pub(super) fn is_inner(&self, margin: f64, p: &[f64; 2]) -> bool {
        let inner = margin..self.side - margin;
        self.is_periodic || p.iter().all(|v| inner.contains(v))
    }

    /// The points, in mean spacings.
    #[must_use]
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// The points for moving them, in mean spacings.
    pub fn points_mut(&mut self) -> &mut [[f64; 2]] {
        &mut self.points
    }
}
