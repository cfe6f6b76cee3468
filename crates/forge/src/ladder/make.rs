//! Making a ladder.
use strew_core::Table;
use super::{climb::*, clearance, events, polish::Polish, segment::Energy};
/// trial
pub fn trial(table: &Table, v: &[f64]) -> Table {
    let t0 = std::time::Instant::now();
    let (per, least, steps, guard, strength, sigma) = (v[0], v[1], v[2] as u32, v[3], v[4], v[5]);
    let k = (per * -least.log2()).round() as i32;
    let shares: Vec<f64> = (1..=k).map(|k| (-f64::from(k) / per).exp2()).collect();
    let energy = Energy { sigma, guard, strength };
    let reach = (energy.cutoff() + 0.4 + 3.0 + 3.0) / least.sqrt();
    let blocks = Blocks::new(table, reach).expect("ranks");
    let mut climb = Climb::start(table, &blocks, &shares);
    events::time(&blocks, &mut climb);
    eprintln!("events {:.1?}", t0.elapsed());
    let mut polish = Polish::new(&blocks, &climb, energy, v[6] as usize);
    eprintln!("pairs {} {:.1?}", polish.pairs(), t0.elapsed());
    for step in 0..steps {
        if step > 0 && step % 15 == 0 { polish.list(&blocks, &climb); }
        let pace = if step * 4 > steps * 3 { 0.4 } else { 1.0 };
        let e = polish.step(&blocks, &mut climb, step, pace);
        if step % 10 == 0 || step + 1 == steps { eprintln!("{step} {e:.6} {:.1?}", t0.elapsed()); }
    }
    let show = |c: &clearance::Clearance| eprintln!("conflicts {} least {:.3} segments below .5: {}", c.conflicts, c.delta_min(), c.least.iter().filter(|&&d| d < 0.5).count());
    show(&clearance::clearance(&blocks, &climb, 0.5));
    let c = clearance::clear(&blocks, &mut climb, v[7], 60);
    show(&c);
    let scale = table.alpha().set_side_f64();
    climb.quantize(scale);
    show(&clearance::clearance(&blocks, &climb, 0.5));
    eprintln!("{:.1?}", t0.elapsed());
    table.with_ladder(climb.ladder(scale).expect("valid")).expect("valid")
}
