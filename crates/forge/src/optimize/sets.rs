//! Energies of point sets in table space, evaluated on twins.

use rayon::prelude::*;
use strew_core::{Map, Twin, map::Site};

use super::Objective;
use crate::{energy::SetEnergy, measure::Sample};

/// An energy of point sets as a function of a table's vectors: its mean over the points of several
/// twins.
///
/// Blocks that are neighbors on none of the twins do not interact. So there should be several
/// twins, none of them very small. [`Pairs`](super::Pairs) has no such limit.
pub struct Sets<E> {
    energy: E,
    twins: Vec<TwinPoints>,
    masses: Vec<f64>,
}

/// The points of one twin.
struct TwinPoints {
    /// Undisplaced, in mean spacings.
    sites: Vec<[f64; 2]>,
    /// The block of each site.
    blocks: Vec<u32>,
    /// Displaced.
    set: Sample,
    /// The gradient of the energy, by each point.
    gradient: Vec<[f64; 2]>,
}

impl<E: SetEnergy> Sets<E> {
    /// The energy on `twins`; those that are not twins of `map` are ignored.
    pub fn new(energy: E, map: &Map, twins: &[Twin]) -> Self {
        let n = map.intervals();
        let points = |twin: &Twin| {
            let sites = twin.sites(map)?;
            let place = |site: &Site| [f64::from(site.x), f64::from(site.y)];
            let set = Sample::torus(twin.period() as f64, sites.iter().map(place).collect());
            let block = |site: &Site| site.block_y * n as u32 + site.block_x;
            Some(TwinPoints {
                sites: set.points().to_vec(),
                blocks: sites.iter().map(block).collect(),
                gradient: vec![[0.0; 2]; sites.len()],
                set,
            })
        };
        let twins: Vec<TwinPoints> = twins.iter().filter_map(points).collect();
        let mut masses = vec![0.0; n * n];
        for &block in twins.iter().flat_map(|twin| &twin.blocks) {
            masses[block as usize] += 1.0;
        }
        let total: f64 = masses.iter().sum();
        masses.iter_mut().for_each(|mass| *mass /= total);
        Self {
            energy,
            twins,
            masses,
        }
    }
}

impl<E: SetEnergy> Objective for Sets<E> {
    fn masses(&self) -> &[f64] {
        &self.masses
    }

    fn evaluate(&mut self, moves: &[[f64; 2]], gradient: &mut [[f64; 2]]) -> f64 {
        let energy = &self.energy;
        let displaced = |twin: &mut TwinPoints| {
            let places = twin.set.points_mut().iter_mut().zip(&twin.sites);
            for ((p, site), block) in places.zip(&twin.blocks) {
                let by = moves[*block as usize];
                *p = [site[0] + by[0], site[1] + by[1]];
            }
            energy.evaluate(&twin.set, &mut twin.gradient)
        };
        let energies: Vec<f64> = self.twins.par_iter_mut().map(displaced).collect();
        gradient.fill([0.0; 2]);
        let (mut sum, mut points) = (0.0, 0.0);
        for (twin, energy) in self.twins.iter().zip(energies) {
            for (&block, slope) in twin.blocks.iter().zip(&twin.gradient) {
                let out = &mut gradient[block as usize];
                *out = [out[0] + slope[0], out[1] + slope[1]];
            }
            sum += energy * twin.sites.len() as f64;
            points += twin.sites.len() as f64;
        }
        for (out, mass) in gradient.iter_mut().zip(&self.masses) {
            let instances = f64::max(mass * points, 1.0);
            *out = out.map(|v| v / instances);
        }
        sum / f64::max(points, 1.0)
    }
}
