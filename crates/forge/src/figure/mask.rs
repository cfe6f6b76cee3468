//! The figure of a mask's spectrum: radial power at three levels.

use super::{
    Drawing,
    drawing::{Anchor, COLORS, GRAY},
    panel::{Panel, note, sheet, tint},
};
use crate::mask::{LevelSpectrum, Mask};

/// The levels that are drawn.
const LEVELS: [(f64, &str); 3] = [(0.125, "1/8"), (0.25, "1/4"), (0.5, "1/2")];
/// The greatest power that is drawn.
const MOST: f64 = 4.0;

/// Draws the radial power of the pixels of a mask that are on at levels of 1/8, 1/4 and 1/2. Pixels in a random order
/// have a power of 1, the gray line.
#[must_use]
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
