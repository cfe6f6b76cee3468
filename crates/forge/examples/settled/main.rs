//! Measures how points settle: sets that are thinned or lie in a field, after 0 to 4 steps.
//!
//! `cargo run --release -p strew-forge --example settled -- TABLE [--sets edge] [--steps 0,1,2,3,4] [--seeds 11,29,58]
//! [--points 50000] [--at 7300000,-5100000]` measures windows of some points at a corner. A set is taken if its name
//! begins so. A line is for all seeds together:
//!
//! - *low*: mean power below ν = 0.5 (chance 1) in windows of 24 local spacings, their mean and median; *whole*, that
//!   of the whole window, and *tall*, the tallest mode below ν = 0.8 over its ring, at constant shares;
//! - *delta*: the least distance of all, that of the nearest 1 %, and the mean, in hexagonal distances of the denser
//!   point's share; *near*: the number of pairs below 0.4; *of D*: the least distance
//!   over the one that is promised;
//! - *var*: Var(N − ∫λ)/∫λ in boxes of 8 to 32 points; *bias* of the count in percent, then by octave of the share.
//!
//! Where a table has kinds, or gets some by `--mix 1:1:2`, *kinds* is the mean low power of each, in windows of 24
//! spacings of its own, the rarest first. `--share 0.21` measures that share alone.
//!
//! Stripes have more lines: the density over the share by half local spacings from the edge, outside first.
//!
//! `--draw forest|shares|SET OUT.png` draws instead.

mod draw;
mod figures;
mod sets;

use std::{error::Error, path::Path};

use figures::{Boxes, Ground, Near, Octave, Windows};
use sets::{Case, Kind, Part, Stripes};
use strew_core::{PointSet, Region};
use strew_forge::{
    MixJob,
    measure::{Spectrum, Window},
    mix, read_table,
};

/// The width of a ring.
const RING: f64 = 0.02;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let after = |name: &str, default: &str| {
        let at = arguments.iter().position(|a| a == name);
        let found = at.and_then(|at| arguments.get(at + 1));
        found.map_or(default.to_owned(), Clone::clone)
    };
    let table = read_table(Path::new(arguments.first().ok_or("which table?")?))?;
    let all = PointSet::new(match after("--mix", "") {
        shares if shares.is_empty() => table,
        shares => {
            let made = mix(&table, &MixJob::labels(shares.parse()?), &())?;
            made.ok_or("stopped")?.table
        }
    });
    let numbers =
        |text: String| -> Result<Vec<f64>, _> { text.split(',').map(str::parse).collect() };
    let seeds = numbers(after("--seeds", "11,29,58"))?;
    let steps = numbers(after("--steps", "0,1,2,3,4"))?;
    let at = numbers(after("--at", "7300000,-5100000"))?;
    let &[x, y] = at.as_slice() else {
        return Err("a corner is x,y".into());
    };
    let points: f64 = after("--points", "50000").parse()?;
    let wanted = after("--sets", "");
    if let Some(draw) = arguments.iter().position(|a| a == "--draw") {
        let [what, out] = arguments[draw + 1..]
            .first_chunk()
            .ok_or("--draw WHAT OUT.png")?;
        return draw::draw(&all, what, Path::new(out), &steps, seeds[0] as u64);
    }
    let cases = match after("--share", "") {
        share if share.is_empty() => Case::all(),
        share => vec![Case::constant(share.parse()?)],
    };
    for case in cases.iter().filter(|case| case.name.starts_with(&wanted)) {
        let mut rows: Vec<Row> = steps.iter().map(|_| Row::default()).collect();
        for &seed in &seeds {
            measure(case, &all, (seed as u64, [x, y], points), &steps, &mut rows)?;
        }
        for (steps, row) in steps.iter().zip(&rows) {
            row.print(&format!("{} | {steps}", case.name));
        }
    }
    Ok(())
}

/// Measures a set by one seed, after each number of steps.
fn measure(
    case: &Case,
    all: &PointSet,
    (seed, corner, points): (u64, [f64; 2], f64),
    steps: &[f64],
    rows: &mut [Row],
) -> Result<(), Box<dyn Error>> {
    let side = case.side(points);
    let (set, shares) = case.set(all, seed, corner[0])?;
    let ground = Ground {
        corner,
        side,
        shares: &shares,
    };
    let region = Region::new(corner, corner.map(|v| v + side))?;
    let (for_boxes, for_windows) = if case.has_edges() {
        (64, 768)
    } else {
        (16, 96)
    };
    let boxes = Boxes::new(&ground, for_boxes);
    let parts = all.table().mix().map_or(Vec::new(), |mix| {
        let shares = mix.shares();
        (0..shares.kinds() as u8).map(|k| shares.of(k)).collect()
    });
    let mut windows = None;
    let mut of_kinds: Vec<Windows> = Vec::new();
    for (&steps, row) in steps.iter().zip(rows) {
        let set = set.clone().settle(steps as u32)?;
        let members = set.within(region)?.to_vec();
        let points: Vec<[f64; 2]> = members
            .iter()
            .map(|p| [p.x - corner[0], p.y - corner[1]])
            .collect();
        let windows = windows.get_or_insert_with(|| Windows::new(&ground, &points, for_windows));
        row.low.extend(windows.low(&points));
        row.kinds.resize(parts.len(), Vec::new());
        for (kind, part) in parts.iter().enumerate() {
            let is_own = |p: &&strew_core::Point| set.kind_of(p.id) == Some(kind as u8);
            let own = members.iter().filter(is_own);
            let own: Vec<[f64; 2]> = own.map(|p| [p.x - corner[0], p.y - corner[1]]).collect();
            if of_kinds.len() == kind {
                let shares = Part(&shares, *part);
                let ground = Ground {
                    shares: &shares,
                    ..ground
                };
                of_kinds.push(Windows::new(&ground, &own, for_windows));
            }
            row.kinds[kind].extend(of_kinds[kind].low(&own));
        }
        let mut near = Near::of(&ground, &points);
        near.plain /= all.clone().seed(seed).least_distance();
        row.near.push(near);
        row.counts.push(boxes.count(&points));
        match case.kind {
            Kind::Constant(share) => {
                let window = Window::new(side, share, points);
                let spectrum = Spectrum::of_window(&window, 1.0);
                let low = spectrum.summary(RING).low_power;
                row.whole.push([low, tallest(&spectrum, window.side())]);
            }
            Kind::Stripes(stripes) => row.profile.add(stripes, side, &points),
            _ => {}
        }
    }
    Ok(())
}

/// The figures of a set after some steps, by seed.
#[derive(Default)]
struct Row {
    low: Vec<f64>,
    kinds: Vec<Vec<f64>>,
    whole: Vec<[f64; 2]>,
    near: Vec<Near>,
    counts: Vec<Vec<Octave>>,
    profile: Profile,
}

impl Row {
    fn print(&self, name: &str) {
        let mut low = self.low.clone();
        low.sort_by(f64::total_cmp);
        let [mean, _] = average(&low);
        let median = low.get(low.len() / 2).copied().unwrap_or(0.0);
        print!("{name} | low {mean:.4} {median:.4}");
        if !self.kinds.is_empty() {
            print!(" kinds");
            for low in &self.kinds {
                print!(" {:.4}", average(low)[0]);
            }
        }
        if !self.whole.is_empty() {
            let [low, tall] = [0, 1].map(|i| self.whole.iter().map(|v| v[i]).collect::<Vec<_>>());
            print!(
                " whole {:.5} tall {:.0}",
                average(&low)[0],
                average(&tall)[0]
            );
        }
        let least = self.near.iter().map(|near| near.least);
        let pairs: f64 = self.near.iter().map(|near| near.pairs).sum();
        let [hundredth, distance] = [|near: &Near| near.hundredth, |near: &Near| near.mean]
            .map(|of| average(&self.near.iter().map(of).collect::<Vec<_>>())[0]);
        print!(
            " | delta {:.3} {hundredth:.3} {distance:.3} near {pairs}",
            least.fold(f64::INFINITY, f64::min)
        );
        let plain = self.near.iter().map(|near| near.plain);
        print!(" of D {:.3}", plain.fold(f64::INFINITY, f64::min));
        let sum = |of: fn(&Octave) -> f64| self.counts.iter().flatten().map(of).sum::<f64>();
        print!(" | var {:.3}", sum(|o| o.errors) / sum(|o| o.boxes));
        let total = |octaves: &Vec<Octave>| {
            let [found, expected] = octaves
                .iter()
                .fold([0.0; 2], |[a, b], o| [a + o.found, b + o.expected]);
            100.0 * (found / expected - 1.0)
        };
        let [bias, error] = average(&self.counts.iter().map(total).collect::<Vec<_>>());
        print!(" bias {bias:+.3}±{error:.3}:");
        for octave in 0..10 {
            let each = self.counts.iter().map(|octaves| octaves[octave]);
            let each = each.filter(|octave| octave.boxes >= 16.0);
            let each: Vec<f64> = each.map(|o| 100.0 * (o.found / o.expected - 1.0)).collect();
            if !each.is_empty() {
                let [bias, error] = average(&each);
                print!(" {bias:+.2}±{error:.2}");
            }
        }
        println!();
        self.profile.print();
    }
}

/// The mean, and its standard error.
fn average(all: &[f64]) -> [f64; 2] {
    let number = all.len().max(1) as f64;
    let mean = all.iter().sum::<f64>() / number;
    let squares: f64 = all.iter().map(|v| (v - mean).powi(2)).sum();
    [mean, (squares / number / (number - 1.0).max(1.0)).sqrt()]
}

/// Counts by half local spacings from an edge, and what the shares let expect: outside, then inside.
#[derive(Default)]
struct Profile([[[f64; 2]; 6]; 2]);

impl Profile {
    fn add(&mut self, stripes: Stripes, side: f64, points: &[[f64; 2]]) {
        let place = |x: f64| {
            let (far, share) = stripes.edge_distance(x);
            (usize::from(far >= 0.0), (far.abs() * 2.0) as usize, share)
        };
        for p in points {
            let (is_inside, bin, _) = place(p[0]);
            if let Some(sum) = self.0[is_inside].get_mut(bin) {
                sum[0] += 1.0;
            }
        }
        const LOOKS: usize = 100_000;
        for i in 0..LOOKS {
            let (is_inside, bin, share) = place((i as f64 + 0.5) / LOOKS as f64 * stripes.period);
            if let Some(sum) = self.0[is_inside].get_mut(bin) {
                sum[1] += share * side * side / LOOKS as f64;
            }
        }
    }

    fn print(&self) {
        if self.0.iter().flatten().all(|sum| sum[1] == 0.0) {
            return;
        }
        for (name, side) in ["outside", "inside"].iter().zip(&self.0) {
            print!("    {name}:");
            for [found, expected] in side {
                match *expected > 0.0 {
                    true => print!(" {:.2}", found / expected),
                    false => print!(" ({found})"),
                }
            }
        }
        println!();
    }
}

/// The tallest mode below ν = 0.8, over the mean of its ring.
fn tallest(spectrum: &Spectrum, side: f64) -> f64 {
    let most = (0.8 * side) as i64;
    let mut rings = vec![(0.0, 0.0, 0.0f64); (0.8 / RING) as usize + 1];
    for kx in -most..=most {
        for ky in -most..=most {
            let nu = ((kx * kx + ky * ky) as f64).sqrt() / side;
            // The taper spreads what is at 0 over a few modes.
            if nu > 4.0 / side && nu < 0.8 {
                let power = spectrum.at(kx, ky).unwrap_or(0.0);
                let (count, sum, most) = &mut rings[(nu / RING) as usize];
                *count += 1.0;
                *sum += power;
                *most = most.max(power);
            }
        }
    }
    let over = rings.iter().filter(|ring| ring.0 > 0.0);
    over.map(|(count, sum, most)| most * count / sum)
        .fold(0.0, f64::max)
}
