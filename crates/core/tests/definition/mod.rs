//! Where points settle, by docs/algorithm.md alone and slowly.

use strew_core::{Placement, Point, PointId, PointSet, Region, Table};

/// The steps of docs/algorithm.md: ρ, a, γ, b.
fn kernels(steps: u32) -> Vec<[f32; 4]> {
    match steps {
        1 => vec![[2.395, 0.7388, 0.999, 0.605]],
        2 => vec![[2.29, 0.8121, 1.134, 0.5273], [2.403, 0.7474, 0.836, 0.7]],
        3 => vec![
            [1.605, 0.8757, 1.108, 0.4764],
            [2.531, 0.7804, 1.094, 0.5891],
            [2.462, 0.7751, 0.788, 0.8081],
        ],
        _ => vec![
            [2.312, 0.7987, 1.165, 0.7855],
            [1.832, 0.8284, 0.797, 0.8006],
            [2.544, 0.8413, 1.0, 0.0],
            [2.772, 0.7313, 0.836, 0.3755],
        ],
    }
}

/// The steps of sets with kinds whose points push each other: ρ, a, γ, b of all points, and ρ, a of those of a kind.
fn kernels_with_kinds(steps: u32) -> Vec<([f32; 4], [f32; 2])> {
    match steps {
        1 => vec![([2.3, 0.7141, 0.97, 0.6481], [2.3, 0.4949])],
        2 => vec![
            ([2.0, 0.7579, 0.93, 0.5831], [2.32, 0.5886]),
            ([2.28, 0.8002, 0.8, 0.8544], [2.35, 0.5623]),
        ],
        3 => vec![
            ([1.707, 0.8447, 1.004, 0.5158], [2.453, 0.5772]),
            ([2.359, 0.7395, 1.021, 0.584], [2.359, 0.6181]),
            ([2.422, 0.7208, 0.761, 0.8591], [2.392, 0.5285]),
        ],
        _ => vec![
            ([1.635, 0.8069, 0.885, 0.6309], [2.101, 0.8467]),
            ([2.277, 0.8923, 0.944, 0.6285], [2.479, 0.6602]),
            ([2.008, 0.6801, 0.866, 0.4087], [2.159, 0.5849]),
            ([2.499, 0.767, 0.72, 0.8149], [2.31, 0.4356]),
        ],
    }
}

/// The part of all points that a kind has, if its points push each other.
fn part(table: &Table, kind: u8) -> Option<f64> {
    let part = table.mix()?.shares().of(kind);
    (0.125..=0.8).contains(&part).then_some(part)
}

/// The step of sets with all points.
const NEAR: [f32; 4] = [0.8, 1.249, 0.8, 0.0];

/// A move of the near step, from the offsets of all other points: no approach by more than half of what separates two
/// points from the least distance `clear`.
fn limited(go: [i64; 2], offsets: &[[i64; 2]], clear: f64, reach: f64) -> [i64; 2] {
    let surely = 1.0 - 1.0 / 262_144.0;
    let free = |far: f64| (far * surely - clear - 4.0).max(0.0) * 0.5;
    let go = go.map(|v| v as f64);
    let offsets = offsets.iter().map(|offset| offset.map(|v| v as f64));
    let length = |[x, y]: [f64; 2]| (x * x + y * y).sqrt();
    let near: Vec<[f64; 2]> = offsets
        .filter(|offset| length(*offset) > 0.0 && length(*offset) < reach)
        .collect();
    let along = |go: [f64; 2], [x, y]: [f64; 2]| go[0] * x + go[1] * y;
    let part = near
        .iter()
        .map(|&offset| (along(go, offset) / length(offset), length(offset)))
        .filter(|(approach, far)| *approach > 0.0 || free(*far) == 0.0)
        .map(|(approach, far)| free(far) / approach.max(1e-9))
        .fold((free(reach) / length(go)).min(1.0), f64::min);
    let go = go.map(|v| (v * part).trunc());
    let is_clear = near
        .iter()
        .all(|&offset| along(go, offset) <= free(length(offset)) * length(offset));
    if is_clear {
        go.map(|v| v as i64)
    } else {
        [0; 2]
    }
}

/// A point of the reference.
struct Placed {
    id: PointId,
    /// In units of 128 fixed-point units, and the fixed-point units below these.
    at: [i64; 2],
    placed: [i64; 2],
    below: [i64; 2],
    world: [f64; 2],
    share: f64,
    freedom: f32,
    kind: Option<u8>,
}

/// Where a point with a near neighbor goes in a set with kinds that push: past it. `None` if it would leave its box.
fn past(
    points: &[Placed],
    own: &Placed,
    wish: [f32; 2],
    (whole, half): (f32, &dyn Fn(f32) -> f32),
) -> Option<[i64; 2]> {
    let offset = [0, 1].map(|i| (own.at[i] - own.placed[i]) as f32);
    let mut go = [0, 1].map(|i| (offset[i] + wish[i]).clamp(-whole, whole) - offset[i]);
    let length = (go[0] * go[0] + go[1] * go[1]).sqrt();
    let mut near: Vec<(f32, [f32; 2])> = points
        .iter()
        .map(|other| {
            let d = [0, 1].map(|i| (own.at[i] - other.at[i]) as f32);
            (d[0] * d[0] + d[1] * d[1], d)
        })
        .filter(|(squared, _)| *squared > 0.0)
        .collect();
    near.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    let &[(first, d), (second, _), ..] = near.as_slice() else {
        return None;
    };
    if length <= half(first.sqrt()) {
        return None;
    }
    let most = half(second.sqrt());
    if length > most {
        go = go.map(|v| v * (most / length));
    }
    let (distance, most) = (first.sqrt(), half(first.sqrt()));
    let toward = -(go[0] * d[0] + go[1] * d[1]) / distance;
    if toward > most {
        let back = (toward - most) / distance;
        go = [go[0] + back * d[0], go[1] + back * d[1]];
    }
    let is_inside = (0..2).all(|i| (offset[i] + go[i]).abs() <= whole);
    is_inside.then(|| [0, 1].map(|i| own.at[i] + go[i].round_ties_even() as i64))
}

/// Where the points of a box settle, by the definition alone: all points of the box step together, with all pairs.
/// Points nearer to its rim than the reach of the steps are wrong.
pub fn reference(set: &PointSet, shares: &dyn Fn([f64; 2]) -> f64, region: Region) -> Vec<Point> {
    let still = set.clone().settle(0).expect("0");
    let points = still.within(region).expect("near").to_vec();
    let kinds = points.iter().map(|point| set.kind_of(point.id)).collect();
    let side = set.table().alpha().set_side_f64();
    // In fields points settle as well, but no distance is promised.
    let is_near = set.least_distance() > 0.0 && set.placement().keep.get() == 1.0;
    let step = set.placement().spacing.get() * side / f64::from(1u32 << 20);
    let by = (set.table(), set.placement(), is_near);
    reference_of(by, (points, kinds), [side, step], shares)
}

/// Where points that are listed with their kinds settle, in a pattern with a mean spacing of 1/`side` grid units, in
/// fixed-point units of `step`.
pub fn reference_of(
    (table, placement, is_near): (&Table, Placement, bool),
    (still, kinds): (Vec<Point>, Vec<Option<u8>>),
    [side, step]: [f64; 2],
    shares: &dyn Fn([f64; 2]) -> f64,
) -> Vec<Point> {
    let Placement {
        spacing,
        keep,
        settle,
        warp,
        ..
    } = placement;
    let unit = f64::from(1u32 << 20) / side;
    let share = |at: [f64; 2]| {
        let share = shares(at);
        if share > 0.0 {
            share.min(1.0) * keep.get()
        } else {
            0.0
        }
    };
    let mut points: Vec<Placed> = Vec::new();
    for (point, kind) in still.into_iter().zip(kinds) {
        let world = point.at();
        let at = world.map(|v| (v / step).round() as i64);
        assert_eq!(at.map(|v| v as f64 * step), world);
        let own = share(world);
        let around = |far: f64| {
            let far = far * spacing.get() / own.max(1.0 / 400.0).sqrt();
            let [x, y] = world;
            [[x - far, y], [x + far, y], [x, y - far], [x, y + far]]
                .iter()
                .map(|at| (share(*at) - own).abs() / own)
                .fold(0.0, f64::max)
        };
        let e = (around(1.0) / 0.4).max(around(1.8) / 0.7);
        let part = if e <= 0.35 {
            1.0
        } else if e < 4.0 {
            1.0 / (1.0 + (e * e) * (e * e))
        } else {
            0.0
        };
        let is_sparse = own < 1.0 / 1600.0;
        let inside = if is_sparse {
            0.0
        } else {
            (256.0 * (1.0 - own)).clamp(0.0, 1.0)
        };
        let inside = if is_near { 1.0 } else { inside };
        points.push(Placed {
            id: point.id,
            at: at.map(|k| k >> 7),
            placed: at.map(|k| k >> 7),
            below: at.map(|k| k & 127),
            world,
            share: own,
            freedom: (part * inside) as f32,
            kind,
        });
    }
    let unit_of_table = f64::from(1u32 << 20) / table.alpha().set_side_f64();
    let certified = table.least_distance().with_warp(warp) * unit_of_table / 128.0;
    let clear = if is_near { 0.0 } else { certified as f32 };
    let reach_of_near = f64::from(NEAR[0]) * unit / 128.0;
    let unit = (unit / 128.0) as f32;
    let kinds = table.mix().map_or(0, |mix| mix.shares().kinds() as u8);
    let has_kin = !is_near && (0..kinds).any(|kind| self::part(table, kind).is_some());
    let steps = if has_kin {
        kernels_with_kinds(settle.steps())
    } else {
        let all = if is_near {
            vec![NEAR]
        } else {
            kernels(settle.steps())
        };
        all.into_iter().map(|all| (all, [1.0, 0.0])).collect()
    };
    for ([reach, push, near, guard], [kin_reach, kin_push]) in steps {
        let [by_reach, by_near] = [reach, near].map(|r| 0.5 / (r * r * unit * unit));
        let weight = by_reach * push;
        let ratio = by_near * guard / weight;
        let moved: Vec<[i64; 2]> = points
            .iter()
            .map(|own| {
                let share = own.share.max(1.0 / 400.0) as f32;
                let mut sum = [0i32; 2];
                let mut nearest = f32::INFINITY;
                let part = own.kind.and_then(|kind| self::part(table, kind));
                let mut of_kin = [0i32; 2];
                for other in &points {
                    let [dx, dy] = [0, 1].map(|i| (own.at[i] - other.at[i]) as f32);
                    let squared = dx * dx + dy * dy;
                    let weights = [share, other.share.max(1.0 / 400.0) as f32].map(|s| s * weight);
                    let scaled = squared * (weights[0] + weights[1]);
                    let u = (push - scaled).max(0.0);
                    let v = (guard - scaled * ratio).max(0.0);
                    if squared > 0.0 {
                        nearest = nearest.min(squared);
                    }
                    let u = u * u;
                    let force = u * u + v * v;
                    let whole = |push: f32| push.round_ties_even() as i32;
                    sum[0] = sum[0].wrapping_add(whole(dx * force));
                    sum[1] = sum[1].wrapping_add(whole(dy * force));
                    if let Some(part) = part.filter(|_| has_kin && own.kind == other.kind) {
                        let counted =
                            |p: &Placed| (part * p.share.max(1.0 / 400.0)).max(1.0 / 800.0) as f32;
                        let by_reach = 0.5 / (kin_reach * kin_reach * unit * unit);
                        let strength =
                            1.0 / (part * part * part).sqrt().sqrt().sqrt().sqrt().sqrt();
                        let push = (f64::from(kin_push) * strength) as f32;
                        let weights = [own, other].map(|p| counted(p) * (by_reach * push));
                        let u = (push - squared * (weights[0] + weights[1])).max(0.0);
                        let u = u * u;
                        let force = u * u;
                        of_kin[0] = of_kin[0].wrapping_add(whole(dx * force));
                        of_kin[1] = of_kin[1].wrapping_add(whole(dy * force));
                    }
                }
                if own.freedom == 0.0 {
                    return own.at;
                }
                let spacing = unit / share.sqrt();
                let mut freedom = own.freedom;
                if has_kin {
                    let most = (0.15 * spacing) as i32;
                    for (sum, kin) in sum.iter_mut().zip(of_kin) {
                        *sum = sum.wrapping_add(kin.clamp(-most, most));
                    }
                    let near = 1.0 - nearest / (0.4 * spacing * spacing);
                    let near = (2.0 * near.max(0.0)).min(1.0);
                    freedom += (freedom.sqrt().sqrt() - freedom) * near;
                }
                let mut go = sum.map(|v| (v as f32 * freedom).clamp(-0.3 * spacing, 0.3 * spacing));
                let wish = go;
                let far = (reach * spacing).min(nearest.sqrt());
                let half = |distance: f32| {
                    ((distance * (1.0 - 1.0 / 262_144.0) - clear) * 0.5 - 2.0).max(0.0)
                };
                let free = half(far);
                let length = (go[0] * go[0] + go[1] * go[1]).sqrt();
                if clear > 0.0 && length > free {
                    go = go.map(|v| v * (free / length));
                }
                if has_kin && clear > 0.0 && length > half(nearest.sqrt()) {
                    let whole = 0.4 * spacing;
                    if let Some(at) = past(&points, own, wish, (whole, &half)) {
                        return at;
                    }
                }
                let to = [0, 1].map(|i| {
                    let whole = |v: f32| i64::from(v.round_ties_even() as i32);
                    let offset = own.at[i] + whole(go[i]) - own.placed[i];
                    let most = 0.4 * spacing;
                    own.placed[i] + whole((offset as f32).clamp(-most, most))
                });
                let go = [0, 1].map(|i| to[i] - own.at[i]);
                if !is_near || go == [0; 2] {
                    return to;
                }
                let offset = |other: &Placed| [0, 1].map(|i| other.at[i] - own.at[i]);
                let offsets: Vec<[i64; 2]> = points.iter().map(offset).collect();
                let go = limited(go, &offsets, certified, reach_of_near);
                [0, 1].map(|i| own.at[i] + go[i])
            })
            .collect();
        for (point, to) in points.iter_mut().zip(moved) {
            point.at = to;
        }
    }
    let world = |point: &Placed| [0, 1].map(|i| (point.at[i] * 128 + point.below[i]) as f64 * step);
    let back = |point: &Placed| {
        let there = share(world(point));
        there < 0.5 * point.share || there > 2.0 * point.share
    };
    points
        .iter()
        .map(|point| {
            let at = if point.freedom > 0.0 && back(point) {
                point.world
            } else {
                world(point)
            };
            let [x, y] = at;
            Point { id: point.id, x, y }
        })
        .collect()
}
