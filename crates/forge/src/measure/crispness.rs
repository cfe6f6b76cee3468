//! How sharp and how calm a spectrum is: effective Nyquist frequency and oscillation, after Heck,
//! Schlömer, Deussen, "Blue Noise Sampling with Controlled Aliasing" (2013).

use super::Ring;

/// The two figures of Heck et al.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crispness {
    /// ν_eff: the radius of the largest disc around 0 whose mean power stays below 0.1, in units of
    /// half the sampling rate (√N/2 in pixels of the unit square), so that the square lattice has
    /// about 1. A frequency up to ν_eff/2 is sampled nearly without aliasing.
    pub nu_eff: f64,
    /// Ω: ten times the root mean square of P − 1 from the frequency where the power first comes
    /// to 1, over five units of ν, or as far as the rings go.
    pub omega: f64,
}

/// The mean power at which a disc has too much,
const CLEAN: f64 = 0.1;
/// and that at which the spectrum has certainly risen.
const RISEN: f64 = 0.5;
/// "About 1", where oscillation begins.
const ABOUT_ONE: f64 = 0.98;
/// The length of the range of Ω.
const OSCILLATION_RANGE: f64 = 5.0;

impl Crispness {
    /// Of equally wide rings, from 0 outwards. The power is taken as linear between the rings'
    /// middles in the disc's mean, as a function of the radius.
    #[must_use]
    pub fn of_rings(rings: &[Ring], width: f64) -> Self {
        Self {
            nu_eff: effective_nyquist(rings, width),
            omega: oscillation(rings),
        }
    }
}

fn effective_nyquist(rings: &[Ring], width: f64) -> f64 {
    // The mean power of the disc up to the outer edge of each ring; the disc grows from one edge
    // to the next with the ring's own power.
    let (mut found, mut inner, mut sum) = (0.0, 0.0f64, 0.0);
    for ring in rings {
        let outer = ((ring.nu / width).floor() + 1.0) * width;
        let next = sum + ring.power * (outer * outer - inner * inner);
        if sum <= CLEAN * inner * inner && next > CLEAN * outer * outer {
            // sum + P·(x² − inner²) = CLEAN·x²
            found = ((ring.power * inner * inner - sum) / (ring.power - CLEAN)).sqrt();
        } else if next <= CLEAN * outer * outer {
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
            }
        };
        (0..512).map(ring).collect()
    }

    #[test]
    fn a_step_at_half_has_its_known_figures() {
        // The disc's mean 1 − 0.25/ν² is 0.1 at ν = 0.5/√0.9.
        let step = rings(|nu| if nu < 0.5 { 0.0 } else { 1.0 });
        let found = Crispness::of_rings(&step, 1.0 / 64.0);
        assert!(
            (found.nu_eff - 0.5 / 0.9f64.sqrt()).abs() < 1e-12,
            "{found:?}"
        );
        assert_eq!(found.omega, 0.0);
    }

    #[test]
    fn oscillations_are_measured_from_where_the_power_comes_to_one() {
        let wave = |nu: f64| match nu {
            nu if nu < 1.0 => 0.0,
            nu if nu < 3.0 => 1.5,
            _ => 1.0,
        };
        let found = Crispness::of_rings(&rings(wave), 1.0 / 64.0);
        // 0.25 over the ring 1..3 of 1..6: 10·√(0.25·8/35).
        let expected = 10.0 * (0.25f64 * 8.0 / 35.0).sqrt();
        assert!((found.omega - expected).abs() < 0.03, "{found:?}");
        assert!(found.nu_eff > 1.0 && found.nu_eff < 1.05, "{found:?}");
    }

    #[test]
    fn white_noise_is_not_crisp_at_all() {
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
