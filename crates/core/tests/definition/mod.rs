//! Where points settle, by docs/algorithm.md alone and slowly.

use std::array::from_fn;

use strew_core::{LeastDistance, Placement, table::Mix};

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

/// The steps in space.
fn kernels_in_space(steps: u32) -> Vec<[f32; 4]> {
    match steps {
        1 => vec![[2.338, 0.661, 0.942, 0.609]],
        2 => vec![[2.064, 0.693, 1.127, 0.662], [2.361, 0.672, 0.906, 0.784]],
        3 => vec![
            [1.404, 0.973, 1.118, 0.223],
            [2.181, 0.77, 0.764, 0.182],
            [2.588, 0.62, 0.867, 0.688],
        ],
        _ => vec![
            [1.727, 0.842, 1.046, 0.657],
            [2.335, 0.748, 1.088, 0.614],
            [2.586, 0.637, 0.911, 0.347],
            [2.473, 0.514, 0.966, 0.428],
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
fn part(mix: Option<&Mix>, kind: u8) -> Option<f64> {
    let part = mix?.shares().of(kind);
    (0.125..=0.8).contains(&part).then_some(part)
}

/// The step of sets with all points.
const NEAR: [f32; 4] = [0.8, 1.249, 0.8, 0.0];

/// A move of the near step, from the offsets of all other points: no approach by more than half of what separates two
/// points from the least distance `clear`.
fn limited<const D: usize>(go: [i64; D], offsets: &[[i64; D]], clear: f64, reach: f64) -> [i64; D] {
    let surely = 1.0 - 1.0 / 262_144.0;
    let free = |far: f64| (far * surely - clear - 4.0).max(0.0) * 0.5;
    let go = go.map(|v| v as f64);
    let offsets = offsets.iter().map(|offset| offset.map(|v| v as f64));
    let along = |a: [f64; D], b: [f64; D]| (1..D).fold(a[0] * b[0], |sum, i| sum + a[i] * b[i]);
    let length = |v: [f64; D]| along(v, v).sqrt();
    let near: Vec<[f64; D]> = offsets
        .filter(|offset| length(*offset) > 0.0 && length(*offset) < reach)
        .collect();
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
        [0; D]
    }
}

/// A point of the reference.
struct Placed<const D: usize> {
    /// In units of 128 fixed-point units, and the fixed-point units below these.
    at: [i64; D],
    placed: [i64; D],
    below: [i64; D],
    world: [f64; D],
    share: f64,
    /// The counted share; in space the square of its cubic root.
    counted: f32,
    freedom: f32,
    kind: Option<u8>,
}

/// Where a point with a near neighbor goes in a set with kinds that push: past it. `None` if it would leave its box.
fn past<const D: usize>(
    points: &[Placed<D>],
    own: &Placed<D>,
    wish: [f32; D],
    (whole, half): (f32, &dyn Fn(f32) -> f32),
) -> Option<[i64; D]> {
    let offset: [f32; D] = from_fn(|i| (own.at[i] - own.placed[i]) as f32);
    let mut go: [f32; D] = from_fn(|i| (offset[i] + wish[i]).clamp(-whole, whole) - offset[i]);
    let length = product(go, go).sqrt();
    let mut near: Vec<(f32, [f32; D])> = points
        .iter()
        .map(|other| {
            let d = from_fn(|i| (own.at[i] - other.at[i]) as f32);
            (product(d, d), d)
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
    let toward = -product(go, d) / distance;
    if toward > most {
        let back = (toward - most) / distance;
        go = from_fn(|i| go[i] + back * d[i]);
    }
    let is_inside = (0..D).all(|i| (offset[i] + go[i]).abs() <= whole);
    is_inside.then(|| from_fn(|i| own.at[i] + go[i].round_ties_even() as i64))
}

/// The scalar product.
fn product<const D: usize>(a: [f32; D], b: [f32; D]) -> f32 {
    (1..D).fold(a[0] * b[0], |sum, i| sum + a[i] * b[i])
}

/// What decides, together with their places, how points settle.
pub struct By<'a> {
    pub mix: Option<&'a Mix>,
    pub least: LeastDistance,
    pub placement: Placement,
    /// Whether it is the step of sets with all points.
    pub is_near: bool,
    /// The inverse of the mean spacing in grid units, and that of sets of the table.
    pub side: f64,
    pub side_of_table: f64,
    /// A fixed-point unit in world units.
    pub step: f64,
}

/// Where points that are listed with their kinds settle, by the definition alone: all step together, with all pairs.
/// Points that lack others within the reach of the steps are wrong.
pub fn reference_of<const D: usize>(
    by: By<'_>,
    (still, kinds): (Vec<[f64; D]>, Vec<Option<u8>>),
    shares: &dyn Fn([f64; D]) -> f64,
) -> Vec<[f64; D]> {
    let By {
        mix,
        least,
        placement,
        is_near,
        side,
        side_of_table,
        step,
    } = by;
    let Placement {
        spacing,
        keep,
        settle,
        warp,
        ..
    } = placement;
    let weight = |share: f64| {
        let root = libm::cbrt(share.max(1.0 / 100.0));
        if D == 2 {
            share.max(1.0 / 400.0)
        } else {
            root * root
        }
    };
    let unit = f64::from(1u32 << 20) / side;
    let share = |at: [f64; D]| {
        let share = shares(at);
        if share > 0.0 {
            share.min(1.0) * keep.get()
        } else {
            0.0
        }
    };
    let mut points: Vec<Placed<D>> = Vec::new();
    for (world, kind) in still.into_iter().zip(kinds) {
        let at = world.map(|v| (v / step).round() as i64);
        assert_eq!(at.map(|v| v as f64 * step), world);
        let own = share(world);
        let around = |far: f64| {
            let far = far * spacing.get() / weight(own).sqrt();
            let along = (0..D).flat_map(|axis| [(axis, -far), (axis, far)]);
            along
                .map(|(axis, far)| {
                    let mut at = world;
                    at[axis] += far;
                    (share(at) - own).abs() / own
                })
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
            at: at.map(|k| k >> 7),
            placed: at.map(|k| k >> 7),
            below: at.map(|k| k & 127),
            world,
            share: own,
            counted: weight(own) as f32,
            freedom: (part * inside) as f32,
            kind,
        });
    }
    let unit_of_table = f64::from(1u32 << 20) / side_of_table;
    let certified = least.with_warp(warp) * unit_of_table / 128.0;
    let clear = if is_near { 0.0 } else { certified as f32 };
    let reach_of_near = f64::from(NEAR[0]) * unit / 128.0;
    let unit = (unit / 128.0) as f32;
    let kinds = mix.map_or(0, |mix| mix.shares().kinds() as u8);
    let has_kin = !is_near && (0..kinds).any(|kind| self::part(mix, kind).is_some());
    let steps = if has_kin {
        kernels_with_kinds(settle.steps())
    } else {
        let all = if is_near {
            vec![NEAR]
        } else if D == 3 {
            kernels_in_space(settle.steps())
        } else {
            kernels(settle.steps())
        };
        all.into_iter().map(|all| (all, [1.0, 0.0])).collect()
    };
    for ([reach, push, near, guard], [kin_reach, kin_push]) in steps {
        let [by_reach, by_near] = [reach, near].map(|r| 0.5 / (r * r * unit * unit));
        let weight = by_reach * push;
        let ratio = by_near * guard / weight;
        let moved: Vec<[i64; D]> = points
            .iter()
            .map(|own| {
                let mut sum = [0i32; D];
                let mut nearest = f32::INFINITY;
                let part = own.kind.and_then(|kind| self::part(mix, kind));
                let mut of_kin = [0i32; D];
                for other in &points {
                    let d: [f32; D] = from_fn(|i| (own.at[i] - other.at[i]) as f32);
                    let squared = product(d, d);
                    let weights = [own.counted, other.counted].map(|s| s * weight);
                    let scaled = squared * (weights[0] + weights[1]);
                    let u = (push - scaled).max(0.0);
                    let v = (guard - scaled * ratio).max(0.0);
                    if squared > 0.0 {
                        nearest = nearest.min(squared);
                    }
                    let u = u * u;
                    let force = u * u + v * v;
                    let whole = |push: f32| push.round_ties_even() as i32;
                    sum = from_fn(|i| sum[i].wrapping_add(whole(d[i] * force)));
                    if let Some(part) = part.filter(|_| has_kin && own.kind == other.kind) {
                        let counted = |p: &Placed<D>| {
                            (part * p.share.max(1.0 / 400.0)).max(1.0 / 800.0) as f32
                        };
                        let by_reach = 0.5 / (kin_reach * kin_reach * unit * unit);
                        let strength =
                            1.0 / (part * part * part).sqrt().sqrt().sqrt().sqrt().sqrt();
                        let push = (f64::from(kin_push) * strength) as f32;
                        let weights = [own, other].map(|p| counted(p) * (by_reach * push));
                        let u = (push - squared * (weights[0] + weights[1])).max(0.0);
                        let u = u * u;
                        let force = u * u;
                        of_kin = from_fn(|i| of_kin[i].wrapping_add(whole(d[i] * force)));
                    }
                }
                if own.freedom == 0.0 {
                    return own.at;
                }
                let spacing = unit / own.counted.sqrt();
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
                let length = product(go, go).sqrt();
                if clear > 0.0 && length > free {
                    go = go.map(|v| v * (free / length));
                }
                if has_kin && clear > 0.0 && length > half(nearest.sqrt()) {
                    let whole = 0.4 * spacing;
                    if let Some(at) = past(&points, own, wish, (whole, &half)) {
                        return at;
                    }
                }
                let to: [i64; D] = from_fn(|i| {
                    let whole = |v: f32| i64::from(v.round_ties_even() as i32);
                    let offset = own.at[i] + whole(go[i]) - own.placed[i];
                    let most = 0.4 * spacing;
                    own.placed[i] + whole((offset as f32).clamp(-most, most))
                });
                let go = from_fn(|i| to[i] - own.at[i]);
                if !is_near || go == [0; D] {
                    return to;
                }
                let offset = |other: &Placed<D>| from_fn(|i| other.at[i] - own.at[i]);
                let offsets: Vec<[i64; D]> = points.iter().map(offset).collect();
                let go = limited(go, &offsets, certified, reach_of_near);
                from_fn(|i| own.at[i] + go[i])
            })
            .collect();
        for (point, to) in points.iter_mut().zip(moved) {
            point.at = to;
        }
    }
    let world = |point: &Placed<D>| from_fn(|i| (point.at[i] * 128 + point.below[i]) as f64 * step);
    let back = |point: &Placed<D>| {
        let there = share(world(point));
        there < 0.5 * point.share || there > 2.0 * point.share
    };
    points
        .iter()
        .map(|point| {
            if point.freedom > 0.0 && back(point) {
                point.world
            } else {
                world(point)
            }
        })
        .collect()
}
