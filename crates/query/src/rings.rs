//! Polygons as their rings: an exterior that bounds, and holes that remove (RFC 7946, 3.1.6).

use strew_core::Polygon;

/// The rings of a polygon: the outer one, then holes.
pub type Rings = Vec<Vec<[f64; 2]>>;

/// Polygons, each with the polygons of its holes. Those that are empty or lie on one line have no points and are left
/// out.
pub(super) fn surfaces(polygons: &[Rings]) -> Result<Vec<(Polygon, Vec<Polygon>)>, String> {
    // Two different positions in all.
    let is_flat = |ring: &[[f64; 2]]| match ring {
        [] => true,
        [first, .., _] if ring.len() > 2 => {
            let second = ring.iter().find(|p| *p != first).unwrap_or(first);
            ring.iter().all(|p| p == first || p == second)
        }
        _ => false,
    };
    let is_empty = |rings: &Rings| rings.first().is_none_or(Vec::is_empty);
    if polygons.iter().all(is_empty) {
        return Err("there is no polygon, or empty ones alone".into());
    }
    let kept = polygons.iter().enumerate();
    let kept = kept.filter(|(_, rings)| rings.first().is_some_and(|ring| !is_flat(ring)));
    let read = |(i, rings): (usize, &Rings)| {
        let rings: Vec<_> = rings.iter().filter(|ring| !is_flat(ring)).collect();
        Polygon::with_holes(&rings).map_err(|error| match polygons.len() {
            1 => error.to_string(),
            _ => format!("polygon {i}: {error}"),
        })
    };
    kept.map(read).collect()
}
