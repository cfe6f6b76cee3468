//! Measures how points settle: sets that are thinned or lie in a field, after 0 to 4 steps, in windows of some points
//! at a corner. A set is taken if its name begins so. A row is for all seeds together:
//!
//! - *low*: mean power below ν = 0.5 (chance 1) in windows of 24 local spacings, their mean and median;
//! - *δ*: the least distance of all, that of the nearest 1 %, and the mean, in hexagonal distances of the denser
//!   point's share; *near*: the number of pairs below 0.4; *of D*: the least distance over the one that is promised;
//! - *var*: Var(N − ∫λ)/∫λ in boxes of 8 to 32 points; *bias* of the count in percent with its standard error, and so by
//!   octave of the share in a row of their own;
//! - *whole*: low power of the whole window, and *tall*, the tallest mode below ν = 0.8 over its ring, at constant shares.
//!
//! Where a table has kinds, or gets some by `--mix 1:1:2`, rows have the mean low power of each, in windows of 24
//! spacings of its own, the rarest first. `--share 0.21` measures that share alone. Stripes have more rows: the density
//! over the share by half local spacings from the edge, outside first.

use strew_core::{Point, PointSet};
use strew_forge::{
    labels,
    measure::{Sample, Spectrum},
};

use crate::{
    Arguments, Outcome,
    cases::{Case, Kind, Profile},
    figures,
    ground::{Ground, Near, places, square},
    local::{Octave, Windows, boxes, count},
};

/// The width of a ring.
const RING: f64 = 0.02;

pub fn study(mut arguments: Arguments) -> Outcome {
    let steps: Vec<u32> = arguments.list("--steps", "0,1,2,3,4")?;
    let seeds: Vec<u64> = arguments.list("--seeds", "11,29,58")?;
    let corner: Vec<f64> = arguments.list("--at", "7300000,-5100000")?;
    let &[x, y] = corner.as_slice() else {
        return Err("a corner is x,y".into());
    };
    let points: f64 = arguments.value("--points", "50000")?;
    let wanted: String = arguments.value("--sets", "")?;
    let cases = match arguments.after("--share") {
        Some(share) => vec![Case::constant(share.parse()?)],
        None => Case::all(),
    };
    let shares = arguments.after("--mix");
    let mut table = arguments.table()?;
    if let Some(shares) = shares {
        table = labels(&table, &shares.parse()?, &())?.ok_or("stopped")?;
    }
    let all = PointSet::new(table);
    let columns = "set | steps | low | median | δ_min | of 1 % | mean δ | near | of D | var";
    figures::head(&format!("{columns} | bias | ± | whole | tall"));
    for case in cases.iter().filter(|case| case.name.starts_with(&wanted)) {
        let mut rows: Vec<Row> = steps.iter().map(|_| Row::default()).collect();
        for &seed in &seeds {
            let all = all.clone().seed(seed);
            measure(case, &all, ([x, y], points), &steps, &mut rows)?;
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
    (corner, points): ([f64; 2], f64),
    steps: &[u32],
    rows: &mut [Row],
) -> Outcome {
    let side = case.side(points);
    let (set, field) = case.set(all, corner[0])?;
    let of_part = |unit: f64| Ground {
        corner,
        size: [side; 2],
        field: &*field,
        unit,
    };
    let ground = of_part(1.0);
    let [for_boxes, for_windows] = case.looks();
    let boxes = boxes(&ground, for_boxes);
    let parts = all.table().mix().map_or(Vec::new(), |mix| {
        let shares = mix.shares();
        (0..shares.kinds() as u8).map(|k| shares.of(k)).collect()
    });
    // Of all points, then of each kind, around those of the first number of steps.
    let mut windows: Vec<Windows> = Vec::new();
    for (&steps, row) in steps.iter().zip(rows) {
        let set = set.clone().settle(steps)?;
        let members = square(&set, corner, side)?;
        let points = places(&members);
        let of_kind = |kind: usize| {
            let is_own = |p: &&Point| set.kind_of(p.id) == Some(kind as u8);
            members.iter().filter(is_own).map(Point::at).collect()
        };
        let kinds = parts.iter().enumerate();
        let kinds = kinds.map(|(kind, part)| (*part, of_kind(kind)));
        row.low.resize(1 + parts.len(), Vec::new());
        for (i, (part, own)) in [(1.0, points.clone())].into_iter().chain(kinds).enumerate() {
            if windows.len() == i {
                windows.push(Windows::new(&of_part(part), &own, for_windows));
            }
            row.low[i].extend(windows[i].low(&own));
        }
        let mut near = Near::of(&ground, &points);
        near.plain /= all.least_distance();
        row.near.push(near);
        row.counts.push(count(&boxes, &points));
        match case.kind {
            Kind::Constant(share) => {
                let window = Sample::window(side, share, points);
                let spectrum = Spectrum::of(&window, 1.0);
                row.whole.push(spectrum.summary(RING).low_power);
                row.tall.push(tallest(&spectrum, window.side()));
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
    /// Of all points, then of each kind.
    low: Vec<Vec<f64>>,
    whole: Vec<f64>,
    tall: Vec<f64>,
    near: Vec<Near>,
    counts: Vec<[Octave; 10]>,
    profile: Profile,
}

impl Row {
    fn print(&self, name: &str) {
        let mut low = self.low[0].clone();
        low.sort_by(f64::total_cmp);
        let median = low.get(low.len() / 2).copied().unwrap_or(f64::NAN);
        let near = |of: fn(&Near) -> f64| self.near.iter().map(of);
        let mean = |of: fn(&Near) -> f64| average(near(of))[0];
        let sum = |of: fn(&Octave) -> f64| self.counts.as_flattened().iter().map(of).sum::<f64>();
        let bias = |octaves: &[Octave]| {
            let sum = |of: fn(&Octave) -> f64| octaves.iter().map(of).sum::<f64>();
            100.0 * (sum(|o| o.found) / sum(|o| o.expected) - 1.0)
        };
        let [all, error] = average(self.counts.iter().map(|octaves| bias(octaves)));
        let numbers = [
            average(low.iter().copied())[0],
            median,
            near(|near| near.least).fold(f64::INFINITY, f64::min),
            mean(|near| near.hundredth),
            mean(|near| near.mean),
            near(|near| near.pairs).sum(),
            near(|near| near.plain).fold(f64::INFINITY, f64::min),
            sum(|o| o.errors) / sum(|o| o.boxes),
            all,
            error,
            average(self.whole.iter().copied())[0],
            average(self.tall.iter().copied())[0],
        ];
        figures::row(name, &numbers);
        for (kind, low) in self.low[1..].iter().enumerate() {
            let [mean, _] = average(low.iter().copied());
            figures::row(format!("{name}, kind {kind}"), &[mean]);
        }
        let octaves = (0..10).flat_map(|octave| {
            let each = self.counts.iter().map(|octaves| octaves[octave]);
            let each = each.filter(|octave| octave.boxes >= 16.0);
            average(each.map(|octave| bias(&[octave])))
        });
        let octaves: Vec<f64> = octaves.filter(|v| !v.is_nan()).collect();
        figures::row(format!("{name}, bias by octave"), &octaves);
        self.profile.print(name);
    }
}

/// The mean, and its standard error.
fn average(all: impl Iterator<Item = f64>) -> [f64; 2] {
    let all: Vec<f64> = all.collect();
    let number = all.len() as f64;
    let mean = all.iter().sum::<f64>() / number;
    let squares: f64 = all.iter().map(|v| (v - mean).powi(2)).sum();
    [mean, (squares / number / (number - 1.0).max(1.0)).sqrt()]
}

/// The tallest mode below ν = 0.8, over the mean of its ring.
fn tallest(spectrum: &Spectrum, side: f64) -> f64 {
    let most = (0.8 * side) as i64;
    let mut rings = vec![(0.0, 0.0, 0.0f64); (0.8 / RING) as usize + 1];
    for (kx, ky) in (-most..=most).flat_map(|kx| (-most..=most).map(move |ky| (kx, ky))) {
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
    let over = rings.iter().filter(|ring| ring.0 > 0.0);
    let over = over.map(|(count, sum, most)| most * count / sum);
    over.fold(0.0, f64::max)
}
