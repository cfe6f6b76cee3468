//! Makes the points of boxes of 1,000, each in another place, for `benches/instructions.py`: what they take without a
//! daemon. Arguments: the number of boxes, and a seed, if they have one.

use std::hint::black_box;

use strew_core::{F32, PointSet, Region};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let boxes: u32 = arguments.next().unwrap_or_default().parse()?;
    let mut set = PointSet::blue().spacing(1.0)?;
    if let Some(seed) = arguments.next() {
        set = set.seed(seed.parse()?);
    }
    let mut points = vec![[0.0_f32; 2]; 2000];
    for number in 0..boxes {
        let corner = [f64::from(number % 997 * 40), f64::from(number / 997 * 40)];
        let plan = set.within(Region::new(corner, corner.map(|at| at + 31.6))?)?;
        let made = plan.blocks::<F32>().fill(&mut points);
        black_box(&points[..made]);
    }
    Ok(())
}
