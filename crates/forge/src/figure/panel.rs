//! A panel: a square plot with a caption, in coordinates of its own.

use std::ops::Range;

use strew_core::Pattern;

use super::drawing::{Anchor, Color, Drawing, INK, PALE, Rectangle};
use crate::SettingError;

/// The side of a panel, in pixels.
pub(super) const SIDE: f64 = 360.0;
/// The space around panels.
pub(super) const GAP: f64 = 36.0;
/// The height of a caption above a panel.
const CAPTION: f64 = 34.0;
/// The height of the lines of text below panels.
const LINE: f64 = 20.0;

/// A panel with both coordinates in one range. y points upward.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    left: f64,
    top: f64,
    pub(super) range: Range<f64>,
}

/// A drawing with room for a row of panels and `lines` of text below.
pub(super) fn sheet(panels: usize, lines: usize) -> Drawing {
    let width = GAP + panels as f64 * (SIDE + GAP);
    Drawing::new(width, CAPTION + SIDE + GAP + lines as f64 * LINE)
}

/// Writes a line of text below the panels.
pub(super) fn note(drawing: &mut Drawing, line: usize, text: &str) {
    let y = CAPTION + SIDE + GAP + (line as f64 + 0.2) * LINE;
    drawing.text([GAP, y], 13.0, Anchor::Start, text);
}

impl Panel {
    /// Panel number `i` of a row, with its caption.
    pub(super) fn new(drawing: &mut Drawing, i: usize, range: Range<f64>, caption: &str) -> Self {
        Self::placed(
            drawing,
            [GAP + i as f64 * (SIDE + GAP), CAPTION],
            range,
            caption,
        )
    }

    /// A panel at its upper left corner, with its caption above.
    pub(super) fn placed(
        drawing: &mut Drawing,
        [left, top]: [f64; 2],
        range: Range<f64>,
        caption: &str,
    ) -> Self {
        drawing.text([left, top - 12.0], 14.0, Anchor::Start, caption);
        Self { left, top, range }
    }

    /// Pixels for each unit.
    pub(super) fn scale(&self) -> f64 {
        SIDE / (self.range.end - self.range.start)
    }

    /// A place of the panel, in pixels.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let scale = self.scale();
        [
            self.left + (x - self.range.start) * scale,
            self.top + SIDE - (y - self.range.start) * scale,
        ]
    }

    /// The upper left corner and the size, in pixels, of a rectangle from its lower left corner.
    pub(super) fn rectangle(&self, [x, y]: [f64; 2], [w, h]: [f64; 2]) -> Rectangle {
        let scale = self.scale();
        [self.at([x, y + h]), [w * scale, h * scale]]
    }

    /// Draws the frame, and labels at both ends of both axes.
    pub(super) fn frame(&self, drawing: &mut Drawing, ends: [&str; 2], names: [&str; 2]) {
        drawing.outline([[self.left, self.top], [SIDE; 2]], (INK, 1.0), 0.0);
        let (right, bottom) = (self.left + SIDE, self.top + SIDE);
        drawing.text([self.left, bottom + 16.0], 12.0, Anchor::Middle, ends[0]);
        drawing.text([right, bottom + 16.0], 12.0, Anchor::End, ends[1]);
        let middle = self.left + SIDE / 2.0;
        drawing.text([middle, bottom + 16.0], 12.0, Anchor::Middle, names[0]);
        drawing.text(
            [self.left - 6.0, self.top + 10.0],
            12.0,
            Anchor::End,
            ends[1],
        );
        let middle = self.top + SIDE / 2.0;
        drawing.text([self.left - 6.0, middle], 12.0, Anchor::End, names[1]);
    }

    /// Draws the lines of the grid, and a frame labeled in grid units.
    pub(super) fn grid(&self, drawing: &mut Drawing) {
        let Range { start, end } = self.range;
        let lines = (start as i64..end as i64).flat_map(|v| {
            let v = v as f64 + 0.5;
            let across = [self.at([v, start]), self.at([v, end])];
            [across, [self.at([start, v]), self.at([end, v])]]
        });
        drawing.lines(lines, (PALE, 0.5));
        let low = format!("{}", start.ceil()).replace('-', "−");
        let high = format!("{}", end.floor());
        self.frame(drawing, [&low, &high], ["x", "y"]);
    }
}

/// A drawing of three panels and two lines of text, and its first panel: a window of the grid around the origin, places
/// from −window/2 on. It is refused if points would be too few or too small to see.
pub(super) fn with_grid(window: u32, caption: &str) -> Result<(Drawing, Panel), SettingError> {
    check_window(window)?;
    let mut drawing = sheet(3, 2);
    let first = -f64::from(window / 2);
    let range = first - 0.5..first + f64::from(window) - 0.5;
    let panel = Panel::new(&mut drawing, 0, range, caption);
    panel.grid(&mut drawing);
    Ok((drawing, panel))
}

/// The places of a window.
pub(super) fn places(window: u32) -> Range<i64> {
    let first = -i64::from(window / 2);
    first..first + i64::from(window)
}

/// The points of a window, row by row.
pub(super) fn points(pattern: Pattern, window: u32) -> impl Iterator<Item = (i64, i64)> {
    places(window)
        .flat_map(move |y| places(window).map(move |x| (x, y)))
        .filter(move |&(x, y)| pattern.contains(x, y))
}

/// The diameter of the dots of a window's points, in pixels.
pub(super) fn dot(panel: &Panel) -> f64 {
    (panel.scale() * 0.9).clamp(1.5, 9.0)
}

/// An index, or any length of index space, in turns.
pub(super) fn turns(index: u64) -> f64 {
    index as f64 / 18_446_744_073_709_551_616.0
}

/// The index of a point, in turns.
pub(super) fn index_of(pattern: Pattern, (x, y): (i64, i64)) -> [f64; 2] {
    let (dx, dy) = pattern.index(x, y);
    [turns(dx), turns(dy)]
}

/// Draws the frame of the set region.
pub(super) fn set_region(drawing: &mut Drawing, panel: &Panel) {
    panel.frame(drawing, ["0", "t"], ["dX", "dY"]);
}

/// A color between white and another.
pub(super) fn tint(color: Color, share: f64) -> Color {
    color.map(|v| (255.0 + (f64::from(v) - 255.0) * share) as u8)
}

/// The sides of windows that show single points, in grid units.
const WINDOWS: std::ops::RangeInclusive<u32> = 8..=200;

/// Refuses a window whose points would be too few or too small to see.
pub(super) fn check_window(window: u32) -> Result<(), SettingError> {
    if WINDOWS.contains(&window) {
        return Ok(());
    }
    let (least, most) = (WINDOWS.start(), WINDOWS.end());
    let allowed = format!("an integer from {least} to {most} grid units");
    Err(SettingError::new("window", window, allowed))
}
