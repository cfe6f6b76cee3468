//! How the colors of a pixel become one number.

use std::sync::LazyLock;

/// The meaning of the numbers in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// A mask or a measurement: a single channel is taken as it is. Colors are taken as light, because
    /// there is no other sensible number. Transparency lets nothing through: it multiplies.
    Data,
    /// A picture: all channels are coded as sRGB and become linear light; what is transparent lies on
    /// white paper.
    Picture,
}

/// The channels of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Channels {
    /// Whether there are three colors instead of one gray.
    pub(super) has_colors: bool,
    /// Whether there is an alpha channel after them.
    pub(super) has_alpha: bool,
}

impl Channels {
    pub(super) const fn count(self) -> usize {
        (if self.has_colors { 3 } else { 1 }) + self.has_alpha as usize
    }

    /// Whether numbers are taken as they are.
    pub(super) fn are_plain(self, meaning: Meaning) -> bool {
        meaning == Meaning::Data && !self.has_colors
    }
}

/// Luminance has the weights of Rec. 709, whose colors sRGB has.
const WEIGHTS: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Linear light of a number from 0 to 1 that is coded as sRGB.
fn linear(coded: f64) -> f32 {
    let light = if coded <= 0.04045 {
        coded / 12.92
    } else {
        libm::pow((coded + 0.055) / 1.055, 2.4)
    };
    light as f32
}

/// Linear light of all numbers of 8 bits.
static LIGHT_8: LazyLock<Vec<f32>> =
    LazyLock::new(|| (0..=255).map(|v| linear(f64::from(v) / 255.0)).collect());
/// Linear light of all numbers of 16 bits.
static LIGHT_16: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let all = 0..=u16::MAX;
    all.map(|v| linear(f64::from(v) / 65535.0)).collect()
});

/// Integers of pixels.
pub(super) trait Depth: Copy + Into<u64> {
    const FULL: u64;

    fn light(self) -> f32;

    fn cut(value: u64) -> Self;
}

impl Depth for u8 {
    const FULL: u64 = 255;

    fn light(self) -> f32 {
        LIGHT_8[usize::from(self)]
    }

    fn cut(value: u64) -> Self {
        value as Self
    }
}

impl Depth for u16 {
    const FULL: u64 = 65535;

    fn light(self) -> f32 {
        LIGHT_16[usize::from(self)]
    }

    fn cut(value: u64) -> Self {
        value as Self
    }
}

/// Adds the pixels of a row that are [plain](Channels::are_plain).
pub(super) fn plain<D: Depth>(row: &[D], channels: Channels, into: &mut Vec<D>) {
    if !channels.has_alpha {
        return into.extend_from_slice(row);
    }
    into.extend(row.chunks_exact(2).map(|pixel| {
        let [value, alpha] = [pixel[0], pixel[1]].map(Into::<u64>::into);
        D::cut((value * alpha + D::FULL / 2) / D::FULL)
    }));
}

/// Adds the light of the pixels of a row, 65535 for white.
pub(super) fn light<D: Depth>(
    row: &[D],
    channels: Channels,
    meaning: Meaning,
    into: &mut Vec<u16>,
) {
    let paper = match meaning {
        Meaning::Data => 0.0,
        Meaning::Picture => 1.0,
    };
    into.extend(row.chunks_exact(channels.count()).map(|pixel| {
        let mut light = if channels.has_colors {
            let [r, g, b] = [0, 1, 2].map(|i| pixel[i].light() * WEIGHTS[i]);
            r + g + b
        } else {
            pixel[0].light()
        };
        if channels.has_alpha {
            let alpha: u64 = pixel[channels.count() - 1].into();
            let alpha = alpha as f32 / D::FULL as f32;
            light = light * alpha + paper * (1.0 - alpha);
        }
        (light * 65535.0 + 0.5) as u16
    }));
}
