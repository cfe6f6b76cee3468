//! Shells of frequencies: means and deviations of power over all directions.

/// The power of the frequencies in a shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    /// The middle of the shell.
    pub frequency: f64,
    /// The mean power.
    pub power: f64,
    /// The deviation over the mean.
    pub deviation: f64,
    /// The greatest power.
    pub largest: f64,
}

impl Shell {
    /// The anisotropy 10·log10(variance / mean²), in decibels: 0 for random phases.
    #[must_use]
    pub fn anisotropy(&self) -> f64 {
        20.0 * libm::log10(self.deviation.max(1e-9))
    }
}

/// The sums over shells of a spectrum.
pub(super) struct Shells {
    width: f64,
    sums: Vec<[f64; 4]>,
}

impl Shells {
    /// Shells of a width, from 0 to `highest`.
    pub(super) fn new(width: f64, highest: f64) -> Self {
        let count = (highest / width + 0.5) as usize;
        Self {
            width,
            sums: vec![[0.0; 4]; count],
        }
    }

    pub(super) fn add(&mut self, frequency: f64, power: f64) {
        if let Some(sum) = self.sums.get_mut((frequency / self.width) as usize) {
            let [number, total, squares, largest] = *sum;
            *sum = [
                number + 1.0,
                total + power,
                squares + power * power,
                largest.max(power),
            ];
        }
    }

    /// The shells that have frequencies.
    pub(super) fn each(&self) -> impl Iterator<Item = Shell> + '_ {
        let all = self.sums.iter().enumerate();
        let filled = all.filter(|(_, sum)| sum[0] > 0.0);
        filled.map(|(i, &[number, total, squares, largest])| {
            let mean = total / number;
            let variance = (squares / number - mean * mean).max(0.0);
            Shell {
                frequency: (i as f64 + 0.5) * self.width,
                power: mean,
                deviation: variance.sqrt() / mean.max(1e-12),
                largest,
            }
        })
    }
}
