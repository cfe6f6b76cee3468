//! Effective Nyquist frequency and oscillation of a spectrum, after Heck, Schlömer, Deussen, "Blue
//! Noise Sampling with Controlled Aliasing" (2013).

use super::Ring;

/// The two figures of Heck et al.: how far a spectrum is empty, and how much it oscillates beyond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crispness {
    /// The effective Nyquist frequency ν_eff: the radius in ν of the largest disc around 0 whose
    /// mean power is at most 0.1. The square lattice has about 1. Frequencies up to ν_eff/2 are
    /// sampled nearly without aliasing.
    pub nu_eff: f64,
    /// The oscillation Ω: ten times the root mean square of P − 1, from the frequency where the
    /// power first reaches 1 over five units of ν, or as far as the rings extend.
    pub omega: f64,
}

/// The largest mean power of the disc of ν_eff.
const MAX_DISC_POWER: f64 = 0.1;
/// The mean power of a disc at which the search for a larger one ends: the spectrum has risen.
const RISEN: f64 = 0.5;
/// The power, about 1, at which the range of Ω begins.
const ABOUT_ONE: f64 = 0.98;
/// The length of the range of Ω, in ν.
const OSCILLATION_RANGE: f64 = 5.0;

impl Crispness {
    /// Computes the figures from rings of the given width in ν, from 0 outwards. Within a ring the
    /// power is taken as constant.
    #[must_use]
    pub fn of_rings(rings: &[Ring], width: f64) -> Self {
        Self {
            nu_eff: effective_nyquist(rings, width),
            omega: oscillation(rings),
        }
    }
}

fn effective_nyquist(rings: &[Ring], width: f64) -> f64 {
    // `sum` over the squared radius is the mean power of the disc up to the edge of a ring. From
    // one edge to the next the disc grows with the power of the ring.
    let (mut found, mut inner, mut sum) = (0.0, 0.0f64, 0.0);
    for ring in rings {
        let outer = ((ring.nu / width).floor() + 1.0) * width;
        let next = sum + ring.power * (outer * outer - inner * inner);
        if sum <= MAX_DISC_POWER * inner * inner && next > MAX_DISC_POWER * outer * outer {
            // sum + P·(x² − inner²) = MAX_DISC_POWER·x²
            found = ((ring.power * inner * inner - sum) / (ring.power - MAX_DISC_POWER)).sqrt();
        } else if next <= MAX_DISC_POWER * outer * outer {
            found = outer;
        }
        (inner, sum) = (outer, next);
        if sum > RISEN * outer * outer {
            break;
        }
    }
    found
}

fn oscillation(rings: &[Ring]) -> f64 {
    let Some(first) = rings.iter().position(|ring| ring.power >= ABOUT_ONE) else {
        return 0.0;
    };
    let end = rings[first].nu + OSCILLATION_RANGE;
    let (mut sum, mut weight) = (0.0, 0.0);
    for ring in rings[first..].iter().take_while(|ring| ring.nu <= end) {
        sum += ring.nu * (ring.power - 1.0) * (ring.power - 1.0);
        weight += ring.nu;
    }
    10.0 * f64::sqrt(sum / f64::max(weight, f64::MIN_POSITIVE))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rings of a radial power.
    fn rings(power: impl Fn(f64) -> f64) -> Vec<Ring> {
        let ring = |at: u32| {
            let nu = (f64::from(at) + 0.5) / 64.0;
            Ring {
                nu,
                power: power(nu),
                anisotropy_db: 0.0,
                tallest: 0.0,
            }
        };
        (0..512).map(ring).collect()
    }

    #[test]
    fn a_step_at_half_has_its_known_figures() {
        // The mean power of the disc, 1 − 0.25/ν², is 0.1 at ν = 0.5/√0.9.
        let step = rings(|nu| if nu < 0.5 { 0.0 } else { 1.0 });
        let found = Crispness::of_rings(&step, 1.0 / 64.0);
        assert!(
            (found.nu_eff - 0.5 / 0.9f64.sqrt()).abs() < 1e-12,
            "{found:?}"
        );
        assert_eq!(found.omega, 0.0);
    }

    #[test]
    fn oscillations_are_measured_from_where_the_power_reaches_one() {
        let wave = |nu: f64| match nu {
            nu if nu < 1.0 => 0.0,
            nu if nu < 3.0 => 1.5,
            _ => 1.0,
        };
        let found = Crispness::of_rings(&rings(wave), 1.0 / 64.0);
        // (P − 1)² is 0.25 over 1..3 and 0 over 3..6: 10·√(0.25·8/35).
        let expected = 10.0 * (0.25f64 * 8.0 / 35.0).sqrt();
        assert!((found.omega - expected).abs() < 0.03, "{found:?}");
        assert!(found.nu_eff > 1.0 && found.nu_eff < 1.05, "{found:?}");
    }

    #[test]
    fn white_noise_has_neither() {
        let found = Crispness::of_rings(&rings(|_| 1.0), 1.0 / 64.0);
        assert_eq!(
            found,
            Crispness {
                nu_eff: 0.0,
                omega: 0.0
            }
        );
    }
}
