//! Masks are as even as those of void and cluster at every share, also where the points that they begin with end.

use strew_core::Table;
use strew_forge::mask::Mask;

/// Seeds of each size.
const SEEDS: u64 = 4;

fn table() -> Table {
    let bytes = include_bytes!("../../core/tables/blue-5-sqrt3-over-2-m.strew");
    Table::from_bytes(bytes).expect("a shipped table")
}

/// Masks of two sizes.
fn masks() -> [(u32, Vec<Mask>); 2] {
    let table = table();
    [64, 128].map(|size| {
        let mask = |seed| Mask::new(&table, size, seed).expect("a valid size");
        (size, (0..SEEDS).map(mask).collect())
    })
}

/// The mean of low powers and the mean of peaks.
fn judged(masks: &[Mask], level: f64) -> [f64; 2] {
    let spectra = masks.iter().map(|mask| mask.spectrum(level));
    let (low, peak): (Vec<f64>, Vec<f64>) = spectra.map(|s| (s.low_power, s.peak)).unzip();
    [low, peak].map(|values| values.iter().sum::<f64>() / values.len() as f64)
}

/// Plain void and cluster has a mean low power of 0.09 at 1/16, and 0.06 to 0.07 from 1/8 to 3/16; its peaks are 11 to
/// 13 on average. A seam at the first eighth had a low power of 0.15 there.
#[test]
fn no_seam_shows_around_an_eighth() {
    for (size, masks) in masks() {
        for (level, most) in [
            (8, 0.090),
            (12, 0.080),
            (14, 0.080),
            (16, 0.075),
            (18, 0.075),
            (20, 0.075),
            (24, 0.075),
        ] {
            let [low, peak] = judged(&masks, f64::from(level) / 128.0);
            assert!(
                low < most && peak < 18.0,
                "{size}, {level}/128: {low} {peak}"
            );
        }
    }
}

#[test]
fn thresholds_are_ranks_in_8_or_16_bits() {
    let [(_, masks), _] = masks();
    let mask = Mask::by_key(2, |x, y| [5, 7, 9, 6][(2 * y + x) as usize]);
    assert_eq!(mask.ranks(), [0, 2, 3, 1]);
    assert!(mask.thresholds(8).eq([0, 128, 192, 64]));
    assert!(mask.to_png(16).expect("16 bits").starts_with(b"\x89PNG"));
    assert!(mask.to_png(4).is_err());
    assert!(masks[0].spectrum(0.25).low_power < 0.2);
    // It is stopped wherever it is.
    let mut steps = 0;
    let whole = Mask::new_while(&table(), 64, 7, |pixels| {
        steps += pixels;
        true
    });
    assert!(whole.is_ok_and(|mask| mask.is_some()));
    for part in 0..64 {
        let mut left = steps * part / 64;
        let stopped = Mask::new_while(&table(), 64, 7, |pixels| {
            left = left.saturating_sub(pixels);
            left > 0
        });
        assert_eq!(stopped, Ok(None), "{part}");
    }
}

/// Plain void and cluster has 0.12 to 0.16 on average. A kernel that reaches no other pixel had 2.4 at 1/256, and a
/// peak of 40: the pixels that came first were on one side.
#[test]
fn few_pixels_are_spread_too() {
    for (size, masks) in masks() {
        for level in [256, 192, 128, 96, 64, 56, 48, 32] {
            for share in [1.0 / f64::from(level), 1.0 - 1.0 / f64::from(level)] {
                let [low, peak] = judged(&masks, share);
                assert!(low < 0.16 && peak < 20.0, "{size}, {share}: {low} {peak}");
            }
        }
    }
}
