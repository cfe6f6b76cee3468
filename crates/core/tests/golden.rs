//! Golden vectors: the exact bits of answers, the same on every machine.
//!
//! A change here is a change of the algorithm: raise `ALGORITHM_VERSION` with it.

use strew_core::{
    ALGORITHM_VERSION, Alpha, F32, F64, Format, Map, Plan, PointId, PointSet, Points, Region,
    Table,
    table::{Digest, Provenance},
};

/// Vectors from a linear congruential generator, up to ±8 grid units.
fn table(alpha: &str) -> Table {
    of_profile("golden", alpha)
}

fn of_profile(profile: &str, alpha: &str) -> Table {
    let map = Map::new(alpha.parse::<Alpha>().expect("valid"), 30).expect("small");
    let blocks = map.intervals() * map.intervals();
    let mut state = 20_261_121u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as i32 - (1 << 23)
    };
    let vectors = (0..blocks).map(|_| [next(), next()]).collect();
    Table::new(map, profile, vectors, Provenance::default()).expect("valid")
}

fn warped(alpha: &str, spacing: f64, seed: u64, strength: f64) -> PointSet {
    let set = PointSet::new(table(alpha)).seed(seed);
    let set = set.spacing(spacing).expect("valid");
    set.warp(strength).expect("in range")
}

fn items<F: Format>(plan: &Plan) -> Vec<F::Item> {
    let mut items = vec![F::Item::default(); plan.count() as usize + 1];
    let filled = plan.blocks::<F>().fill(&mut items);
    items.truncate(filled);
    items
}

/// BLAKE3 over the little-endian bytes of all points: ids and f64 pairs, then f32 pairs.
fn digest(plan: &Plan) -> String {
    let mut bytes = Vec::new();
    for p in items::<Points>(plan) {
        bytes.extend(p.id.x.to_le_bytes());
        bytes.extend(p.id.y.to_le_bytes());
        bytes.extend(p.x.to_le_bytes());
        bytes.extend(p.y.to_le_bytes());
    }
    for pair in items::<F64>(plan) {
        bytes.extend(pair.iter().flat_map(|v| v.to_le_bytes()));
    }
    for pair in items::<F32>(plan) {
        bytes.extend(pair.iter().flat_map(|v| v.to_le_bytes()));
    }
    Digest::of(&bytes).to_string()[..16].to_string()
}

#[test]
fn answers_have_these_bits() {
    assert_eq!(
        ALGORITHM_VERSION, 4,
        "new golden vectors belong to a new algorithm version"
    );
    let [half, root, golden] = ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"];
    let near = [[0.0, 0.0], [40.0, 30.0]];
    let tall = [[-20.0, -10.5], [3.3, 11.1]];
    let far = [[-1e9, 1e9], [-999_999_800.0, 1_000_000_123.0]];
    let farther = [[-1e15, 1e15], [-9.999_999_999e14, 1.000_000_000_2e15]];
    let tiny = [[123.0, 456.0], [123.000_1, 456.000_1]];
    let large = [[0.0, 0.0], [900.0, 700.0]];
    let wide = [[-700.0, 30.0], [90.0, 700.5]];
    // α, spacing, seed, strength of the warp, corners, count and digest.
    for (alpha, spacing, seed, strength, [min, max], expected) in [
        (half, 1.0, 0, 0.0, near, "1195 29fef6808c0670b7"),
        (half, 1.0, 1, 0.0, near, "1205 867d44fbd2fe028c"),
        (root, 0.37, 42, 0.0, tall, "3670 43704215481dc35a"),
        (golden, 2.5, u64::MAX, 0.0, far, "3939 b44026ffd12077ea"),
        (half, 1e-6, 7, 0.0, tiny, "10005 0143059522d4db59"),
        (root, 1e3, 9, 0.0, farther, "20049 1262dbe0d07761cf"),
        (root, 1.0, 3, 0.0, large, "629955 9ae03594bf5ee2a1"),
        (half, 1.0, 1, 1.0, near, "1194 0623a98b1044d2ba"),
        (half, 1.0, 7, 0.5, wide, "529625 b8753889dc742157"),
        (root, 0.37, 42, 2.0, tall, "3653 45fc1461541b21bc"),
        (golden, 2.5, u64::MAX, 1.0, far, "3951 ac4bf75795695bc4"),
        (root, 1e3, 9, 1.333, farther, "20029 55e91805d87c78f1"),
    ] {
        let region = Region::new(min, max).expect("ordered");
        let plan = warped(alpha, spacing, seed, strength).within(region);
        assert_eq!(counted(&plan.expect("in range")), expected);
    }
}

/// The number of points and their digest.
fn counted(plan: &Plan) -> String {
    format!("{} {}", plan.count(), digest(plan))
}

/// The warp of this profile has long waves as well.
#[test]
fn warped_pink_has_these_bits() {
    let set = PointSet::new(of_profile("pink", "(5-sqrt(3))/2")).seed(7);
    let region = Region::new([-700.0, 30.0], [90.0, 230.5]).expect("ordered");
    let plan = set.within(region).expect("in range");
    assert_eq!(counted(&plan), "158492 fbbc07a5402d3677");
}

#[test]
fn single_points_have_these_bits() {
    let point = |seed, x, y| {
        let set = warped("(5-sqrt(3))/2", 1.0, seed, 0.0);
        let member = set.point(PointId { x, y })?;
        Some((member.at()[0].to_bits(), member.at()[1].to_bits()))
    };
    assert_eq!(
        point(0, 0, 0),
        Some((13_831_125_425_664_616_364, 13_835_666_998_176_854_699))
    );
    assert_eq!(point(0, 3, 3), None);
    assert_eq!(
        table("(5-sqrt(3))/2").digest().to_string(),
        "cb67815a5524ba7df97ba2467d7c3622eac07865b88107c7762f9b42e8ba5e2e"
    );
}

#[cfg(feature = "tables")]
#[test]
fn thinned_sets_have_these_bits() {
    let region = Region::new([0.0, 0.0], [60.0, 40.0]).expect("ordered");
    let set = PointSet::blue().seed(7).keep(0.3).expect("a share");
    let plan = set.within(region).expect("near");
    assert_eq!(counted(&plan), "727 dd5f5e941cead089");
}

#[cfg(feature = "tables")]
#[test]
fn sets_in_fields_have_these_bits() {
    let region = Region::new([0.0, 0.0], [60.0, 40.0]).expect("ordered");
    let of = |width: f64| {
        let ramp = move |[x, _]: [f64; 2]| 1.0 - x / width;
        let plan = PointSet::blue().seed(7).in_field(ramp).within(region);
        counted(&plan.expect("near"))
    };
    let expected = ["1373 0446547ba5c52d00", "2393 5eb20d3aaa53df59"];
    assert_eq!([of(70.0), of(9000.0)], expected);
}
