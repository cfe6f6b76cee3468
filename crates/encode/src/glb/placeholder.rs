//! The mesh at points until a program sets its own: a pyramid, as high as points are apart.

/// A pyramid with its base on the ground; y is up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placeholder {
    /// Half of a side of the base.
    half: f32,
    height: f32,
}

/// Four sides and two triangles of the base, seen from outside counterclockwise.
const TRIANGLES: [[u16; 3]; 6] = [
    [0, 1, 4],
    [1, 2, 4],
    [2, 3, 4],
    [3, 0, 4],
    [0, 3, 2],
    [0, 2, 1],
];

impl Placeholder {
    /// The number of vertices.
    pub(super) const VERTICES: usize = 5;
    /// The number of indices.
    pub(super) const INDICES: usize = 3 * TRIANGLES.len();
    /// The bytes of the vertices.
    pub(super) const VERTEX_BYTES: usize = 12 * Self::VERTICES;
    /// The bytes of the indices.
    pub(super) const INDEX_BYTES: usize = 2 * Self::INDICES;
    /// The bytes of both.
    pub(super) const BYTES: usize = Self::VERTEX_BYTES + Self::INDEX_BYTES;

    /// For points of a mean spacing.
    pub(super) fn new(spacing: f64) -> Self {
        // Sizes beyond `f32` are clamped: they are invisible anyway.
        let height = (spacing as f32).clamp(f32::MIN_POSITIVE * 8.0, f32::MAX / 8.0);
        Self {
            half: height / 4.0,
            height,
        }
    }

    /// The least and the greatest coordinates.
    pub(super) const fn bounds(&self) -> [[f32; 3]; 2] {
        let Self { half, height } = *self;
        [[-half, 0.0, -half], [half, height, half]]
    }

    /// Vertices, then indices.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let Self { half, height } = *self;
        let vertices = [
            [half, 0.0, half],
            [half, 0.0, -half],
            [-half, 0.0, -half],
            [-half, 0.0, half],
            [0.0, height, 0.0],
        ];
        let vertices = vertices.iter().flatten().flat_map(|v| v.to_le_bytes());
        let indices = TRIANGLES.iter().flatten().flat_map(|i| i.to_le_bytes());
        vertices.chain(indices).collect()
    }
}
