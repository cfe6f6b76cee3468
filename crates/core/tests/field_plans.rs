//! Sets in fields: every way to their points agrees with the definition, point by point and bit for bit.

mod subject;

use std::sync::{Arc, OnceLock};

use proptest::prelude::*;
use strew_core::{
    Area, Backend, Circle, ErrorKind, F32, F64, Field, Format, Member, Offsets, Placement, Plan,
    Point, PointId, PointSet, Points, Polygon, Raster, Region, Seed, Spacing, Table, Warp,
    field::{Edges, FieldSpec, Filter, Marks, Noise, Pixels},
    server::{self, Stop},
};
use subject::{all_by, definition, shipped};

/// Blue with ranks, and a table without.
fn tables() -> &'static [Table; 2] {
    static ONCE: OnceLock<[Table; 2]> = OnceLock::new();
    ONCE.get_or_init(|| {
        [
            shipped("blue-5-sqrt3-over-2-m"),
            subject::table("sqrt(3)", 20),
        ]
    })
}

/// Pixels over a box of 128 by 96 around the origin, 1 a unit.
fn raster(pixel: impl Fn(f64, f64) -> f64) -> Raster {
    let region = Region::new([-64.0, -48.0], [64.0, 48.0]).expect("ordered");
    let value = |i: usize| {
        let [x, y] = [i % 128, i / 128].map(|v| v as f64);
        (pixel(x - 63.5, y - 47.5).clamp(0.0, 1.0) * 255.0) as u8
    };
    let pixels = Pixels::from_bytes(128, (0..128 * 96).map(value).collect());
    Raster::of(region, pixels.expect("rows")).expect("shares")
}

/// Fields with plains of 0, of 1 and of other shares, with slopes and with steps.
fn fields() -> &'static [Arc<dyn Field>] {
    static ONCE: OnceLock<Vec<Arc<dyn Field>>> = OnceLock::new();
    ONCE.get_or_init(|| {
        let hills = |x: f64, y: f64| 1.4 * (x * 0.11).sin() * (y * 0.07).cos() + 0.3;
        let mask = |x: f64, y: f64| if x.hypot(y - 9.0) < 25.0 { 1.0 } else { 0.0 };
        let of = FieldSpec::raster;
        let spec = || -> Result<Vec<FieldSpec>, strew_core::Error> {
            let road = Marks::Lines(vec![vec![[-90.0, -5.0], [0.0, 4.0], [80.0, 60.0]]]);
            let road = FieldSpec::distance(road, [2.0, 9.0], [0.0, 1.0])?;
            let noise = Noise {
                seed: 4,
                wavelength: 17.0,
                octaves: 3,
                range: [0.0, 1.0],
            };
            let noise = FieldSpec::noise(noise)?;
            Ok(vec![
                of(raster(hills))?,
                of(raster(mask).edges(Edges::Zero).filter(Filter::Nearest))?,
                of(raster(mask).edges(Edges::Mirror).tone(0.3, 0.8, 1.0)?)?,
                FieldSpec::constant(0.37)?,
                FieldSpec::constant(0.0)?,
                FieldSpec::constant(1.0)?,
                FieldSpec::ramp([-40.0, 0.0], [40.0, 9.0], [1.0, 0.01])?,
                FieldSpec::radial([0.0, 0.0], [5.0, 30.0], [0.25, 0.75])?,
                FieldSpec::multiply(vec![road, noise])?,
            ])
        };
        let mut all: Vec<Arc<dyn Field>> = Vec::new();
        for spec in spec().expect("valid") {
            all.push(Arc::new(spec));
        }
        all.push(Arc::new(move |[x, y]: [f64; 2]| hills(x, y)));
        all
    })
}

/// A field that is shared.
#[derive(Clone)]
struct Shared(Arc<dyn Field>, usize);

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "field {}", self.1)
    }
}

impl Field for Shared {
    fn share(&self, at: [f64; 2]) -> f64 {
        self.0.share(at)
    }

    fn shares(&self, places: &[[f64; 2]], shares: &mut [f64]) {
        self.0.shares(places, shares);
    }

    fn bounds(&self, within: &Region) -> [f64; 2] {
        self.0.bounds(within)
    }
}

fn any_set() -> impl Strategy<Value = (PointSet, Shared)> {
    let seed = prop_oneof![Just(0u64), any::<u64>()];
    let warp = prop_oneof![Just(0.0), Just(1.0), 0.0..2.0f64];
    let keep = prop_oneof![Just(1.0), 0.2..1.0f64];
    let parts = (0..2usize, seed, warp, 0.6..3.0f64, keep, 0..fields().len());
    parts.prop_map(|(table, seed, warp, spacing, keep, field)| {
        let placement = Placement::new(Spacing::new(spacing).expect("in range"), Seed(seed));
        let placement = placement.with_warp(Warp::new(warp).expect("in range"));
        let set = PointSet::new(tables()[table].clone()).placed(placement);
        (
            set.keep(keep).expect("a share"),
            Shared(fields()[field].clone(), field),
        )
    })
}

fn any_box() -> impl Strategy<Value = Region> {
    let corner = prop::array::uniform2(-70.0..40.0f64);
    (corner, prop::array::uniform2(0.0..45.0f64))
        .prop_map(|([x, y], [w, h])| Region::new([x, y], [x + w, y + h]).expect("ordered"))
}

fn any_area() -> impl Strategy<Value = Area> {
    let center = || prop::array::uniform2(-30.0..30.0f64);
    let ring = prop::collection::vec(center(), 3..7);
    prop_oneof![
        any_box().prop_map(Area::from),
        (center(), 1.0..25.0f64).prop_map(|(at, r)| Circle::new(at, r).expect("round").into()),
        ring.prop_filter_map("a polygon", |ring| Polygon::new(&[ring])
            .ok()
            .map(Area::from)),
        (any_box(), center(), 1.0..25.0f64).prop_map(|(region, at, r)| {
            Area::from(region).without([Circle::new(at, r).expect("round").into()])
        }),
    ]
}

/// Every point of a box by the definition, in order.
fn defined(set: &PointSet, field: &Shared, region: &Region) -> Vec<Point> {
    let unit = set.table().alpha().set_side_f64() * set.placement().spacing.get();
    let lines = |axis: usize| {
        let ends = [region.min()[axis], region.max()[axis]].map(|v| (v / unit) as i64);
        ends[0] - 160..ends[1] + 160
    };
    let mut all = Vec::new();
    for y in lines(1) {
        for x in lines(0) {
            let id = PointId { x, y };
            if let Some([x, y]) = definition::place_in(set, field, id)
                && region.contains([x, y])
            {
                all.push(Point { id, x, y });
            }
        }
    }
    all.sort_by_key(|p| (p.id.x.div_euclid(1024), p.id.y, p.id.x));
    all
}

fn items<F: Format>(plan: &Plan, block: usize) -> Vec<F::Item> {
    all_by::<F>(plan, block, Backend::best())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn a_box_holds_what_the_definition_has((set, field) in any_set(), region in any_box()) {
        let expected = defined(&set, &field, &region);
        let set = set.in_field(field).settle(0).expect("0");
        let plan = set.within(region).expect("near");
        prop_assert_eq!(plan.to_vec(), expected.clone());
        prop_assert_eq!(plan.count(), expected.len() as u128);
        for point in &expected {
            prop_assert_eq!(set.point(point.id).map(|m: Member| m.point()), Some(*point));
            prop_assert!(set.share(point.id).is_some_and(|share| set.rank(point.id) < share));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn an_area_holds_the_points_of_its_box_that_lie_in_it(
        (set, field) in any_set(), area in any_area(), block in 1usize..300, clear: bool,
    ) {
        let mut set = set.in_field(field.clone());
        if clear {
            let other = PointSet::new(tables()[0].clone()).spacing(4.0).expect("in range");
            set = set.clear_of(&other.seed(3).in_field(field), 1.5).expect("near");
        }
        let bounds = area.bounds().expect("bounded");
        let mut expected = set.within(bounds).expect("near").to_vec();
        expected.retain(|p| area.contains(p.at()));
        let plan = set.within(area).expect("near");
        prop_assert_eq!(plan.count(), expected.len() as u128);
        let pairs: Vec<[f64; 2]> = expected.iter().map(Point::at).collect();
        for backend in Backend::available() {
            prop_assert_eq!(&all_by::<Points>(&plan, block, backend), &expected);
            prop_assert_eq!(&all_by::<F64>(&plan, block, backend), &pairs);
            prop_assert_eq!(
                all_by::<F32>(&plan, block, backend), all_by::<F32>(&plan, 99, Backend::Scalar)
            );
        }
        let from_tiles = plan.tiles(300).flat_map(|tile| {
            let mut all = vec![Point::default(); expected.len() + 1];
            let filled = plan.tile_blocks::<Points>(&tile).fill(&mut all);
            all.truncate(filled);
            all
        });
        prop_assert!(from_tiles.eq(expected.iter().copied()));
    }

    #[test]
    fn windows_and_cursors_are_parts(
        (set, field) in any_set(), area in any_area(), parts in 1u32..7, offset in 0.0..1.2f64,
        limit in 0u128..400, block in 1usize..300,
    ) {
        let set = set.in_field(field);
        let plan = set.within(area.clone()).expect("near");
        let all = plan.to_vec();
        let split: Vec<Point> = plan.split(parts).flat_map(|part| part.to_vec()).collect();
        prop_assert_eq!(&split, &all);
        let offset = (offset * all.len() as f64) as u128;
        let window = plan.window(offset, Some(limit));
        let rest = &all[(offset as usize).min(all.len())..];
        prop_assert_eq!(window.to_vec(), &rest[..rest.len().min(limit as usize)]);
        // From where the window ends, and from where it begins.
        let resumed = |cursor| set.resume(area.clone(), cursor).expect("near");
        if let Some(next) = window.next_cursor() {
            prop_assert_eq!(next.offset, window.offset() + window.count());
            let (again, stop) = (resumed(next), Stop::new());
            prop_assert_eq!(again.to_vec(), &all[next.offset as usize..]);
            prop_assert_eq!(again.window(5, Some(9)).to_vec(), plan.window(next.offset + 5, Some(9)).to_vec());
            prop_assert_eq!(again.window(0, Some(7)).next_cursor(), plan.window(0, Some(next.offset + 7)).next_cursor());
            stop.raise();
            let _ = server::stopped_by(again, stop.clone()).window(3, None).next_cursor();
        }
        if let Some(cursor) = window.cursor() {
            prop_assert_eq!(resumed(cursor).to_vec(), &all[cursor.offset as usize..]);
        }
        // From any block.
        let (mut blocks, mut some) = (plan.blocks_points(), vec![Point::default(); block]);
        let filled = blocks.fill(&mut some);
        if let Some(cursor) = blocks.cursor() {
            prop_assert_eq!(cursor.offset, filled as u128);
            prop_assert_eq!(resumed(cursor).to_vec(), &all[filled..]);
        }
    }

    #[test]
    fn searches_find_what_boxes_hold(
        (set, field) in any_set(), at in prop::array::uniform2(-40.0..40.0f64), radius in 0.0..9.0f64,
    ) {
        let set = set.in_field(field);
        let region = Region::new(at.map(|v| v - 10.0), at.map(|v| v + 10.0)).expect("ordered");
        let squared = |p: &Point| (p.x - at[0]).powi(2) + (p.y - at[1]).powi(2);
        let mut expected = set.within(region).expect("near").to_vec();
        expected.retain(|p| squared(p) <= radius * radius);
        expected.sort_by(|a, b| squared(a).total_cmp(&squared(b)).then(a.id.cmp(&b.id)));
        let found = set.around(at, radius, 10_000).expect("few");
        let found: Vec<Point> = found.iter().map(|near| near.member.point()).collect();
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn a_constant_field_is_a_share(
        (set, _) in any_set(), area in any_area(), share in prop_oneof![Just(1.0), 0.0..1.0f64],
    ) {
        let keep = set.placement().keep.get();
        let field = FieldSpec::constant(share).expect("a share");
        let described = set.in_field(field).within(area.clone()).expect("near");
        let closure = set.in_field(move |_: [f64; 2]| share).within(area.clone()).expect("near");
        prop_assert_eq!(described.to_vec(), closure.to_vec());
        prop_assert_eq!(described.placement(), set.placement());
        if share * keep >= 1e-6 {
            let kept = set.keep(share * keep).expect("a share");
            prop_assert_eq!(described.to_vec(), kept.within(area).expect("near").to_vec());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn a_number_of_points_is_found(
        (set, field) in any_set(), area in any_area(), count in 1u128..3000,
    ) {
        let set = set.in_field(field);
        let stop = Stop::default();
        let Ok(plan) = server::exactly(&set, count, &area, 0.02, &stop) else {
            return Ok(());
        };
        prop_assert_eq!(plan.count(), count);
        prop_assert_eq!(plan.to_vec().len() as u128, count);
        let again = server::exactly(&set, count, &area, 0.02, &stop).expect("as before");
        prop_assert_eq!(again.placement(), plan.placement());
        // The set at that spacing has these points, and rarely one more; without warp those of a column.
        let same = set.placed(plan.placement()).within(area).expect("near");
        let more = if plan.placement().warp.is_off() { 60 } else { 1 };
        prop_assert!(same.count() - count <= more, "{}", same.count());
        prop_assert_eq!(&same.to_vec()[..count as usize], plan.to_vec());
    }
}

#[test]
fn no_number_is_sought_where_a_field_leaves_nothing() {
    let set = PointSet::new(tables()[0].clone());
    let thin = Region::new([0.0, 0.0], [0.2, 274.0]).expect("ordered");
    let beyond = FieldSpec::radial([16.0, 20.0], [2.0, 10.0], [1.0, 0.0]).expect("valid");
    let refused = |set: &PointSet, least: f64| {
        let error = server::exactly(set, 800, &thin.into(), least, &Stop::default());
        let error = error.expect_err("nothing");
        (error.kind(), error.problem().to_owned())
    };
    // Bounds say so, so nothing is counted: without a least spacing that would not end.
    let (kind, problem) = refused(&set.in_field(beyond), 0.0);
    assert_eq!(kind, ErrorKind::Count);
    assert_eq!(problem, "the field is 0 in all of the region");
    let (kind, problem) = refused(&set.in_field(|_: [f64; 2]| 0.0), 0.05);
    assert_eq!(kind, ErrorKind::TooDense);
    assert_eq!(problem, "no point is left here, down to a spacing of 0.05");
}

#[test]
fn numbers_are_found_in_every_field() {
    let region = Region::new([-60.0, -40.0], [60.0, 40.0]).expect("ordered");
    for (i, field) in fields().iter().enumerate() {
        let set = PointSet::new(tables()[0].clone()).seed(5);
        let set = set.in_field(Shared(field.clone(), i));
        let plan = server::exactly(&set, 5000, &region.into(), 0.05, &Stop::default());
        // Field 4 is 0 everywhere.
        assert_eq!(
            plan.ok().map(|plan| plan.to_vec().len()),
            (i != 4).then_some(5000),
            "{i}"
        );
    }
}

#[test]
fn far_chunks_have_exact_offsets() {
    let field = |_: [f64; 2]| 0.6;
    for (seed, at) in [(0, [1_000_000_000_000, -77]), (7, [-3, 99_999_999_999])] {
        let set = PointSet::new(tables()[0].clone()).seed(seed);
        let chunk = Region::chunk(10.0, at).expect("near enough");
        let kept = set
            .clone()
            .keep(0.6)
            .expect("a share")
            .within(chunk)
            .expect("near");
        let plan = set.in_field(field).within(chunk).expect("near");
        assert_eq!(items::<Offsets>(&plan, 17), items::<Offsets>(&kept, 99));
        assert_eq!(items::<F32>(&plan, 17), items::<F32>(&kept, 99));
        assert_eq!(items::<Points>(&plan, 17), items::<Points>(&kept, 99));
        assert_eq!(plan.origin(), kept.origin());
    }
}

#[test]
fn a_stopped_count_is_an_error() {
    let stop = Stop::new();
    stop.raise();
    let set = PointSet::new(tables()[0].clone()).in_field(|[x, _]: [f64; 2]| x);
    let region = Region::chunk(50.0, [0, 0]).expect("small");
    let error = server::within(&set, region, &stop).expect_err("stopped");
    assert_eq!(error.kind(), strew_core::ErrorKind::Stopped);
}

#[test]
fn where_a_field_is_constant_its_bounds_change_nothing() {
    let spec = || -> Result<FieldSpec, strew_core::Error> {
        let low = FieldSpec::ramp([700.0, 0.0], [760.0, 0.0], [0.4, 0.0])?;
        let island = FieldSpec::radial([250.0, 900.0], [180.0, 190.0], [1.0, 0.0])?;
        FieldSpec::max(vec![low, island])
    };
    let field = spec().expect("valid");
    for (seed, keep) in [(0, 1.0), (9, 1.0), (9, 0.8)] {
        let set = PointSet::new(tables()[0].clone())
            .seed(seed)
            .keep(keep)
            .expect("a share");
        let shares = field.clone();
        let looked_up = set.in_field(move |at: [f64; 2]| shares.share(at));
        let set = set.in_field(field.clone());
        let region = Region::new([-30.0, 10.0], [900.0, 1500.0]).expect("ordered");
        let circle = Circle::new([300.0, 700.0], 420.0).expect("round");
        for area in [Area::from(region), circle.into()] {
            let [plan, other] =
                [&set, &looked_up].map(|set| set.within(area.clone()).expect("near"));
            let expected = other.to_vec();
            assert_eq!(plan.count(), expected.len() as u128);
            assert_eq!(plan.to_vec(), expected);
            assert_eq!(items::<F32>(&plan, 777), items::<F32>(&other, 4000));
            for part in [0.0, 0.01, 0.3, 0.31, 0.9] {
                let offset = (part * expected.len() as f64) as usize;
                let window = plan.window(offset as u128, Some(5000));
                assert_eq!(
                    window.to_vec(),
                    &expected[offset..expected.len().min(offset + 5000)]
                );
                let next = window.next_cursor();
                assert_eq!(next, other.window(offset as u128, Some(5000)).next_cursor());
                let (mut blocks, mut block) = (window.blocks_points(), [Point::default(); 1234]);
                let filled = blocks.fill(&mut block);
                let cursor = blocks.cursor().expect("more");
                let resumed = set.resume(area.clone(), cursor).expect("near");
                assert_eq!(
                    resumed.window(0, Some(99)).to_vec(),
                    &expected[offset + filled..][..99]
                );
            }
            let from_tiles = plan.tiles(40_000).flat_map(|tile| {
                let mut all = vec![Point::default(); 40_000];
                let filled = plan.tile_blocks::<Points>(&tile).fill(&mut all);
                all.truncate(filled);
                all
            });
            assert!(from_tiles.eq(expected.iter().copied()));
        }
    }
}
