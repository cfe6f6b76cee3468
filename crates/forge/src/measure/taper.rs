//! The taper of a window: sin⁸(πu) along each axis.
//!
//! The taper is a sum of five cosines. So at integer frequencies its transform, and with it the
//! spectrum of the window's mean density, is 0 except for |k| ≤ 4, where it is known exactly and
//! subtracted. Between integers it falls as k⁻⁹, so tall peaks of a quasi-periodic set do not leak.

/// The mean of the taper's square: C(16, 8)/2¹⁶.
pub(super) const MEAN_SQUARE: f64 = 12_870.0 / 65_536.0;

/// The taper at u in [0, 1].
pub(super) fn value(u: f64) -> f64 {
    let sine = (std::f64::consts::PI * u).sin();
    let fourth = (sine * sine) * (sine * sine);
    fourth * fourth
}

/// The Fourier coefficient of the taper at integer k: (−1)ᵏ·C(8, 4 + k)/2⁸.
pub(super) fn coefficient(k: i64) -> f64 {
    let binomial = match k.unsigned_abs() {
        0 => 70.0,
        1 => -56.0,
        2 => 28.0,
        3 => -8.0,
        4 => 1.0,
        _ => 0.0,
    };
    binomial / 256.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_and_mean_square_are_those_of_the_taper() {
        let nodes = 64;
        let mean = |f: &dyn Fn(f64) -> f64| -> f64 {
            (0..nodes)
                .map(|i| f(f64::from(i) / f64::from(nodes)))
                .sum::<f64>()
                / f64::from(nodes)
        };
        for k in 0..7 {
            let turn = 2.0 * std::f64::consts::PI * k as f64;
            let found = mean(&|u| value(u) * (turn * u).cos());
            assert!((found - coefficient(k)).abs() < 1e-15, "{k}");
        }
        assert!((mean(&|u| value(u) * value(u)) - MEAN_SQUARE).abs() < 1e-15);
    }
}
