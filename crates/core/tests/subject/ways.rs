//! Every way to the points of a set agrees. This file is a module of the plane and one of space.

use proptest::prelude::*;
use strew_core::{Backend, ErrorKind, F32, F64, Points};

use super::*;

/// How points are taken in parts.
#[derive(Clone, Copy, Debug)]
pub struct Parts {
    /// Points per block.
    pub block: usize,
    /// Points per tile, at most.
    pub tile: usize,
    /// Where a window begins, as a part of all.
    pub offset: f64,
    /// The limit of the window.
    pub limit: usize,
    /// The number of equal parts.
    pub number: u32,
}

pub fn any_parts() -> impl Strategy<Value = Parts> {
    let tile = prop_oneof![1usize..500, 1usize..3000];
    let offset = prop_oneof![0.0..=1.0f64, 0.0..1.2f64];
    (1usize..500, tile, offset, 0usize..500, 1u32..9).prop_map(
        |(block, tile, offset, limit, number)| Parts {
            block,
            tile,
            offset,
            limit,
            number,
        },
    )
}

pub fn read<F: Format>(mut blocks: Blocks<F>, block: usize) -> Vec<F::Item> {
    let mut buffer = vec![F::Item::default(); block];
    let mut items = Vec::new();
    loop {
        let filled = blocks.fill(&mut buffer);
        items.extend_from_slice(&buffer[..filled]);
        if filled < block {
            return items;
        }
    }
}

pub fn all<F: Format>(plan: &Plan, block: usize) -> Vec<F::Item> {
    read(plan.blocks::<F>(), block)
}

pub fn all_by<F: Format>(plan: &Plan, block: usize, backend: Backend) -> Vec<F::Item> {
    read(plan.blocks::<F>().with_backend(backend), block)
}

/// The box between two corners.
pub fn between(min: [f64; D], max: [f64; D]) -> Region {
    Region::new(min, max).expect("ordered")
}

/// The square or cube with its lower corner at a place.
pub fn cube(min: [f64; D], side: f64) -> Region {
    between(min, min.map(|v| v + side))
}

/// A box and what is within a distance along each axis.
pub fn around(region: Region, distance: f64) -> Region {
    between(
        region.min().map(|v| v - distance),
        region.max().map(|v| v + distance),
    )
}

pub fn within(set: &Set, area: impl Into<Area>) -> Vec<Point> {
    set.within(area).expect("near").to_vec()
}

pub fn in_order(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by_key(|point| order(point.id));
    points
}

pub fn squared(a: [f64; D], b: [f64; D]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    apart.reduce(|sum, square| sum + square).expect("axes")
}

/// The points of an area in order, looked for at each address up to `reach` around it.
pub fn brute_force(
    set: &Set,
    area: &Area,
    reach: i64,
    place: impl Fn(PointId) -> Option<[f64; D]>,
) -> Vec<Point> {
    let bounds = area.bounds().expect("bounded");
    let unit = set.placement().spacing.get() * set.table().map().alpha().set_side_f64();
    let low = bounds.min().map(|v| (v / unit).floor() as i64 - reach);
    let high = bounds.max().map(|v| (v / unit).floor() as i64 + reach + 1);
    let mut points = Vec::new();
    let mut at = low;
    while at[D - 1] < high[D - 1] {
        let id = id(at);
        let place = place(id).filter(|place| area.contains(*place));
        points.extend(place.map(|place| placed(id, place)));
        at[0] += 1;
        for axis in 1..D {
            if at[axis - 1] == high[axis - 1] {
                at[axis - 1] = low[axis - 1];
                at[axis] += 1;
            }
        }
    }
    in_order(points)
}

/// Checks every way to the points of an area: blocks, windows, cursors, splits and ids.
pub fn agree(set: &Set, area: impl Into<Area>, points: &[Point], parts: Parts) {
    let area = area.into();
    let plan = set.within(area.clone()).expect("near");
    assert_eq!(plan.count(), points.len() as u128);
    assert_eq!(set.count(area.clone()), Ok(plan.count()));
    assert!(points.is_sorted_by(|a, b| order(a.id) < order(b.id)));
    assert_eq!(plan.to_vec(), points);
    assert!(plan.iter().map(Point::from).eq(points.iter().copied()));
    assert_eq!(plan.iter().fold(0, |n, _| n + 1), points.len());
    let mut members = plan.iter();
    for left in (0..points.len()).rev().take(100) {
        assert_eq!((members.next().is_some(), members.len()), (true, left));
    }
    let places: Vec<[f64; D]> = points.iter().map(Point::at).collect();
    let singles = all_by::<F32>(&plan, 99, Backend::Scalar);
    for backend in Backend::available() {
        assert_eq!(all_by::<Points>(&plan, parts.block, backend), points);
        assert_eq!(all_by::<F64>(&plan, parts.block, backend), places);
        assert_eq!(all_by::<F32>(&plan, parts.block, backend), singles);
    }
    for point in points.iter().step_by(points.len() / 50 + 1) {
        assert_eq!(set.point(point.id).map(Point::from), Some(*point));
    }
    agree_in_windows(set, &area, &plan, points, parts);
    agree_otherwise(&plan, points, parts);
}

fn agree_in_windows(set: &Set, area: &Area, plan: &Plan, points: &[Point], parts: Parts) {
    let resume = |cursor| set.resume(area.clone(), cursor).expect("near");
    let few = |from: usize, number: usize| {
        let from = from.min(points.len());
        &points[from..points.len().min(from + number)]
    };
    let offset = (parts.offset * points.len() as f64) as usize;
    let window = plan.window(offset as u128, Some(parts.limit as u128));
    let inside = few(offset, parts.limit);
    let offset = offset.min(points.len());
    let end = offset + inside.len();
    assert_eq!(window.count(), inside.len() as u128);
    assert_eq!(all::<Points>(&window, 7), inside);
    assert_eq!(all::<F32>(&window, 7), all::<F32>(plan, 100)[offset..end]);

    // What begins at a cursor is found again without counting.
    let id = |cursor: Option<Cursor>| cursor.map(|cursor| cursor.at);
    let [first, next] = [window.cursor(), window.next_cursor()];
    assert_eq!(id(first), inside.first().map(|point| point.id));
    assert_eq!(id(next), points.get(end).map(|point| point.id));
    assert!(next.is_none_or(|cursor| cursor.offset == end as u128));
    for cursor in first.into_iter().chain(next) {
        let (rest, from) = (resume(cursor), cursor.offset as usize);
        assert_eq!(rest.count(), (points.len() - from) as u128);
        assert_eq!(all::<Points>(&rest, 100), points[from..]);
        assert_eq!(rest.window(1, Some(5)).offset(), cursor.offset + 1);
        assert_eq!(rest.window(5, Some(9)).to_vec(), few(from + 5, 9));
        let [a, b] = [
            rest.window(0, Some(7)),
            plan.window(0, Some(cursor.offset + 7)),
        ];
        assert_eq!(a.next_cursor(), b.next_cursor());
    }

    // So is what follows any block.
    for (window, offset, block, end) in [
        (&window, offset, 1 + parts.number as usize * 9, end),
        (plan, 0, parts.block.max(points.len() / 9), points.len()),
    ] {
        let mut blocks = window.blocks::<Points>();
        let mut block = vec![Point::default(); block];
        let mut written = offset;
        loop {
            let cursor = blocks.cursor();
            if let Some(cursor) = cursor {
                assert_eq!(cursor.offset, written as u128);
                let near = resume(cursor).window(0, Some(70));
                assert_eq!(all::<Points>(&near, 33), few(written, 70));
            }
            assert!(cursor.is_some() || [offset, end].contains(&written));
            let filled = blocks.fill(&mut block);
            written += filled;
            if filled == 0 {
                break;
            }
        }
        assert_eq!(written, end);
    }

    let split: Vec<Plan> = plan.split(parts.number).collect();
    assert_eq!(split.len(), parts.number as usize);
    let sizes = || split.iter().map(Plan::count);
    assert!(sizes().max().expect("some") - sizes().min().expect("some") <= 1);
    let union = split.iter().flat_map(|part| all::<Points>(part, 64));
    assert!(union.eq(points.iter().copied()));

    let limit = plan.count() / u128::from(parts.number) + 1;
    let mut page = plan.window(0, Some(limit));
    let mut pages = page.to_vec();
    while let Some(cursor) = page.next_cursor() {
        page = resume(cursor).window(0, Some(limit));
        pages.extend(page.to_vec());
    }
    assert_eq!(pages, points);
}

/// An exact number of points is found, if the area holds it, and its points are the first of the set at its spacing.
pub fn agree_in_number(set: &Set, area: &Area, count: u128) {
    let found = || exactly(set, count, area, 0.02);
    let Ok(plan) = found() else {
        return;
    };
    assert_eq!((plan.count(), plan.to_vec().len() as u128), (count, count));
    assert_eq!(found().map(|again| again.placement()), Ok(plan.placement()));
    let same = set.clone().placed(plan.placement());
    let points = within(&same, area.clone());
    // Rarely one more enters at this spacing; without warp those of a column, or of a side in space.
    let is_off = plan.placement().warp.is_off();
    let more = if is_off { 60usize.pow(D as u32 - 1) } else { 1 };
    assert!(points.len() - count as usize <= more, "{}", points.len());
    assert_eq!(points[..count as usize], plan.to_vec());
}

/// The nearest points of a place are those of boxes around it, in the order of distances and ids.
pub fn agree_near(set: &Set, at: [f64; D], k: usize, part: f64) {
    let pair = |n: &Neighbor| (n.member.point(), n.distance);
    let pairs = |near: Vec<Neighbor>| near.iter().map(pair).collect::<Vec<_>>();
    let nearest = pairs(set.nearest(at, k).expect("near"));
    assert_eq!(nearest.len(), k);
    let farthest = nearest.last().map_or(0.0, |near| near.1);
    let by_distance = |radius: f64| -> Vec<(Point, f64)> {
        let near = in_box(set, at, radius).into_iter();
        near.map(|(square, point)| (point, square.sqrt())).collect()
    };
    let mut all = by_distance(farthest);
    all.truncate(k);
    assert_eq!(nearest, all);
    // Within a radius there may be fewer. That of the farthest, as it is reported, finds all.
    let radius = farthest * part;
    let mut fewer = by_distance(radius);
    fewer.retain(|(_, distance)| *distance <= radius);
    let number = fewer.len();
    assert_eq!(set.around(at, radius, number).map(pairs), Ok(fewer.clone()));
    if number > 0 {
        let refused = set.around(at, radius, number - 1).expect_err("too many");
        assert_eq!(refused.kind(), ErrorKind::TooMany);
    }
    fewer.truncate(k);
    assert_eq!(set.nearest_within(at, k, radius).map(pairs), Ok(fewer));
}

/// All points of the box around a disk or ball, and their squared distances, in order.
pub fn in_box(set: &Set, at: [f64; D], radius: f64) -> Vec<(f64, Point)> {
    let rounding = at.iter().map(|v| v.abs()).sum::<f64>() * 1e-15;
    let reach = radius * 1.001 + rounding;
    let points = within(set, between(at.map(|v| v - reach), at.map(|v| v + reach)));
    let pair = |point: Point| (squared(point.at(), at), point);
    let mut all: Vec<(f64, Point)> = points.into_iter().map(pair).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.id.cmp(&b.1.id)));
    all
}

/// The points of a box that are clear of those of another set, by all pairs.
pub fn clear_by_hand(set: &Set, other: &Set, distance: f64, region: Region) -> Vec<Point> {
    let others = within(other, around(region, distance + 1.0));
    let mut points = within(set, region);
    points.retain(|point| !is_near(point, &others, distance));
    points
}

/// Whether a point is nearer to another than a distance.
pub fn is_near(point: &Point, others: &[Point], distance: f64) -> bool {
    let limit = distance * distance;
    others
        .iter()
        .any(|other| squared(other.at(), point.at()) < limit)
}

/// The points of a set that keeps clear of others, each decided by itself: a lookup searches near a single place.
pub fn one_by_one(whole: &Set, clear: &Set, area: impl Into<Area>) -> Vec<Point> {
    let mut points = within(whole, area);
    points.retain(|point| clear.point(point.id).is_some());
    points
}
