//! Kinds whose shares vary from place to place: the variance of the number of points of a kind in boxes, over what it
//! would be if each point had its kind by chance. Shares are waves of 60 spacings; boxes hold 25 and 100 points; seed 7
//! with its warp, 500 × 500 spacings.

use std::{f64::consts::TAU, sync::Arc, time::Instant};

use strew_core::{Field, PointSet, VaryingKinds};
use strew_forge::second_order;

use crate::{Arguments, Outcome, figures, ground::square};

/// The side of the square that is measured, in spacings.
const SIDE: f64 = 500.0;

type Fields = Vec<Arc<dyn Field>>;

pub fn study(mut arguments: Arguments) -> Outcome {
    let table = arguments.table()?;
    let began = Instant::now();
    let ranks = second_order(&table, &())?.ok_or("stopped")?;
    println!("The second order took {:.2?}.", began.elapsed());
    let order = table.with_ranks(ranks)?;
    let rest = |other: &Arc<dyn Field>, height| -> Arc<dyn Field> {
        let other = other.clone();
        Arc::new(move |at: [f64; 2]| height - other.share(at))
    };
    let two = wave(0.5, 0.45, 0.3);
    let first = wave(0.45, 0.3, 0.0);
    // Of equal parts the kinds lie in the order first, third, second.
    let rare = vec![first.clone(), rest(&first, 0.95), wave(0.05, 0.04, 1.6)];
    let four = [0.0, 0.8, 1.6, 2.4].map(|angle| wave(0.25, 0.22, angle));
    figures::head("kinds | points | box | each kind | | | ");
    for (name, fields) in [
        ("two", vec![two.clone(), rest(&two, 1.0)]),
        ("0.45, 0.5 and a rare one in the middle", rare),
        ("four", four.to_vec()),
    ] {
        let parts = vec!["1"; fields.len()].join(":");
        let some = fields.iter().cloned().map(Some).collect();
        let kinds = VaryingKinds::new(&order, parts.parse()?, some)?;
        let whole = PointSet::new(table.clone()).seed(7);
        let whole = whole.with_varying_kinds(kinds)?;
        let slope = wave(0.55, 0.4, 0.8);
        let slope = move |at: [f64; 2]| slope.share(at);
        for (thinning, set) in [
            ("all", whole.clone()),
            ("keep 0.5", whole.clone().keep(0.5)?),
            ("keep 0.3", whole.clone().keep(0.3)?),
            ("in a field", whole.in_field(slope)),
        ] {
            for side in [5.0, 10.0] {
                let subject = format!("{name} | {thinning} | {side}²");
                figures::row(subject, &ratios(&set, &fields, side)?);
            }
        }
    }
    Ok(())
}

/// A wave of the share of a kind around a mean.
fn wave(mean: f64, height: f64, angle: f64) -> Arc<dyn Field> {
    let (along, across) = (angle.cos() / 60.0, angle.sin() / 60.0);
    Arc::new(move |[x, y]: [f64; 2]| mean + height * (TAU * (x * along + y * across)).sin())
}

/// The variance of the counts of each kind over that of chance.
fn ratios(set: &PointSet, fields: &Fields, side: f64) -> Outcome<Vec<f64>> {
    let boxes = (SIDE / side) as usize;
    let mut off = vec![vec![0.0; boxes * boxes]; fields.len()];
    let mut chance = vec![0.0; fields.len()];
    for point in square(set, [0.0; 2], SIDE)? {
        let [column, row] = point.at().map(|v| ((v / side) as usize).min(boxes - 1));
        let kind = set.kind_of(point.id).ok_or("no kind")?;
        let weights: Vec<f64> = fields.iter().map(|field| field.share(point.at())).collect();
        let total: f64 = weights.iter().sum();
        for (own, weight) in weights.iter().enumerate() {
            let share = weight / total;
            let is_own = f64::from(u8::from(usize::from(kind) == own));
            off[own][row * boxes + column] += is_own - share;
            chance[own] += share * (1.0 - share);
        }
    }
    let squares = off.iter().map(|off| off.iter().map(|v| v * v).sum::<f64>());
    let ratios = squares
        .zip(chance)
        .map(|(squares, chance)| squares / chance);
    Ok(ratios.collect())
}
