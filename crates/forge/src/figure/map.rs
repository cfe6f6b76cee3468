//! The figure of a neighborhood map: blocks, their refinement, a neighborhood, and the growth with R.

use strew_core::{Alpha, Map, map::MAX_RADIUS};

use super::{
    Drawing, FigureError,
    drawing::{Anchor, COLORS, Color, GRAY, Mark},
    panel::{Panel, note, set_region, sheet, tint, turns},
};

/// The color of every other block.
const DARK: Color = [203, 214, 226];

/// Draws the blocks of the map of half-width `radius`, 1 to 200, over those of half that width; the neighbors of
/// the points of one block, given as its intervals of dX and dY; and the number of intervals against R.
///
/// # Errors
/// [`FigureError`] if `radius` is out of range, or the map has no such block.
pub fn map(alpha: Alpha, radius: u32, block: [usize; 2]) -> Result<Drawing, FigureError> {
    if !(1..=200).contains(&radius) {
        return Err(FigureError::new(
            "radius",
            radius,
            "an integer from 1 to 200 grid units",
        ));
    }
    let (fine, coarse) = (Map::new(alpha, radius)?, Map::new(alpha, radius / 2)?);
    // Intervals that only the rounding of a fraction α makes are too narrow to see or to hold points.
    let visible = |map: &Map| -> Vec<usize> {
        let length = |i: &usize| map.interval(*i).end - map.interval(*i).start;
        (0..map.intervals())
            .filter(|i| length(i) > 1 << 24)
            .collect()
    };
    let (intervals, parents) = (visible(&fine), visible(&coarse));
    let n = intervals.len();
    if block.iter().any(|&i| i >= n) {
        return Err(FigureError::new(
            "block",
            format!("{block:?}"),
            format!("two integers from 0 to {}", n - 1),
        ));
    }
    let t = alpha.set_side_f64();
    let mut drawing = sheet(3, 2);
    let caption = format!("{n} × {n} blocks of R = {radius}, α = {alpha}");
    let region = Panel::new(&mut drawing, 0, 0.0..t, &caption);
    let stripes = intervals.iter().skip(1).step_by(2).flat_map(|&i| {
        let interval = fine.interval(i);
        let (start, length) = (turns(interval.start), turns(interval.end - interval.start));
        [
            region.rectangle([start, 0.0], [length, t]),
            region.rectangle([0.0, start], [t, length]),
        ]
    });
    let stripes = Mark::Checkers(stripes.collect(), DARK);
    drawing.marks.push(stripes);
    let bounds = parents.iter().skip(1).flat_map(|&i| {
        let v = turns(coarse.interval(i).start);
        let down = [region.at([v, 0.0]), region.at([v, t])];
        [down, [region.at([0.0, v]), region.at([t, v])]]
    });
    drawing.lines(bounds, (COLORS[0], 1.0));
    let own = block.map(|i| intervals[i]);
    let sides = own.map(|i| fine.interval(i));
    let low = [0, 1].map(|i: usize| turns(sides[i].start));
    let size = [0, 1].map(|i: usize| turns(sides[i].end - sides[i].start));
    let [corner, size] = region.rectangle(low, size);
    drawing.fill([corner, size], COLORS[1], 1.0);
    let middle = [0, 1].map(|axis: usize| corner[axis] + size[axis] / 2.0);
    let ring = Mark::Ring(middle, 9.0, (COLORS[1], 1.5));
    drawing.marks.push(ring);
    set_region(&mut drawing, &region);

    let reach = f64::from(radius);
    let caption = format!("The neighbors of block {}, {}", block[0], block[1]);
    let around = Panel::new(&mut drawing, 1, -reach - 0.5..reach + 0.5, &caption);
    if radius <= 100 {
        around.grid(&mut drawing);
    } else {
        let ends = [format!("−{radius}"), radius.to_string()];
        around.frame(&mut drawing, [&ends[0], &ends[1]], ["x", "y"]);
    }
    let inner = i64::from(radius / 2);
    let (near, far): (Vec<_>, Vec<_>) = fine
        .neighbors(own)
        .into_iter()
        .partition(|(x, y)| x.abs().max(y.abs()) <= inner);
    let diameter = (around.scale() * 0.9).clamp(1.5, 9.0);
    let place = |(x, y): (i64, i64)| around.at([x as f64, y as f64]);
    drawing.dots(far.into_iter().map(place), diameter, tint(GRAY, 0.8));
    drawing.dots(near.into_iter().map(place), diameter, COLORS[0]);
    let half = inner as f64 + 0.5;
    let inside = around.rectangle([-half; 2], [2.0 * half; 2]);
    drawing.outline(inside, (COLORS[0], 1.0), 4.0);
    drawing.dots([around.at([0.0; 2])], diameter * 1.2, COLORS[1]);

    growth(&mut drawing, alpha);
    let text = format!(
        "Points whose index lies in one block have the same neighbors up to {radius} grid units along both axes. \
         Blue lines: the {} × {} blocks of R = {}, which the others refine.",
        parents.len(),
        parents.len(),
        radius / 2,
    );
    note(&mut drawing, 0, &text);
    let rings = f64::from(radius) * t;
    let text = format!(
        "R = {radius} is {rings:.1} mean spacings. A displacement table has one vector for each block, {}.",
        n * n
    );
    note(&mut drawing, 1, &text);
    Ok(drawing)
}

/// Draws the number of intervals against R, up to the largest map, with the line 2(α − 1)·(R + 1).
fn growth(drawing: &mut Drawing, alpha: Alpha) {
    let panel = Panel::new(drawing, 2, 0.0..1.0, "Intervals per axis against R");
    // In range by its definition.
    let counts = Map::interval_counts(alpha, MAX_RADIUS).unwrap_or_default();
    let slope = 4.0 * alpha.set_side_f64();
    let most = slope * f64::from(MAX_RADIUS + 1);
    let at = |radius: f64, count: f64| panel.at([radius / f64::from(MAX_RADIUS), count / most]);
    let law = [at(0.0, slope), at(f64::from(MAX_RADIUS), most)];
    drawing.curve(law, (tint(GRAY, 0.8), 4.0));
    let measured = counts.iter().enumerate();
    let measured = measured.map(|(r, &n)| at(r as f64, n as f64));
    drawing.curve(measured, (COLORS[1], 1.4));
    panel.frame(drawing, ["0", ""], ["R", "n"]);
    drawing.text(
        panel.at([1.0, -0.045]),
        12.0,
        Anchor::End,
        &MAX_RADIUS.to_string(),
    );
    drawing.text(
        panel.at([0.02, 0.95]),
        12.0,
        Anchor::Start,
        &format!("{most:.0} at the top"),
    );
    let law = format!("gray: 2(α − 1)(R + 1) = {slope:.4} (R + 1)");
    drawing.text(panel.at([0.98, 0.06]), 12.0, Anchor::End, &law);
}
