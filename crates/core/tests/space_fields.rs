//! Sets in space whose density varies, their levels of detail, and exact numbers of their points: by brute force.

use crate::{
    field_specs::{joined, simple},
    subject::space::{agree_in_number, exactly},
};

use proptest::prelude::*;
use strew_core::{
    Backend, Field,
    field::FieldSpec,
    space::{Ball, PointId, Region, SpaceSet, Table, Volume},
};

/// A set whose points stay: `space_settle.rs` tests the rest.
fn set(seed: u64) -> SpaceSet {
    let table = Table::undisplaced("sqrt(3)".parse().expect("valid"), 5, "pattern");
    let set = SpaceSet::new(table.expect("small")).seed(seed);
    set.settle(0).expect("0")
}

/// Fields of the plane and of space, and what is joined from them.
fn any_field() -> impl Strategy<Value = FieldSpec> {
    let at = || prop::array::uniform3(-9.0f64..9.0);
    let shares = || prop::array::uniform2(0.0f64..=1.0);
    let ramp = (at(), at(), shares())
        .prop_map(|(from, to, shares)| FieldSpec::ramp(from, to, shares).expect("apart"));
    let radial = (at(), 0.0f64..6.0, shares())
        .prop_map(|(at, r, shares)| FieldSpec::radial(at, [r, r + 5.0], shares).expect("valid"));
    joined(prop_oneof![2 => ramp, 2 => radial, 3 => simple()])
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
        let ids: Vec<_> = all.within(volume.clone()).expect("near").to_vec().iter().map(|point| point.id)
            .filter(|id| felled(*id)).collect();
        let last = ids.iter().rev().copied().skip(ids.len() / 3);
        let graded = graded.without(ids[ids.len() / 2..].to_vec()).without(last.collect::<Vec<_>>());
        let plan = graded.within(volume.clone()).expect("near");
        let expected: Vec<_> = all.within(volume).expect("near").to_vec().into_iter()
            .filter(|point| shown(point.at(), point.id)).collect();
        prop_assert_eq!(plan.to_vec(), expected.clone());
        prop_assert_eq!(plan.count(), expected.len() as u128);
        for point in &expected {
            prop_assert_eq!(graded.point(point.id).map(|found| found.point()), Some(*point));
        }
        let pages: Vec<_> = plan.split(3).flatten().collect();
        prop_assert!(pages.iter().map(|page| page.point()).eq(expected.iter().copied()));
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

/// Layers keep clear of the points that a field leaves.
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
}

#[test]
fn an_exact_number_of_points_has_a_spacing() {
    let center = [100.0, -40.0, 7.0];
    let ball = |radius| Volume::from(Ball::new(center, radius).expect("a ball"));
    let glow = FieldSpec::radial(center, [0.0, 9.0], [1.0, 0.0]).expect("valid");
    let thinned = set(7).keep(0.1).expect("a share");
    for set in [set(0), thinned, set(7).in_field(glow)] {
        for volume in [ball(9.0), ball(9.0).without([ball(8.0)])] {
            for count in [1, 2, 77, 4000] {
                assert!(exactly(&set, count, &volume, 0.02).is_ok());
                agree_in_number(&set, &volume, count);
            }
        }
    }
}
