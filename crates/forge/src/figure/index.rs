//! The figure of index space: the pattern, the index torus, and the set region.

use strew_core::{Alpha, Pattern};

use super::{
    Drawing, FigureError,
    drawing::{Color, GRAY, INK},
    panel::{Panel, dot, index_of, note, places, points, set_region, with_grid},
};

/// The colors at the corners of the set region: (0, 0), (t, 0), (0, t), (t, t).
const CORNERS: [Color; 4] = [[28, 78, 157], [214, 62, 82], [34, 160, 107], [238, 182, 52]];

/// The color of a place in the set region, from 0 to 1 along both axes.
fn shade([x, y]: [f64; 2]) -> Color {
    let weights = [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y];
    [0, 1, 2].map(|channel| {
        let parts = CORNERS.iter().zip(weights);
        parts
            .map(|(color, weight)| f64::from(color[channel]) * weight)
            .sum::<f64>() as u8
    })
}

/// Draws a window of `window` × `window` grid places of AA(α), 8 to 200; the indices of these places on the
/// torus; and the set region, enlarged. Points have the color of their place in the set region.
///
/// # Errors
/// [`FigureError`] if the window is out of range.
pub fn index(alpha: Alpha, window: u32) -> Result<Drawing, FigureError> {
    let (pattern, t) = (Pattern::new(alpha), alpha.set_side_f64());
    let place = |(x, y): (i64, i64)| [x as f64, y as f64];
    let caption = format!("The pattern AA(α), α = {alpha}");
    let (mut drawing, grid) = with_grid(window, &caption)?;
    let torus = Panel::new(&mut drawing, 1, 0.0..1.0, "The index of every grid point");
    torus.frame(&mut drawing, ["0", "1"], ["dX = {(αx + y)/2}", "dY"]);
    let region = Panel::new(&mut drawing, 2, 0.0..t, "The set region");
    set_region(&mut drawing, &region);
    let rest = places(window)
        .flat_map(|y| places(window).map(move |x| (x, y)))
        .filter(|&(x, y)| !pattern.contains(x, y));
    let rest = rest.map(|p| torus.at(index_of(pattern, p)));
    drawing.dots(rest, 1.4, GRAY);
    drawing.outline(torus.rectangle([0.0; 2], [t; 2]), (INK, 1.5), 0.0);
    for p in points(pattern, window) {
        let at = index_of(pattern, p);
        let color = shade(at.map(|v| v / t));
        drawing.dots([grid.at(place(p))], dot(&grid), color);
        drawing.dots([torus.at(at)], 2.4, color);
        drawing.dots([region.at(at)], 5.0, color);
    }
    let share = format!(
        "A grid point (x, y) belongs to the pattern if its index lies in the set region [0, t)², \
         t = (α − 1)/2 = {t:.6}."
    );
    note(&mut drawing, 0, &share);
    let density = format!(
        "So a share t² = {:.6} of the grid points belong to it, and their mean spacing is 1/t = {:.4} grid units.",
        t * t,
        1.0 / t
    );
    note(&mut drawing, 1, &density);
    Ok(drawing)
}
