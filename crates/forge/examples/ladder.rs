//! x
use std::path::Path;
use strew_forge::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mut t = read_table(Path::new(&a[1])).unwrap();
    if t.ranks().is_none() { t = with_ranks(&t).unwrap(); }
    let v: Vec<f64> = a[3].split(',').map(|v| v.parse().unwrap()).collect();
    let t = trial(&t, &v);
    std::fs::write(&a[2], t.to_bytes()).unwrap();
}
