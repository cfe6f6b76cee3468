//! How the colors of a pixel become one number.

use std::sync::LazyLock;

use super::samples::Samples;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// A mask or a measurement: a single channel is taken as it is. Colors, also those of a palette, are taken as
    /// light, because there is no other sensible number. Transparency multiplies; what is wholly transparent is missing.
    Data,
    /// As data, whose numbers are those of the file: of a palette the indices, of a few bits the bits.
    Numbers,
    /// A picture: all channels are coded as sRGB and become linear light; what is transparent lies on
    /// white paper.
    Picture,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Channels {
    pub(super) has_colors: bool,
    /// Whether there is an alpha channel after them.
    pub(super) has_alpha: bool,
}

impl Channels {
    pub(super) const fn count(self) -> usize {
        (if self.has_colors { 3 } else { 1 }) + self.has_alpha as usize
    }

    pub(super) fn are_plain(self, meaning: Meaning) -> bool {
        meaning != Meaning::Picture && !self.has_colors
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

pub(super) trait Depth: Copy + Into<u64> {
    const FULL: u64;

    fn light(self) -> f32;

    fn cut(value: u64) -> Self;

    fn samples(values: Vec<Self>) -> Samples;
}

macro_rules! depth {
    ($number:ty, $samples:ident, $light:ident) => {
        impl Depth for $number {
            const FULL: u64 = <$number>::MAX as u64;

            fn samples(values: Vec<Self>) -> Samples {
                Samples::$samples(values)
            }

            fn light(self) -> f32 {
                $light[usize::from(self)]
            }

            fn cut(value: u64) -> Self {
                value as Self
            }
        }
    };
}

depth!(u8, U8, LIGHT_8);
depth!(u16, U16, LIGHT_16);

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
        Meaning::Picture => 1.0,
        Meaning::Data | Meaning::Numbers => 0.0,
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

/// Adds whether the pixels of a row are wholly transparent, which a picture's paper shows through.
pub(super) fn clear<D: Depth>(
    row: &[D],
    channels: Channels,
    meaning: Meaning,
    into: &mut Vec<bool>,
) {
    if channels.has_alpha && meaning != Meaning::Picture {
        let pixels = row.chunks_exact(channels.count());
        into.extend(pixels.map(|pixel| pixel[channels.count() - 1].into() == 0));
    }
}

/// Adds the numbers of 1, 2 or 4 bits that a row of bytes holds, the uppermost first.
pub(super) fn unpacked(row: &[u8], bits: u8, width: usize, into: &mut Vec<u8>) {
    let (each, mask) = (usize::from(8 / bits), (1 << bits) - 1);
    into.extend((0..width).map(|i| {
        let shift = 8 - bits as usize * (1 + i % each);
        row[i / each] >> shift & mask
    }));
}
