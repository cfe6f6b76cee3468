//! The figure of an arrangement: where it occurs, its image, and its margin.

use strew_core::{Alpha, Pattern, pattern::Arrangement};

use super::{
    Drawing, FigureError,
    drawing::{COLORS, GRAY},
    panel::{Panel, dot, index_of, note, places, points, set_region, tint, turns, with_grid},
};

/// Draws a window of `window` × `window` grid places of AA(α), 8 to 200, with the occurrences of an
/// arrangement; the image of its offsets in index space; and its margin in the set region.
///
/// # Errors
/// [`FigureError`] if the window is out of range, or the offsets are as [`Arrangement::new`] refuses them.
pub fn arrangement(
    alpha: Alpha,
    offsets: &[(i64, i64)],
    window: u32,
) -> Result<Drawing, FigureError> {
    let pattern = Pattern::new(alpha);
    let found = Arrangement::new(pattern, offsets)?;
    let t = alpha.set_side_f64();
    let caption = format!("Occurrences in AA(α), α = {alpha}");
    let (mut drawing, grid) = with_grid(window, &caption)?;
    let place = |(x, y): (i64, i64)| grid.at([x as f64, y as f64]);
    drawing.dots(
        points(pattern, window).map(place),
        dot(&grid),
        tint(GRAY, 0.6),
    );
    let range = places(window);
    let is_shown = |(x, y): (i64, i64)| {
        offsets
            .iter()
            .all(|(i, j)| range.contains(&(x + i)) && range.contains(&(y + j)))
    };
    let count = found.count(range.clone(), range.clone());
    let occurrences: Vec<_> = found.occurrences(range.clone(), range.clone()).collect();
    let shown = || occurrences.iter().copied().filter(|&p| is_shown(p));
    let links = shown().flat_map(|(x, y)| {
        let ends = offsets.iter().map(move |(i, j)| (x + i, y + j));
        ends.map(move |end| [place((x, y)), place(end)])
    });
    drawing.lines(links, (COLORS[0], 1.5));
    let others = shown().flat_map(|(x, y)| offsets.iter().map(move |(i, j)| (x + i, y + j)));
    drawing.dots(others.map(place), dot(&grid), COLORS[0]);
    drawing.dots(shown().map(place), dot(&grid), COLORS[1]);

    // Index space around 0: shifts with a sign, and the set region for comparison.
    let signed = |v: i64| v as f64 / 18_446_744_073_709_551_616.0;
    let around = Panel::new(&mut drawing, 1, -0.5..0.5, "The image of the offsets");
    around.frame(&mut drawing, ["−½", "½"], ["shift of dX", "dY"]);
    let image = found.image();
    let low = [0, 1].map(|i: usize| signed(*image[i].start()));
    let high = [0, 1].map(|i: usize| signed(*image[i].end()));
    let size = [0, 1].map(|i: usize| high[i] - low[i]);
    drawing.outline(around.rectangle(low, [t; 2]), (GRAY, 1.0), 4.0);
    let own = around.rectangle(low, size);
    drawing.fill(own, COLORS[0], 0.25);
    drawing.outline(own, (COLORS[0], 1.0), 0.0);
    let shifts: Vec<[f64; 2]> = found.shifts().map(|s| around.at(s.map(signed))).collect();
    drawing.lines(
        shifts.iter().map(|&s| [around.at([0.0; 2]), s]),
        (GRAY, 0.8),
    );
    drawing.dots(shifts, 7.0, COLORS[0]);
    drawing.dots([around.at([0.0; 2])], 7.0, COLORS[1]);

    let region = Panel::new(&mut drawing, 2, 0.0..t, "The margin in the set region");
    let at_index = |p: (i64, i64)| region.at(index_of(pattern, p));
    drawing.dots(points(pattern, window).map(at_index), 2.5, tint(GRAY, 0.7));
    if let Some([x, y]) = found.margin() {
        let [from, to] = [[x.start, y.start], [x.end, y.end]].map(|p| p.map(turns));
        let margin = region.rectangle(from, [to[0] - from[0], to[1] - from[1]]);
        drawing.fill(margin, COLORS[1], 0.2);
        drawing.outline(margin, (COLORS[1], 1.5), 0.0);
        drawing.dots(occurrences.iter().map(|&p| at_index(p)), 4.0, COLORS[1]);
        // The image at the two ends of its freedom.
        for end in [from, to] {
            let corner = [0, 1].map(|i: usize| end[i] + low[i]);
            drawing.outline(region.rectangle(corner, size), (COLORS[0], 1.0), 4.0);
        }
    }
    set_region(&mut drawing, &region);
    let image = format!(
        "The image measures {:.6} × {:.6}, the set region {t:.6} × {t:.6}.",
        size[0], size[1]
    );
    note(&mut drawing, 0, &image);
    let outcome = match found.margin() {
        Some([x, y]) => format!(
            "It occurs, at {:.4} % of the points: the margin left is {:.6} × {:.6}, {:.3e} of the grid points. \
             {count} of these places lie in the window.",
            100.0 * found.frequency(),
            turns(x.end - x.start),
            turns(y.end - y.start),
            found.density(),
        ),
        None => "It never occurs: the image does not fit the set region.".into(),
    };
    note(&mut drawing, 1, &outcome);
    Ok(drawing)
}
