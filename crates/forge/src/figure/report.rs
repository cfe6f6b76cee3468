//! The figures of what is measured: a point set with its spectrum, radial power, anisotropy, RDF and named figures, and the
//! radial power of a mask.

use std::ops::Range;

use super::{
    Drawing,
    drawing::{Anchor, COLORS, GRAY, INK, PALE},
    panel::{GAP, Panel, SIDE, note, sheet, tint},
};
use crate::{
    Report, Target,
    mask::{LevelSpectrum, Mask},
};

/// The side of the panel of points, in mean spacings.
const POINTS_SIDE: f64 = 32.0;
/// The largest ν along an axis of the panel of the 2-D spectrum.
const SPECTRUM_END: f64 = 2.5;
/// The number of cells along an axis of that panel.
const SPECTRUM_CELLS: i64 = 100;
/// The power that is drawn white.
const WHITE_POWER: f64 = 2.5;
/// The number of shades of gray. More would only store noise.
const SHADES: f64 = 32.0;
/// The most numbers along an axis.
const TICKS: f64 = 6.0;

/// The height of the title, and that of a row of panels with the captions.
const TITLE: f64 = 44.0;
const ROW: f64 = SIDE + 70.0;

/// Draws a report under a title. If there is a power curve that the points should follow, `target`, it is drawn over
/// their own.
pub fn report(report: &Report, title: &str, target: Option<&Target>) -> Drawing {
    let mut drawing = Drawing::new(GAP + 3.0 * (SIDE + GAP), TITLE + 2.0 * ROW);
    let middle = drawing.width / 2.0;
    drawing.text([middle, 28.0], 20.0, Anchor::Middle, title);

    let points = square(
        &mut drawing,
        0,
        0.0..POINTS_SIDE,
        "points (in mean spacings)",
    );
    let inside = |p: &[f64; 2]| p.iter().all(|v| points.range.contains(v));
    let inside = report.points.iter().copied().filter(inside);
    drawing.dots(inside.map(|p| points.at(p)), 4.0, INK);

    let end = SPECTRUM_END.min(report.spectrum.nu_max());
    let spectrum = square(&mut drawing, 1, -end..end, "power spectrum");
    let plane = spectrum.rectangle([-end; 2], [2.0 * end; 2]);
    drawing.cells(plane, SPECTRUM_CELLS as usize, shades(report, end));

    let rings = || report.rings.iter();
    let power: Vec<_> = rings().map(|ring| [ring.nu, ring.power]).collect();
    let wanted = |target: &Target| rings().map(|ring| [ring.nu, target.at(ring.nu)]).collect();
    let wanted: Vec<_> = target.map_or_else(Vec::new, wanted);
    let caption = match target {
        Some(_) => "radial power over frequency (orange: the target)",
        None => "radial power over frequency",
    };
    curves(&mut drawing, 2, caption, [&power, &wanted], [0.0, 2.0]);
    let anisotropy = rings().skip(4);
    let anisotropy = anisotropy.map(|ring| [ring.nu, ring.anisotropy_db.max(-20.0)]);
    let anisotropy: Vec<_> = anisotropy.collect();
    let caption = "anisotropy (dB) over frequency";
    curves(&mut drawing, 3, caption, [&anisotropy, &[]], [-5.0, 5.0]);
    let caption = "RDF over distance (in mean spacings)";
    curves(
        &mut drawing,
        4,
        caption,
        [&report.rdf.bins, &[]],
        [0.0, 2.0],
    );

    let figures = Panel::placed(&mut drawing, place(5), 0.0..1.0, "figures");
    let all = report.figures.values.iter();
    let all = all.map(|(name, value)| format!("{name} = {value}"));
    let count = format!("{} points", report.figures.points);
    for (line, text) in std::iter::once(count).chain(all).enumerate() {
        let at = figures.at([0.0, 0.96 - 0.06 * line as f64]);
        drawing.text(at, 14.0, Anchor::Start, &text);
    }
    drawing
}

/// The upper left corner of panel number `i`, of three in a row.
fn place(i: usize) -> [f64; 2] {
    let [column, row] = [i % 3, i / 3].map(|v| v as f64);
    [GAP + column * (SIDE + GAP), TITLE + 34.0 + row * ROW]
}

/// A panel with both coordinates in one range.
fn square(drawing: &mut Drawing, i: usize, range: Range<f64>, caption: &str) -> Panel {
    let panel = Panel::placed(drawing, place(i), range.clone(), caption);
    for (at, text) in ticks(&range) {
        numbers(drawing, &panel, [at, range.start], [&text, ""]);
        numbers(drawing, &panel, [range.start, at], ["", &text]);
    }
    panel.frame(drawing, [""; 2], [""; 2]);
    panel
}

/// A panel with curves. The vertical axis shows at least `least`.
fn curves(
    drawing: &mut Drawing,
    i: usize,
    caption: &str,
    curves: [&[[f64; 2]]; 2],
    least: [f64; 2],
) {
    let values = || curves.iter().copied().flatten();
    let end = values().map(|v| v[0]).fold(f64::MIN_POSITIVE, f64::max);
    let low = values().map(|v| v[1]).fold(least[0], f64::min);
    let high = values().map(|v| v[1] * 1.05).fold(least[1], f64::max);
    let panel = Panel::placed(drawing, place(i), 0.0..1.0, caption);
    let at = |[x, y]: [f64; 2]| panel.at([x / end, (y - low) / (high - low)]);
    for (x, text) in ticks(&(0.0..end)) {
        drawing.lines([[at([x, low]), at([x, high])]], (PALE, 1.0));
        numbers(drawing, &panel, [x / end, 0.0], [&text, ""]);
    }
    for (y, text) in ticks(&(low..high)) {
        let ends = [at([0.0, y]), at([end, y])];
        drawing.lines([ends], (if y == 0.0 { GRAY } else { PALE }, 1.0));
        numbers(
            drawing,
            &panel,
            [0.0, (y - low) / (high - low)],
            ["", &text],
        );
    }
    for (curve, color) in curves.iter().zip(COLORS) {
        drawing.curve(curve.iter().map(|&v| at(v)), (color, 1.2));
    }
    panel.frame(drawing, [""; 2], [""; 2]);
}

/// Writes a number below and one to the left of a place of a panel.
fn numbers(drawing: &mut Drawing, panel: &Panel, at: [f64; 2], [below, left]: [&str; 2]) {
    let [x, y] = panel.at(at);
    drawing.text([x, y + 16.0], 11.0, Anchor::Middle, below);
    drawing.text([x - 5.0, y + 4.0], 11.0, Anchor::End, left);
}

/// Round numbers of a range, some [`TICKS`], with their texts.
fn ticks(range: &Range<f64>) -> Vec<(f64, String)> {
    let width = (range.end - range.start) / TICKS;
    let power = 10f64.powf(width.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|v| v * power);
    let step = step
        .into_iter()
        .find(|&step| step >= width)
        .unwrap_or(width);
    let numbers = (range.start / step).ceil() as i64..=(range.end / step).floor() as i64;
    let digits = (-step.log10().floor()).max(0.0) as usize;
    let text = |v: f64| format!("{v:.digits$}").replace('-', "−");
    let numbers = numbers.map(|k| k as f64 * step);
    numbers.map(|v| (v, text(v))).collect()
}

/// The mean power in each cell of the frequency plane, as a gray value; rows from the top.
fn shades(report: &Report, end: f64) -> Vec<u8> {
    let modes = (report.points.len() as f64).sqrt();
    let edge = |i: i64| (2.0 * i as f64 / SPECTRUM_CELLS as f64 - 1.0) * end;
    let span = |i: i64| (edge(i) * modes).ceil() as i64..(edge(i + 1) * modes).ceil() as i64;
    let mut cells = Vec::new();
    for row in (0..SPECTRUM_CELLS).rev() {
        for column in 0..SPECTRUM_CELLS {
            let (mut sum, mut count) = (0.0, 0u32);
            for ky in span(row) {
                for kx in span(column).filter(|&kx| (kx, ky) != (0, 0)) {
                    if let Some(power) = report.spectrum.at(kx, ky) {
                        sum += power;
                        count += 1;
                    }
                }
            }
            let part = (sum / f64::from(count.max(1)) / WHITE_POWER).min(1.0);
            cells.push(((part * (SHADES - 1.0)).round() * (255.0 / (SHADES - 1.0))) as u8);
        }
    }
    cells
}

/// The levels that are drawn.
const LEVELS: [(f64, &str); 3] = [(0.125, "1/8"), (0.25, "1/4"), (0.5, "1/2")];
/// The greatest power that is drawn.
const MOST: f64 = 4.0;

/// Draws the radial power of the pixels of a mask that are on at levels of 1/8, 1/4 and 1/2. Pixels in a random order
/// have a power of 1, the gray line.
pub fn mask_spectrum(mask: &Mask) -> Drawing {
    let mut drawing = sheet(LEVELS.len(), 2);
    for (i, (level, name)) in LEVELS.into_iter().enumerate() {
        let spectrum = mask.spectrum(level);
        let panel = Panel::new(&mut drawing, i, 0.0..1.0, &format!("Level {name}"));
        let at = |ring: f64, power: f64| {
            let x = ring / spectrum.rings.len() as f64;
            panel.at([x, (power / MOST).min(1.0)])
        };
        let random = [at(0.0, 1.0), at(spectrum.rings.len() as f64, 1.0)];
        drawing.curve(random, (tint(GRAY, 0.6), 1.0));
        let rings = spectrum.rings.iter().enumerate();
        let curve = rings.map(|(ring, &power)| at(ring as f64 + 0.5, power));
        drawing.curve(curve, (COLORS[0], 1.6));
        panel.frame(&mut drawing, ["0", ""], ["ν", ""]);
        drawing.text(panel.at([1.0, -0.045]), 12.0, Anchor::End, "2");
        let low = format!("low power {:.4}", spectrum.low_power);
        drawing.text(panel.at([0.98, 0.94]), 12.0, Anchor::End, &low);
        let peak = format!("tallest peak {:.0}", spectrum.peak);
        drawing.text(panel.at([0.98, 0.89]), 12.0, Anchor::End, &peak);
    }
    let text = format!(
        "Radial power of the pixels that are on, 0 to {MOST}, over ν, the frequency in units of √N. Gray: a random order."
    );
    note(&mut drawing, 0, &text);
    let size = mask.size();
    let text = format!(
        "A mask of {size} × {size} pixels. Low power is the mean over 0 < ν < 0.5, in rings of {}.",
        LevelSpectrum::RING
    );
    note(&mut drawing, 1, &text);
    drawing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_along_axes_are_round() {
        let texts = |range| -> Vec<String> { ticks(&range).into_iter().map(|t| t.1).collect() };
        assert_eq!(texts(-5.0..5.0), ["−4", "−2", "0", "2", "4"]);
        assert_eq!(texts(0.0..4.0), ["0", "1", "2", "3", "4"]);
        assert_eq!(texts(0.0..0.9), ["0.0", "0.2", "0.4", "0.6", "0.8"]);
    }
}
