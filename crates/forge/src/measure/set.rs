//! Point sets to measure: one period of a periodic set, or a window of an unbounded set.

/// A periodic point set at unit density, on a torus whose side is √N mean spacings. Coordinates may
/// lie outside [0, side); they are taken modulo the side.
#[derive(Clone, Debug, PartialEq)]
pub struct Torus {
    side: f64,
    points: Vec<[f64; 2]>,
}

impl Torus {
    /// Rescales the points of a torus of side `side` to unit density.
    #[must_use]
    pub fn new(side: f64, mut points: Vec<[f64; 2]>) -> Self {
        let unit_side = (points.len() as f64).sqrt();
        let scale = unit_side / side;
        for p in &mut points {
            *p = p.map(|v| v * scale);
        }
        Self {
            side: unit_side,
            points,
        }
    }

    /// The side of the torus, √N mean spacings.
    #[must_use]
    pub const fn side(&self) -> f64 {
        self.side
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

/// The points of an unbounded set at unit density that lie in the box [0, side)².
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    side: f64,
    points: Vec<[f64; 2]>,
}

impl Window {
    /// Rescales the points in the box [0, `side`)² of a set with `density` points per unit area to
    /// unit density. Points outside the box are dropped; none inside may be missing.
    #[must_use]
    pub fn new(side: f64, density: f64, mut points: Vec<[f64; 2]>) -> Self {
        points.retain(|p| p.iter().all(|v| (0.0..side).contains(v)));
        let scale = density.sqrt();
        for p in &mut points {
            *p = p.map(|v| v * scale);
        }
        Self {
            side: side * scale,
            points,
        }
    }

    /// The side of the box, in mean spacings.
    #[must_use]
    pub const fn side(&self) -> f64 {
        self.side
    }

    /// The points, in mean spacings.
    #[must_use]
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }
}
