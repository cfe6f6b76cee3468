//! The figure of clusters: their shapes in the plane and in the set region.

use strew_core::{
    Alpha, Pattern,
    map::{Clusters, Shape},
};

use super::{
    Drawing, FigureError,
    drawing::{Anchor, COLORS, Color, GRAY},
    panel::{Panel, check_window, dot, note, points, set_region, tint, turns, with_grid},
};

/// The color of points in clusters that are too large to be distinguished.
const LARGER: Color = [190, 190, 190];

/// The number of shapes that the legend has room for.
const LEGEND: usize = 12;

/// Draws the clusters of points that are at most `distance` grid units from a neighbor, up to `most` points, in
/// a window of `window` × `window` grid places of AA(α), 8 to 200; and the set region, where each shape has
/// its blocks. Shapes that are symmetric to each other share a color.
pub fn clusters(
    alpha: Alpha,
    distance: f64,
    most: usize,
    window: u32,
) -> Result<Drawing, FigureError> {
    check_window(window)?;
    found_clusters(&Clusters::new(alpha, distance, most)?, distance, window)
}

/// [`clusters`] that were searched already, with the same `distance`.
pub fn found_clusters(
    found: &Clusters,
    distance: f64,
    window: u32,
) -> Result<Drawing, FigureError> {
    let (map, most) = (found.map(), found.most());
    let alpha = map.alpha();
    let t = alpha.set_side_f64();
    let color = |shape: Option<usize>| {
        shape.map_or(LARGER, |shape| of_class(found.shapes()[shape].class()))
    };
    let caption = format!("Clusters of AA(α), α = {alpha}");
    let (mut drawing, grid) = with_grid(window, &caption)?;
    let pattern = Pattern::new(alpha);
    let place = |(x, y): (i64, i64)| grid.at([x as f64, y as f64]);
    let shape_at = |(x, y): (i64, i64)| {
        let (dx, dy) = pattern.index(x, y);
        found.shape_of([map.interval_of(dx)?, map.interval_of(dy)?])
    };
    let all: Vec<_> = points(pattern, window).collect();
    let limit = distance * distance * (1.0 + 1e-12);
    for (i, &a) in all.iter().enumerate() {
        let near = |b: &&(i64, i64)| ((b.0 - a.0).pow(2) + (b.1 - a.1).pow(2)) as f64 <= limit;
        // Points come row by row, so those farther down the list are soon too far away.
        let later = all[i + 1..]
            .iter()
            .take_while(|b| (b.1 - a.1) as f64 <= distance);
        let links: Vec<_> = later.filter(near).map(|&b| [place(a), place(b)]).collect();
        drawing.lines(links, (tint(color(shape_at(a)), 0.7), 1.4));
    }
    for &p in &all {
        drawing.dots([place(p)], dot(&grid), color(shape_at(p)));
    }

    let region = Panel::new(&mut drawing, 1, 0.0..t, "Shapes in the set region");
    let n = map.intervals();
    let bound = |i: usize| {
        turns(if i < n {
            map.interval(i).start
        } else {
            alpha.set_side()
        })
    };
    let colors =
        |y: usize| -> Vec<Color> { (0..n).map(|x| color(found.shape_of([x, y]))).collect() };
    let mut y = 0;
    while y < n {
        let row = colors(y);
        let next = (y + 1..n).find(|&above| colors(above) != row).unwrap_or(n);
        let mut x = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let (from, to) = ([bound(x), bound(y)], [bound(x + run.len()), bound(next)]);
            drawing.fill(
                region.rectangle(from, [to[0] - from[0], to[1] - from[1]]),
                run[0],
                1.0,
            );
            x += run.len();
        }
        y = next;
    }
    set_region(&mut drawing, &region);
    legend(&mut drawing, found);
    let seen = visible(found);
    let text = format!(
        "Points at most {distance:.4} grid units apart are joined. Exact up to {most} points: {} shapes, {} up to \
         symmetry, told apart by what is within {} grid units.",
        seen.iter().map(|class| class.len()).sum::<usize>(),
        seen.len(),
        map.radius(),
    );
    note(&mut drawing, 0, &text);
    let larger = format!(
        "{:.4} % of the points are in larger clusters (gray).",
        100.0 * found.larger_share()
    );
    note(&mut drawing, 1, &larger);
    Ok(drawing)
}

/// The color of a class. Later rounds of the palette are paler.
fn of_class(class: usize) -> Color {
    let round = (class / COLORS.len()) as f64;
    tint(COLORS[class % COLORS.len()], 1.0 / (1.0 + 0.5 * round))
}

/// The shapes by class, without those that only the rounding of a fraction α makes. They have less than one
/// point in 10¹².
fn visible(found: &Clusters) -> Vec<&[Shape]> {
    let classes = found.shapes().chunk_by(|a, b| a.class() == b.class());
    classes
        .filter(|class| class[0].share_of_points() > 1e-12)
        .collect()
}

/// Draws one shape of each class with the share of points that the class has.
fn legend(drawing: &mut Drawing, found: &Clusters) {
    let panel = Panel::new(
        drawing,
        2,
        0.0..12.0,
        "Shapes up to symmetry, and their shares of the points",
    );
    let classes = visible(found);
    for (i, class) in classes.iter().enumerate() {
        if i == LEGEND {
            let rest = format!("and {} more", classes.len() - LEGEND);
            drawing.text(panel.at([0.0, -0.4]), 12.0, Anchor::Start, &rest);
            break;
        }
        let cell = [(i % 3) as f64 * 4.0, 9.0 - (i / 3) as f64 * 3.0];
        let points = class[0].points();
        let extent = |v: fn(&(i64, i64)) -> i64| {
            let all = points.iter().map(v);
            let (low, high) = (all.clone().min().unwrap_or(0), all.max().unwrap_or(0));
            ((low + high) as f64 / 2.0, (high - low) as f64)
        };
        let ((cx, w), (cy, h)) = (extent(|p| p.0), extent(|p| p.1));
        let scale = (1.9 / w.max(h).max(1.0)).min(0.22);
        let at = |&(x, y): &(i64, i64)| {
            panel.at([
                cell[0] + 1.2 + (x as f64 - cx) * scale,
                cell[1] + 1.5 + (y as f64 - cy) * scale,
            ])
        };
        let diameter = (scale * panel.scale() * 0.9).clamp(1.5, 6.0);
        drawing.dots(points.iter().map(at), diameter, of_class(class[0].class()));
        let share: f64 = class.iter().map(|shape| shape.share_of_points()).sum();
        let lines = [
            format!(
                "{} point{}",
                points.len(),
                if points.len() == 1 { "" } else { "s" }
            ),
            format!("{:.3} %", 100.0 * share),
            format!("{} turned", class.len()),
        ];
        for (line, text) in lines.iter().enumerate() {
            if line < 2 || class.len() > 1 {
                let place = panel.at([cell[0] + 2.4, cell[1] + 1.8 - 0.5 * line as f64]);
                drawing.text(place, 11.0, Anchor::Start, text);
            }
        }
    }
    if classes.is_empty() {
        drawing.dots([panel.at([1.2, 10.5])], 6.0, GRAY);
        drawing.text(
            panel.at([2.4, 10.4]),
            12.0,
            Anchor::Start,
            "all clusters are larger",
        );
    }
}
