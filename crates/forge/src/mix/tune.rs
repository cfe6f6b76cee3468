//! Scratch.
use std::time::Instant;
use strew_core::{Table, Twin, table::to_grid_units};
use super::{anneal::{Annealer, Kind, Schedule, UNIT}, near::{Kernel, Presses, longest}};
use crate::{ladder::Ground, measure::{Distances, Spectrum, Torus}, numeric::exp};

/// Parameters.
pub struct Tune { pub sigma: f64, pub cut: f64, pub hot: f64, pub cold: f64, pub sweeps: u32, pub weights: Vec<f64>, pub lobe: f64, pub seed: u64, pub hashed: bool, pub gamma: f64, pub sigmas: Vec<f64> }

/// Labels.
pub fn labels(table: &Table, parts: &[u16], t: &Tune) -> Vec<u8> {
    let began = Instant::now();
    let total: u32 = parts.iter().map(|&p| u32::from(p)).sum();
    let shares: Vec<f64> = parts.iter().map(|&p| f64::from(p) / f64::from(total)).collect();
    let least = shares[0].sqrt();
    let smax = t.sigmas.iter().copied().fold(t.sigma, f64::max);
    let ground = Ground::new(table.map(), t.cut * smax / least + 2.0 * longest(table) + 1.0);
    let nb = ground.blocks();
    eprintln!("ground {:.2?} longest {:.2}", began.elapsed(), longest(table));
    let mut distinct: Vec<(u16, f64, f64)> = vec![];
    let mut kinds = vec![];
    for (c, &p) in parts.iter().enumerate() {
        let f = shares[c]; let w = t.weights.get(c).copied().unwrap_or_else(|| (f / shares[parts.len() - 1]).powf(t.gamma)); let sg = t.sigmas.get(c).copied().unwrap_or(t.sigma);
        let at = distinct.iter().position(|d| *d == (p, w, sg)).unwrap_or_else(|| { distinct.push((p, w, sg)); distinct.len() - 1 });
        // ∫ K = 2πσ² for the plain Gaussian
        let even = w * std::f64::consts::PI * sg * sg / (f * f) * (1.0 - t.lobe) * nb as f64;
        kinds.push(Kind { share: f, presses: at, even });
    }
    let presses: Vec<Presses> = distinct.iter().map(|&(p, w, sg)| {
        let f = f64::from(p) / f64::from(total);
        let rate = -0.5 * f / (sg * sg); let lobe = t.lobe;
        // Gaussian × (1 − lobe·(x/2)…): Laguerre-like, x = d²f/σ²
        let k = move |sq: f64| { let x = -2.0 * rate * sq; exp((rate * sq).max(-600.0)) * (1.0 - lobe * x * 0.5) };
        let pr = Presses::new(table, &ground, &Kernel { range: t.cut * sg / f.sqrt(), of: k }, w / f * nb as f64 * UNIT);
        eprintln!("pairs a block {:.1}", pr.pairs() as f64 / nb as f64);
        pr
    }).collect();
    eprintln!("presses {:.2?}", began.elapsed());
    let area: Vec<f64> = (0..nb).map(|b| ground.share(b)).collect();
    let mut start = vec![0u8; nb];
    let cum: Vec<f64> = shares.iter().scan(0.0, |c, s| { *c += s; Some(*c) }).collect();
    let mut order: Vec<usize> = (0..nb).collect();
    if t.hashed { order.sort_by_key(|&b| (b as u64 + 77).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(31).wrapping_mul(0xbf58476d1ce4e5b9)); } else if let Some(r) = table.ranks() { order.sort_by_key(|&b| r.positions()[b]); }
    let mut at = 0.0;
    for b in order { let m = at + 0.5 * area[b]; start[b] = cum.iter().position(|&c| m < c).unwrap_or(parts.len() - 1) as u8; at += area[b]; }
    let mut a = Annealer::new(&kinds, &presses, &area, start);
    a.run(&Schedule { sweeps: t.sweeps, hot: t.hot, cold: t.cold, seed: t.seed });
    eprintln!("accepted {} of {} {:.2?} over {:?}", a.accepted, u64::from(t.sweeps) * nb as u64, began.elapsed(), a.over().iter().map(|v| v * nb as f64).collect::<Vec<_>>());
    a.labels
}

/// Measures.
pub fn show(table: &Table, labels: &[u8], k: usize, t: u64, r: u64) {
    let twin = Twin::new(r + 2 * t, t + r).expect("twin");
    let sites = twin.sites(table.map()).expect("twin of the map");
    let n = table.map().intervals();
    let mut line = String::new();
    for c in 0..k {
        let p: Vec<[f64; 2]> = sites.iter().filter_map(|s| { let b = s.block_y as usize * n + s.block_x as usize; (labels[b] as usize == c).then(|| { let [x, y] = table.displacements()[b].map(to_grid_units); [f64::from(s.x) + x, f64::from(s.y) + y] }) }).collect();
        let count = p.len();
        let set = Torus::new(twin.period() as f64, p);
        let s = Spectrum::of_torus(&set, 1.5).summary(0.04); let d = Distances::of_torus(&set);
        line += &format!("  c{c} {:.4} low {:.4} peak {:.2} dmin {:.2}", count as f64 / sites.len() as f64, s.low_power, s.peak_power, d.delta_min);
    }
    println!("{line}");
}

/// Ranks.
pub fn ranked(table: &Table, labels: &[u8], parts: &[u16], rule: &super::order::Rule) -> Table {
    let began = Instant::now();
    let total: u32 = parts.iter().map(|&p| u32::from(p)).sum();
    let shares: Vec<f64> = parts.iter().map(|&p| f64::from(p) / f64::from(total)).collect();
    let p = super::order::positions(table, labels, &shares, rule, &|| false).expect("done");
    eprintln!("ranked {:.2?}", began.elapsed());
    table.with_ranks(strew_core::table::Ranks::new(p).expect("perm")).expect("ok")
}

/// Kept.
pub fn kept(table: &Table, labels: &[u8], k: usize, t: u64, r: u64, at: &[f64]) {
    let twin = Twin::new(r + 2 * t, t + r).expect("twin");
    let sites = twin.sites(table.map()).expect("twin of the map");
    let n = table.map().intervals();
    for &lam in at {
        let mut line = format!("keep {lam}:");
        let all: Vec<([f64; 2], u8)> = sites.iter().filter_map(|s| { let b = s.block_y as usize * n + s.block_x as usize; let rr = table.block_ranks(b); (0.5 * (rr.start + rr.end) < lam).then(|| { let [x, y] = table.displacements()[b].map(to_grid_units); ([f64::from(s.x) + x, f64::from(s.y) + y], labels[b]) }) }).collect();
        for c in 0..=k {
            let p: Vec<[f64; 2]> = all.iter().filter(|x| c == k || x.1 as usize == c).map(|x| x.0).collect();
            let share = p.len() as f64 / all.len() as f64;
            let set = Torus::new(twin.period() as f64, p);
            let s = Spectrum::of_torus(&set, 0.6).summary(0.04); let d = Distances::of_torus(&set);
            line += &format!("  c{c} {:.4} low {:.3} dmin {:.2}", share, s.low_power, d.delta_min);
        }
        println!("{line}");
    }
}

/// Joint.
pub fn joint(table: &Table, labels: &[u8], parts: &[u16], b: &super::together::Balance, steps: u32, rate: f64) -> Table {
    let began = Instant::now();
    let total: u32 = parts.iter().map(|&p| u32::from(p)).sum();
    let kinds: Vec<Vec<f64>> = (0..parts.len()).map(|c| labels.iter().map(|&l| f64::from(u8::from(l as usize == c))).collect()).collect();
    let mut o = super::together::Together::new(table.map(), kinds, b, f64::from(parts[0]) / f64::from(total));
    let d = crate::optimize::Descent { steps, rate };
    let mut meter = crate::Meter::new(&(), crate::Stage::Optimizing, steps);
    let start = crate::ladder::moves_of(table);
    let s = d.run(&mut o, crate::optimize::DescentState::start(start.clone()), &mut meter, &mut |_| {});
    let scale = table.alpha().set_side_f64();
    let v: Vec<[i32; 2]> = s.moves.iter().map(|m| m.map(|x| (x / scale * 1048576.0).round() as i32)).collect();
    let rms = (s.moves.iter().zip(&start).map(|(a, b)| (a[0]-b[0]).powi(2) + (a[1]-b[1]).powi(2)).sum::<f64>() / start.len() as f64).sqrt();
    eprintln!("joint {:.2?} energy {:.6} moved rms {rms:.3}", began.elapsed(), s.energy);
    Table::new(table.map().clone(), "blue", v, strew_core::table::Provenance::default()).expect("ok")
}

/// All figures of kinds and union.
pub fn full(table: &Table, labels: &[u8], k: usize, t: u64, r: u64) {
    let twin = Twin::new(r + 2 * t, t + r).expect("twin");
    let sites = twin.sites(table.map()).expect("twin of the map");
    let n = table.map().intervals();
    for c in 0..=k {
        let p: Vec<[f64; 2]> = sites.iter().filter_map(|s| { let b = s.block_y as usize * n + s.block_x as usize; (c == k || labels[b] as usize == c).then(|| { let [x, y] = table.displacements()[b].map(to_grid_units); [f64::from(s.x) + x, f64::from(s.y) + y] }) }).collect();
        let set = Torus::new(twin.period() as f64, p);
        let s = Spectrum::of_torus(&set, 2.5).summary(0.04); let d = Distances::of_torus(&set);
        println!("{} low {:.2e} peak {:.2} tallest {:.0} aniso {:.2} dmin {:.3} davg {:.3}", if c == k { "union".into() } else { format!("c{c}   ") }, s.low_power, s.peak_power, s.tallest, s.anisotropy_db, d.delta_min, d.delta_avg);
    }
}
