//! Makes mixes and measures them on twins they were not made with. `--time` prints how long labels take, and measures
//! nothing.
//!
//! `--draw` draws kinds by chance, by labels and of a joint table side by side instead, in squares as they are served,
//! with a seed and its warp: `--side` is that of a square in mean spacings, `--pixels` those of a spacing.

use std::{path::Path, time::Instant};

use strew_core::{PointId, PointSet, Table, table::Shares};
use strew_forge::{MixJob, MixOutcome, labels, mix, numeric::SplitMix};

use crate::{
    Outcome,
    arguments::Arguments,
    figures,
    paint::{self, Panel},
    sets::{CORNER, square},
};

pub const USAGE: &str =
    "TABLE SHARES… [--joint] [--time] [--draw OUT.png [--side 26] [--pixels 12]]";

/// The colors of the background and of the kinds, the rarest first.
const PALETTE: [[u8; 3]; 6] = [
    [255, 255, 255],
    [20, 60, 150],
    [230, 120, 0],
    [120, 180, 90],
    [190, 30, 90],
    [90, 90, 90],
];
/// Steps between a kind's color and white, for smooth edges.
const SHADES: usize = 4;
const SEED: u64 = 5;

pub fn study(mut arguments: Arguments) -> Outcome {
    let [is_joint, times] = ["--joint", "--time"].map(|flag| arguments.has(flag));
    let out = arguments.after("--draw");
    let side: f64 = arguments.value("--side", "26")?;
    let pixels: f64 = arguments.value("--pixels", "12")?;
    let table = arguments.table()?;
    for shares in arguments.rest()? {
        let shares: Shares = shares.parse()?;
        if let Some(out) = &out {
            return draw(&table, &shares, side, pixels, Path::new(out));
        }
        let began = Instant::now();
        if times {
            labels(&table, &shares, &())?;
            println!("{shares}: {:.2?}", began.elapsed());
            continue;
        }
        let make = if is_joint {
            MixJob::joint
        } else {
            MixJob::labels
        };
        let made = made(&table, &make(shares.clone()))?;
        let (accepted, digest) = (made.accepted, made.table.digest());
        let took = began.elapsed();
        println!("{shares}: accepted {accepted}, {took:.2?}, {digest}\n");
        figures::print_head(&["share_error"]);
        for measured in &made.figures {
            let error = measured.value("share_error").unwrap_or(f64::NAN);
            figures::print(measured, &[error]);
        }
        for complaint in &made.complaints {
            println!("\nmissed: {complaint}");
        }
    }
    Ok(())
}

/// Makes a mix.
pub fn made(table: &Table, job: &MixJob) -> Outcome<MixOutcome> {
    Ok(mix(table, job, &())?.ok_or("stopped")?)
}

fn draw(table: &Table, shares: &Shares, side: f64, pixels: f64, out: &Path) -> Outcome {
    let panel = |table: &Table, kind: &dyn Fn(&PointSet, PointId) -> Option<u8>| {
        let set = PointSet::new(table.clone()).seed(SEED);
        let mut panel = Panel::blank([(side * pixels) as usize; 2], 0.0);
        for point in square(&set, CORNER, side)? {
            let first = SHADES * usize::from(kind(&set, point.id).ok_or("no kind")?);
            let at = point.at().map(|v| v * pixels);
            panel.disk(at, 0.34 * pixels, |color, covered| {
                let shade = (covered * SHADES as f64).round() as usize;
                if shade > 0 {
                    *color = (first + shade) as f64 / 255.0;
                }
            });
        }
        Outcome::Ok(panel)
    };
    let labeled = labels(table, shares, &())?.ok_or("stopped")?;
    let joint = made(table, &MixJob::joint(shares.clone()))?.table;
    let panels = [
        panel(table, &|_, id| by_chance(shares, id))?,
        panel(&labeled, &PointSet::kind_of)?,
        panel(&joint, &PointSet::kind_of)?,
    ];
    let [paper, kinds @ ..] = PALETTE;
    let mixed = |color: [u8; 3], shade: usize| {
        let part = shade as f64 / SHADES as f64;
        [0, 1, 2].map(|i| (f64::from(color[i]) * part + f64::from(paper[i]) * (1.0 - part)) as u8)
    };
    let colors = kinds
        .iter()
        .flat_map(|&color| (1..=SHADES).map(move |shade| mixed(color, shade)));
    let palette = [paper].into_iter().chain(colors).flatten().collect();
    paint::write(out, &panels, [3, 8], 8, Some(palette))
}

/// A kind drawn by a hash of the id.
fn by_chance(shares: &Shares, id: PointId) -> Option<u8> {
    let mut random = SplitMix::new(id.x as u64);
    let mut random = SplitMix::new(random.next_u64() ^ id.y as u64);
    let mut drawn = random.next_f64();
    (0..shares.kinds() as u8).find(|&kind| {
        drawn -= shares.of(kind);
        drawn < 0.0
    })
}
