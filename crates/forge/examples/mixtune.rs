//! Scratch.
use strew_forge::{mix::tune::*, read_table};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let g = |n: &str, d: &str| a.iter().position(|x| x == n).map_or(d.to_string(), |i| a[i + 1].clone());
    let f = |n: &str, d: &str| g(n, d).parse::<f64>().unwrap();
    let l = |n: &str| -> Vec<f64> { let s = g(n, ""); if s.is_empty() { vec![] } else { s.split(':').map(|x| x.parse().unwrap()).collect() } };
    let table = read_table(std::path::Path::new(&a[1])).unwrap();
    let parts: Vec<u16> = g("--shares", "1:3").split(':').map(|x| x.parse().unwrap()).collect();
    let t = Tune { sigma: f("--sigma", "0.6"), cut: f("--cut", "3.6"), hot: f("--hot", "1"), cold: f("--cold", "0.003"), sweeps: f("--sweeps", "1000") as u32, weights: l("--weights"), lobe: f("--lobe", "0"), seed: f("--seed", "1") as u64, gamma: f("--gamma", "1"), hashed: a.iter().any(|x| x == "--hashed"), sigmas: l("--sigmas") };
    let labels = labels(&table, &parts, &t);
    let tw = g("--twin", "265/153"); let (x, y) = tw.split_once('/').unwrap();
    show(&table, &labels, parts.len(), x.parse().unwrap(), y.parse().unwrap());
    if a.iter().any(|x| x == "--rank") {
        let rule = strew_forge::mix::order::Rule { own: f("--own", "0.5"), sigma: f("--rsigma", "0.65"), batch: f("--batch", "0.05"), slack: f("--slack", "0.002") };
        let t2 = ranked(&table, &labels, &parts, &rule);
        kept(&t2, &labels, parts.len(), x.parse().unwrap(), y.parse().unwrap(), &[0.9, 0.7, 0.5, 0.35, 0.25, 0.15, 0.1]);
    }
    if a.iter().any(|x| x == "--joint") {
        full(&table, &labels, parts.len(), x.parse().unwrap(), y.parse().unwrap());
        let b = strew_forge::mix::together::Balance { all: f("--wu", "20"), sigma_all: f("--su", "1"), sigma: f("--sc", "0.85"), guard_all: f("--gu", "0.6"), guard: f("--gc", "0.7"), strength: f("--st", "0.3"), strength_all: f("--stu", "0.3") };
        let t2 = joint(&table, &labels, &parts, &b, f("--steps", "250") as u32, f("--rate", "0.2"));
        full(&t2, &labels, parts.len(), x.parse().unwrap(), y.parse().unwrap());
    }
}
