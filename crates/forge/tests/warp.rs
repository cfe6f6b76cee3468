//! The seeded warp makes sets isotropic, and sets of different seeds unrelated.

mod shipped;

use strew_core::{PointSet, table::Figures};
use strew_forge::{
    judge::{RING_WIDTH, figures},
    measure::{Sample, Spectrum},
};

const OFF: f64 = 0.0;
const ON: f64 = 1.0;

/// A window of `side`² mean spacings away from the origin.
fn window(seed: u64, warp: f64, side: f64) -> Sample {
    let table = shipped::table("blue", "(5-sqrt(3))/2", 49);
    let set = PointSet::new(table).seed(seed).warp(warp);
    let corner = 1000.0 * seed as f64;
    shipped::window(&set.expect("in range"), [corner, -corner], side)
}

fn measured(subject: String, set: &Sample, nu_max: f64) -> Figures {
    figures(subject, false, set, &Spectrum::of(set, nu_max), RING_WIDTH)
}

#[test]
fn warped_sets_are_isotropic_and_keep_their_noise() {
    for seed in [1, 2, 77] {
        let set = window(seed, ON, 362.0);
        let figures = measured(format!("seed {seed}"), &set, 4.0);
        let value = |name| figures.value(name).expect("measured");
        assert!(value("anisotropy_db") <= 0.2, "{figures:?}");
        assert!(value("tallest_peak") <= 35.0, "{figures:?}");
        assert!(value("low_power") <= 1e-5, "{figures:?}");
        assert!(value("delta_min") >= 0.60, "{figures:?}");
    }
    // Without the warp they are not.
    let plain = measured("plain".into(), &window(1, OFF, 362.0), 4.0);
    assert!(
        plain.value("anisotropy_db").expect("measured") > 2.0,
        "{plain:?}"
    );
}

#[test]
fn a_million_warped_points_are_isotropic() {
    let set = window(3, ON, 1000.0);
    let figures = measured("seed 3".into(), &set, 2.0);
    let value = |name| figures.value(name).expect("measured");
    assert!(value("anisotropy_db") <= 0.2, "{figures:?}");
    assert!(value("low_power") <= 1e-5, "{figures:?}");
    assert!(value("delta_min") >= 0.60, "{figures:?}");
}

/// The correlation of two power spectra over 0.8 < ν < 2.5, with the power of each mode over the
/// mean of its ring.
fn correlation(a: &Sample, b: &Sample) -> f64 {
    let spectra = [a, b].map(|set| Spectrum::of(set, 2.5));
    let side = a.side();
    let modes = (2.5 * side) as i64;
    // The taper blurs neighboring modes; every fifth mode is an independent sample.
    let samples = (0..=modes).step_by(5).flat_map(|kx| {
        let spectra = &spectra;
        (-modes..=modes).step_by(5).filter_map(move |ky| {
            let nu = ((kx * kx + ky * ky) as f64).sqrt() / side;
            let power = |i: usize| spectra[i].at(kx, ky);
            (0.8..2.5)
                .contains(&nu)
                .then_some((nu, power(0)?, power(1)?))
        })
    });
    let mut rings = vec![Vec::new(); 40];
    for (nu, p, q) in samples {
        rings[((nu - 0.8) / 0.05) as usize].push((p, q));
    }
    let (mut pq, mut pp, mut qq) = (0.0, 0.0, 0.0);
    for ring in rings.iter().filter(|ring| ring.len() > 10) {
        let mean =
            |pick: fn(&(f64, f64)) -> f64| ring.iter().map(pick).sum::<f64>() / ring.len() as f64;
        let (mean_p, mean_q) = (mean(|s| s.0), mean(|s| s.1));
        for (p, q) in ring {
            let (dp, dq) = (p / mean_p - 1.0, q / mean_q - 1.0);
            (pq, pp, qq) = (pq + dp * dq, pp + dp * dp, qq + dq * dq);
        }
    }
    pq / (pp * qq).sqrt()
}

#[test]
fn seeds_are_unrelated_sets() {
    let set = |seed, warp| window(seed, warp, 362.0);
    let warped = correlation(&set(1, ON), &set(2, ON));
    // About 50,000 modes: independent sets stay within a few hundredths.
    assert!(warped.abs() < 0.03, "{warped}");
    let plain = correlation(&set(1, OFF), &set(2, OFF));
    assert!(
        plain > 0.3,
        "without the warp all sets have the same peaks: {plain}"
    );
}
