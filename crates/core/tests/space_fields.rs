//! Sets in space whose density varies, their levels of detail, and exact numbers of their points: by brute force.

use proptest::prelude::*;
use strew_core::{
    Backend, ErrorKind, Field,
    field::{FieldSpec, Noise},
    server::Stop,
    space::{Ball, Point, PointId, Region, SpaceSet, Table, Volume},
};

/// A set whose points stay: `space_settle.rs` tests the rest.
fn set(seed: u64) -> SpaceSet {
    let table = Table::undisplaced("sqrt(3)".parse().expect("valid"), 5, "pattern");
    let set = SpaceSet::new(table.expect("small")).seed(seed);
    set.settle(0).expect("0")
}

fn any_field() -> impl Strategy<Value = FieldSpec> {
    let at = || prop::array::uniform3(-9.0f64..9.0);
    let shares = || prop::array::uniform2(0.0f64..=1.0);
    let noise = (any::<u64>(), 0.5f64..30.0, 1u32..5, shares());
    let leaf = prop_oneof![
        shares().prop_map(|[share, _]| FieldSpec::constant(share)),
        (at(), at(), shares()).prop_map(|(from, to, shares)| FieldSpec::ramp(from, to, shares)),
        (at(), at(), shares()).prop_map(|([x, y, _], [u, v, _], shares)| FieldSpec::ramp(
            [x, y],
            [u, v],
            shares
        )),
        (at(), 0.0f64..6.0, shares()).prop_map(|(at, r, shares)| FieldSpec::radial(
            at,
            [r, r + 5.0],
            shares
        )),
        (at(), 0.0f64..6.0, shares()).prop_map(|([x, y, _], r, shares)| FieldSpec::radial(
            [x, y],
            [r, r + 5.0],
            shares
        )),
        noise.prop_map(
            |(seed, wavelength, octaves, range)| FieldSpec::noise(Noise {
                seed,
                wavelength,
                octaves,
                range,
            })
        ),
    ];
    let leaf = leaf.prop_map(|field| field.expect("valid"));
    leaf.prop_recursive(2, 6, 3, |part| {
        let parts = || prop::collection::vec(part.clone(), 1..4);
        prop_oneof![
            parts().prop_map(FieldSpec::multiply),
            parts().prop_map(FieldSpec::min),
            parts().prop_map(FieldSpec::max),
            part.clone().prop_map(FieldSpec::invert),
        ]
        .prop_map(|field| field.expect("valid"))
    })
}

fn any_volume() -> impl Strategy<Value = Volume> {
    let at = prop::array::uniform3(-12.0f64..12.0);
    (at, prop::array::uniform3(0.5f64..14.0), any::<bool>()).prop_map(|(at, sides, is_ball)| {
        if is_ball {
            return Ball::new(at, sides[0]).expect("a ball").into();
        }
        let to = [0, 1, 2].map(|axis| at[axis] + sides[axis]);
        Region::new(at, to).expect("a box").into()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// A point is there if its rank is below the share at its place and no list has its id.
    #[test]
    fn the_points_of_a_field_are_those_of_its_definition(
        field in any_field(), seed in 0u64..3, keep in prop_oneof![Just(1.0), 0.05..1.0f64],
        lod in prop_oneof![Just(1.0), 0.05..1.0f64], volume in any_volume(), size in 1usize..400,
        is_plain in any::<bool>(), felled in 1u64..9,
    ) {
        let all = set(seed);
        let thinned = all.clone().keep(keep).expect("a share").lod(lod).expect("a part");
        let felled = |id: PointId| (id.x ^ id.y ^ id.z).unsigned_abs().is_multiple_of(felled + 1);
        let share = |at| if is_plain { 1.0 } else { field.share(at).clamp(0.0, 1.0) };
        let shown = |at, id| all.rank(id) < share(at) * keep * lod && !felled(id);
        let graded = if is_plain { thinned } else { thinned.in_field(field.clone()) };
        // In two lists, not in order, some in both.
        let ids: Vec<_> = all.within(volume.clone()).expect("near").iter().map(|point| point.id)
            .filter(|id| felled(*id)).collect();
        let last = ids.iter().rev().copied().skip(ids.len() / 3);
        let graded = graded.without(ids[ids.len() / 2..].to_vec()).without(last.collect::<Vec<_>>());
        let plan = graded.within(volume.clone()).expect("near");
        let expected: Vec<_> = all.within(volume).expect("near").into_iter()
            .filter(|point| shown(point.at(), point.id)).collect();
        prop_assert_eq!(plan.to_vec(), expected.clone());
        prop_assert_eq!(plan.count(), expected.len() as u128);
        for point in &expected {
            prop_assert_eq!(graded.point(point.id), Some(*point));
        }
        let pages: Vec<_> = plan.split(3).flatten().collect();
        prop_assert_eq!(&pages, &expected);
        // Without what counting kept, in blocks of any size and by plain code.
        let mut blocks = plan.window(0, Some(u128::MAX)).blocks_f64().with_backend(Backend::Scalar);
        let (mut block, mut places) = (vec![[0.0; 3]; size], vec![]);
        loop {
            let filled = blocks.fill(&mut block);
            places.extend_from_slice(&block[..filled]);
            if filled < size {
                break;
            }
        }
        prop_assert_eq!(places, expected.iter().map(|point| point.at()).collect::<Vec<_>>());
    }

    #[test]
    fn bounds_hold_in_space(
        field in any_field(), at in prop::array::uniform3(-12.0f64..12.0), side in 0.0f64..9.0,
        inside in prop::collection::vec(prop::array::uniform3(0.0f64..=1.0), 20),
    ) {
        let region = Region::new(at, at.map(|v| v + side)).expect("a box");
        let [low, high] = field.bounds(&region);
        let places: Vec<_> = inside.iter()
            .map(|part| [0, 1, 2].map(|axis| at[axis] + part[axis] * side)).collect();
        let mut shares = vec![0.0; places.len()];
        Field::<3>::shares(&field, &places, &mut shares);
        for (place, share) in places.iter().zip(shares) {
            prop_assert_eq!(field.share(*place).to_bits(), share.to_bits());
            prop_assert!(low <= share && share <= high, "{:?} of {} {}", share, low, high);
        }
    }
}

#[test]
fn large_plans_in_fields_are_those_of_their_parts() {
    let noise = Noise {
        seed: 3,
        wavelength: 20.0,
        octaves: 2,
        range: [0.0, 0.4],
    };
    let glow = FieldSpec::radial([40.0; 3], [10.0, 40.0], [1.0, 0.0]).expect("valid");
    let parts = vec![glow, FieldSpec::noise(noise).expect("valid")];
    let field = FieldSpec::multiply(parts).expect("valid");
    for seed in [0, 5] {
        let graded = set(seed).in_field(field.clone());
        let some = set(seed).chunk(30.0, [1, 1, 1]).expect("near");
        let some: Vec<_> = some.iter().map(|point| point.id).step_by(7).collect();
        let whole = set(seed).chunk(70.0, [0, 0, 0]).expect("near");
        let left = set(seed)
            .without(some.clone())
            .chunk(70.0, [0, 0, 0])
            .expect("near");
        assert_eq!(left.count() + some.len() as u128, whole.count());
        let rest = |point: &Point| !some.contains(&point.id);
        assert!(whole.iter().filter(rest).eq(left.iter()));
        let whole = graded.chunk(80.0, [0, 0, 0]).expect("near");
        let mut points = whole.to_vec();
        assert!(points.len() > 10_000);
        assert_eq!(points.len() as u128, whole.count());
        let parts = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2]);
        let parts = parts.flat_map(|at| graded.chunk(40.0, at).expect("near").to_vec());
        let mut parts: Vec<_> = parts.collect();
        let middle = whole.window(whole.count() / 2, Some(1)).to_vec()[0];
        assert_eq!(points[points.len() / 2], middle);
        points.sort_by_key(|point| point.id);
        parts.sort_by_key(|point| point.id);
        assert_eq!(points, parts);
        let at = [37.0, 41.0, 44.0];
        let square = |id: PointId| {
            let point = graded.point(id).expect("there");
            let [x, y, z] = [0, 1, 2].map(|axis| point.at()[axis] - at[axis]);
            x * x + y * y + z * z
        };
        let nearest = points
            .iter()
            .map(|point| square(point.id))
            .fold(f64::MAX, f64::min);
        let found = graded.nearest(at, 1).expect("near")[0].point.id;
        assert_eq!(square(found), nearest);
    }
}

/// Layers keep clear of the points that a field leaves, and of all of them at any level of detail.
#[test]
fn sets_keep_clear_of_what_a_field_leaves() {
    let half = FieldSpec::ramp([9.9, 0.0, 0.0], [10.1, 0.0, 0.0], [1.0, 0.0]).expect("valid");
    let stars = set(1).spacing(2.0).expect("in range").in_field(half);
    let dust = set(2);
    let clear = |other: &SpaceSet| dust.clone().clear_of(other, 1.5).expect("in range");
    let points = |set: &SpaceSet| set.chunk(20.0, [0, 0, 0]).expect("near").to_vec();
    let kept = points(&clear(&stars));
    let is_clear = |at| stars.nearest(at, 1).expect("near")[0].distance >= 1.5;
    let expected: Vec<_> = points(&dust)
        .into_iter()
        .filter(|point| is_clear(point.at()))
        .collect();
    assert_eq!(kept, expected);
    assert_eq!(points(&clear(&stars.lod(0.1).expect("a part"))), expected);
}

#[test]
fn an_exact_number_of_points_has_a_spacing() {
    let ball = Volume::from(Ball::new([100.0, -40.0, 7.0], 9.0).expect("a ball"));
    let shell = ball
        .clone()
        .without([Ball::new([100.0, -40.0, 7.0], 8.0).expect("a ball").into()]);
    let glow = FieldSpec::radial([100.0, -40.0, 7.0], [0.0, 9.0], [1.0, 0.0]).expect("valid");
    let sets = [
        set(0),
        set(7),
        set(7).keep(0.1).expect("a share"),
        set(7).in_field(glow),
    ];
    for (set, volume) in sets.iter().flat_map(|set| [(set, &ball), (set, &shell)]) {
        for count in [1, 2, 77, 4000] {
            let plan = set
                .exactly(count, volume.clone(), 0.0, &Stop::default())
                .expect("a spacing");
            assert_eq!((plan.count(), plan.to_vec().len() as u128), (count, count));
            let spacing = plan.placement().spacing.get();
            let same = set
                .clone()
                .spacing(spacing)
                .expect("in range")
                .within(volume.clone());
            assert_eq!(
                same.expect("near").to_vec()[..count as usize],
                plan.to_vec()
            );
        }
    }
    let refused = |count, least, volume: Volume| {
        let error = sets[0]
            .exactly(count, volume, least, &Stop::default())
            .expect_err("refused");
        error.kind()
    };
    assert_eq!(refused(0, 0.0, ball.clone()), ErrorKind::Count);
    assert_eq!(refused(1000, 3.0, ball), ErrorKind::TooDense);
    let flat = Region::new([0.0; 3], [1.0, 1.0, 0.0]).expect("a box");
    assert_eq!(refused(1, 0.0, flat.into()), ErrorKind::Count);
    assert_eq!(
        refused(1, 0.0, Volume::Outside(shell.into())),
        ErrorKind::Unbounded
    );
}
