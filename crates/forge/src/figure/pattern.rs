//! The figures of a pattern: index space, an arrangement with its image and margin, and a neighborhood map.

use strew_core::{Alpha, Map, Pattern, map::MAX_RADIUS, pattern::Arrangement};

use super::{
    Drawing, FigureError,
    drawing::{Anchor, COLORS, Color, GRAY, INK, Mark},
    panel::{
        Panel, dot, index_of, note, places, points, set_region, sheet, tint, turns, with_grid,
    },
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

/// Draws a window of `window` × `window` grid places of AA(α), 8 to 200, with the occurrences of an
/// arrangement; the image of its offsets in index space; and its margin in the set region.
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

/// The color of every other block.
const DARK: Color = [203, 214, 226];

/// Draws the blocks of the map of half-width `radius`, 1 to 200, over those of half that width; the neighbors of
/// the points of one block, given as its intervals of dX and dY; and the number of intervals against R.
pub fn map(alpha: Alpha, radius: u32, block: [usize; 2]) -> Result<Drawing, FigureError> {
    if !(1..=200).contains(&radius) {
        let allowed = "an integer from 1 to 200 grid units";
        return Err(FigureError::new("radius", radius, allowed));
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
        let allowed = format!("two integers from 0 to {}", n - 1);
        return Err(FigureError::new("block", format!("{block:?}"), allowed));
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
    let ring = (0..=32).map(|i| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 32.0).sin_cos();
        [middle[0] + 9.0 * cos, middle[1] + 9.0 * sin]
    });
    drawing.curve(ring, (COLORS[1], 1.5));
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
