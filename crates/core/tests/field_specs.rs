//! Described fields: bounds hold, shares are shares, digests tell descriptions apart, bad ones are refused.

use crate::subject::noise;

use std::collections::HashSet;

use proptest::prelude::*;
use strew_core::{
    ErrorKind, Field, Raster, Region,
    field::{Edges, FieldSpec, Filter, Marks, Pixels, Terrain},
};

fn place() -> impl Strategy<Value = [f64; 2]> {
    prop::array::uniform2(-50.0..50.0f64)
}

fn share() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0f64]
}

fn shares() -> impl Strategy<Value = [f64; 2]> {
    prop::array::uniform2(share())
}

/// Two numbers in ascending order.
fn range(from: f64, to: f64) -> impl Strategy<Value = [f64; 2]> {
    (from..to, 0.01..to - from).prop_map(|(a, by)| [a, a + by])
}

fn region() -> impl Strategy<Value = Region> {
    (
        place(),
        prop::array::uniform2(prop_oneof![0.001..1.0f64, 1.0..80.0f64]),
    )
        .prop_map(|([x, y], [w, h])| Region::new([x, y], [x + w, y + h]).expect("ordered"))
}

fn edges() -> impl Strategy<Value = Edges> {
    prop::sample::select(vec![
        Edges::Zero,
        Edges::Clamp,
        Edges::Repeat,
        Edges::Mirror,
    ])
}

fn filter() -> impl Strategy<Value = Filter> {
    prop::sample::select(vec![Filter::Linear, Filter::Nearest])
}

/// Pixels of each kind, with plains of zeros, and their width.
fn sized() -> impl Strategy<Value = (usize, Pixels)> {
    (1usize..60, 1usize..40, any::<u32>(), 0..3u32).prop_map(|(width, height, salt, kind)| {
        let pixel = move |i: usize| {
            let z = (i as u32 / 7).wrapping_mul(0x9e37_79b9) ^ salt;
            let z = (z ^ (z >> 15)).wrapping_mul(0x846c_a68b);
            z.saturating_sub(1 << 31) << 1
        };
        let all = 0..width * height;
        let pixels = match kind {
            0 => Pixels::from_bytes(width, all.map(|i| (pixel(i) >> 24) as u8).collect()),
            1 => Pixels::from_words(width, all.map(|i| (pixel(i) >> 16) as u16).collect()),
            _ => {
                let share = |i| (f64::from(pixel(i)) / f64::from(u32::MAX)) as f32;
                Pixels::from_floats(width, all.map(share).collect())
            }
        };
        (width, pixels.expect("whole rows"))
    })
}

fn pixels() -> impl Strategy<Value = Pixels> {
    sized().prop_map(|(_, pixels)| pixels)
}

/// Pixels of which some, a corner or none are missing.
fn holes() -> impl Strategy<Value = Pixels> {
    let missing = prop_oneof![
        Just(vec![]),
        prop::collection::vec(any::<bool>(), 1..60 * 40)
    ];
    (sized(), missing, 0usize..60, 0usize..60 * 40).prop_map(
        |((width, pixels), missing, corner, end)| {
            pixels.without(|at| match missing.get(at) {
                Some(missing) => {
                    *missing && at % width >= corner || at % width < corner && at < end
                }
                None => false,
            })
        },
    )
}

fn marks() -> impl Strategy<Value = Marks> {
    let line = |least| prop::collection::vec(place(), least..30);
    prop_oneof![
        prop::collection::vec(place(), 1..60).prop_map(Marks::Points),
        prop::collection::vec(line(2), 1..5).prop_map(Marks::Lines),
        prop::collection::vec(line(3), 1..5).prop_map(Marks::Polygons),
    ]
}

fn raster() -> impl Strategy<Value = FieldSpec> {
    (region(), holes(), edges(), filter(), shares(), 0.2..4.0f64).prop_map(
        |(region, pixels, edges, filter, [low, high], gamma)| {
            let raster = Raster::of(region, pixels).expect("shares").edges(edges);
            let raster = raster.filter(filter).tone(low, high, gamma);
            FieldSpec::raster(raster.expect("in range")).expect("valid")
        },
    )
}

fn terrain() -> impl Strategy<Value = FieldSpec> {
    (
        region(),
        pixels(),
        edges(),
        filter(),
        range(-0.1, 1.0),
        shares(),
        any::<bool>(),
    )
        .prop_map(|(region, pixels, edges, filter, range, shares, is_slope)| {
            let terrain = Terrain::new(region, pixels).expect("an inside");
            let terrain = terrain.edges(edges).filter(filter);
            let of = if is_slope {
                FieldSpec::slope
            } else {
                FieldSpec::height
            };
            of(terrain, range, shares).expect("valid")
        })
}

pub fn simple() -> impl Strategy<Value = FieldSpec> {
    let settings = (any::<u64>(), 0.5..100.0f64, 1..=8u32, shares());
    prop_oneof![
        share().prop_map(|share| FieldSpec::constant(share).expect("a share")),
        (place(), place(), shares())
            .prop_filter_map("apart", |(a, b, shares)| FieldSpec::ramp(a, b, shares).ok()),
        (place(), range(0.0, 60.0), shares())
            .prop_map(|(at, radii, shares)| FieldSpec::radial(at, radii, shares).expect("valid")),
        (marks(), range(-20.0, 30.0), shares()).prop_map(|(marks, range, shares)| {
            FieldSpec::distance(marks, range, shares).expect("valid")
        }),
        settings.prop_map(|(seed, wavelength, octaves, range)| {
            noise(seed, wavelength, octaves, range).expect("valid")
        }),
        raster(),
        terrain(),
    ]
}

fn spec() -> impl Strategy<Value = FieldSpec> {
    joined(simple())
}

/// Fields that are joined from others.
pub fn joined(
    simple: impl Strategy<Value = FieldSpec> + 'static,
) -> impl Strategy<Value = FieldSpec> {
    simple.prop_recursive(3, 12, 3, |inner| {
        let parts = || prop::collection::vec(inner.clone(), 1..4);
        let curve = prop::collection::vec((1..100u32, share()), 2..6);
        prop_oneof![
            parts().prop_map(|parts| FieldSpec::multiply(parts).expect("few")),
            parts().prop_map(|parts| FieldSpec::min(parts).expect("few")),
            parts().prop_map(|parts| FieldSpec::max(parts).expect("few")),
            inner.clone().prop_map(|part| part.invert().expect("few")),
            (inner, curve).prop_map(|(part, steps)| {
                let mut x = 0;
                let total: u32 = steps.iter().map(|(step, _)| step).sum();
                let point = |(step, y): (u32, f64)| {
                    x += step;
                    [f64::from(x) / f64::from(total), y]
                };
                part.curve(steps.into_iter().map(point).collect())
                    .expect("ascending")
            }),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, ..ProptestConfig::default() })]

    #[test]
    fn no_place_of_a_box_leaves_its_bounds(
        spec in spec(), within in region(),
        inside in prop::collection::vec(prop::array::uniform2(0.0..=1.0f64), 12),
    ) {
        let [low, high] = spec.bounds(&within);
        let (min, max) = (within.min(), within.max());
        let corners = [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]];
        for part in inside.into_iter().chain(corners) {
            let at = [0, 1].map(|i| (min[i] + (max[i] - min[i]) * part[i]).min(max[i]));
            let share = spec.share(at);
            prop_assert!((0.0..=1.0).contains(&share), "{share}");
            prop_assert!(low <= share && share <= high, "{low} {share} {high} at {at:?}");
        }
    }

    #[test]
    fn no_share_changes_faster_than_its_slopes(
        spec in spec(), within in region(),
        pairs in prop::collection::vec((prop::array::uniform2(0.0..=1.0f64), 0.0..=1.0f64, 0..2usize), 12),
    ) {
        let slopes = spec.slopes(&within);
        let (min, max) = (within.min(), within.max());
        let ends = [[0.0, 0.5], [0.5, 0.0]].map(|at| (at, 1.0, usize::from(at[0] > 0.0)));
        for (part, other, axis) in pairs.into_iter().chain(ends) {
            let at = [0, 1].map(|i| (min[i] + (max[i] - min[i]) * part[i]).min(max[i]));
            let mut there = at;
            there[axis] = (min[axis] + (max[axis] - min[axis]) * other).min(max[axis]);
            let change = (spec.share(there) - spec.share(at)).abs();
            let most = slopes[axis] * (there[axis] - at[axis]).abs();
            prop_assert!(change <= most * (1.0 + 1e-9) + 1e-12, "{change} > {most} at {at:?}, axis {axis}");
        }
    }

    #[test]
    fn many_places_have_the_shares_of_each(
        spec in spec(), number in 0usize..90, scale in prop_oneof![Just(1.0), Just(1e5), Just(1e14)],
        step in place(),
    ) {
        let at = |i: usize| step.map(|v| scale * v * (i as f64 * 0.618).fract());
        let places: Vec<[f64; 2]> = (0..number).map(at).collect();
        let mut shares = vec![f64::NAN; number];
        spec.shares(&places, &mut shares);
        let bits = |share: f64| share.to_bits();
        let one_by_one = places.iter().map(|&at| bits(spec.share(at)));
        prop_assert!(one_by_one.eq(shares.iter().map(|&share| bits(share))));
    }

    #[test]
    fn the_tree_of_marks_finds_the_nearest(marks in marks(), at in place()) {
        let field = FieldSpec::distance(marks.clone(), [-200.0, 200.0], [0.0, 1.0]).expect("valid");
        let distance = |[a, b]: [[f64; 2]; 2]| {
            let way = [b[0] - a[0], b[1] - a[1]];
            let square = way[0] * way[0] + way[1] * way[1];
            let along = (at[0] - a[0]) * way[0] + (at[1] - a[1]) * way[1];
            let t = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
            let [x, y] = [0, 1].map(|i| at[i] - (a[i] + t * way[i]));
            (x * x + y * y).sqrt()
        };
        let (sides, is_area): (Vec<[[f64; 2]; 2]>, bool) = match &marks {
            Marks::Points(all) => (all.iter().map(|&p| [p, p]).collect(), false),
            Marks::Lines(all) => {
                let sides = all.iter().flat_map(|line| line.windows(2));
                (sides.map(|w| [w[0], w[1]]).collect(), false)
            }
            Marks::Polygons(all) => {
                let ring = |ring: &Vec<[f64; 2]>| {
                    let ring = ring.clone();
                    (0..ring.len()).map(move |i| [ring[i], ring[(i + 1) % ring.len()]])
                };
                (all.iter().flat_map(ring).collect(), true)
            }
        };
        let nearest = sides.iter().copied().map(distance).fold(f64::INFINITY, f64::min);
        let crossings = sides.iter().filter(|[a, b]| {
            (a[1] <= at[1]) != (b[1] <= at[1])
                && at[0] < a[0] + (at[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        });
        let is_inside = is_area && crossings.count() % 2 == 1;
        let expected = if is_inside { -nearest } else { nearest };
        prop_assert_eq!(field.share(at), (expected + 200.0) / 400.0);
    }
}

#[test]
fn slopes_are_close() {
    let region = Region::new([0.0, 0.0], [8.0, 4.0]).expect("ordered");
    let raster = Raster::new(region, 2, vec![0.0, 0.5]).expect("shares");
    // From the center of one pixel to the center of the other are four units. Rounding may add a little.
    let [x, y] = raster.slopes(&region);
    assert!((0.125..0.12501).contains(&x) && y == 0.0);
    let closure = |[x, _]: [f64; 2]| x;
    assert_eq!(closure.slopes(&region), [f64::INFINITY; 2]);
}

#[test]
fn each_setting_changes_the_digest_and_copies_do_not() {
    let unit = Region::chunk(1.0, [0, 0]).expect("small");
    let bytes = |v: u8| Pixels::from_bytes(2, vec![v, 255]).expect("rows");
    let raster = || Raster::of(unit, bytes(3)).expect("shares");
    let heights = || Terrain::new(unit, bytes(3)).expect("an inside");
    let triangle = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let make = || -> Result<Vec<FieldSpec>, strew_core::Error> {
        let half = FieldSpec::constant(0.5)?;
        let shares = [0.0, 1.0];
        let ramp = FieldSpec::ramp([0.0, 0.0], [1.0, 0.0], shares)?;
        let distance = |marks, to| FieldSpec::distance(marks, [0.0, to], shares);
        let radial = |to| FieldSpec::radial([0.0, 0.0], [1.0, to], shares);
        Ok(vec![
            half.clone(),
            FieldSpec::constant(0.25)?,
            ramp.clone(),
            FieldSpec::ramp([0.0, 0.0], [1.0, 0.0], [1.0, 0.0])?,
            FieldSpec::ramp([0.0, 0.0], [0.0, 1.0], shares)?,
            radial(2.0)?,
            radial(3.0)?,
            distance(Marks::Points(triangle.clone()), 1.0)?,
            distance(Marks::Points(triangle.clone()), 2.0)?,
            distance(Marks::Lines(vec![triangle.clone()]), 1.0)?,
            distance(Marks::Polygons(vec![triangle.clone()]), 1.0)?,
            distance(Marks::Polygons(vec![triangle.clone(); 2]), 1.0)?,
            noise(1, 2.0, 3, shares)?,
            noise(2, 2.0, 3, shares)?,
            noise(1, 3.0, 3, shares)?,
            noise(1, 2.0, 2, shares)?,
            noise(1, 2.0, 3, [0.0, 0.5])?,
            FieldSpec::raster(raster())?,
            FieldSpec::raster(Raster::of(unit, bytes(4))?)?,
            FieldSpec::raster(Raster::of(Region::chunk(2.0, [0, 0])?, bytes(3))?)?,
            FieldSpec::raster(raster().edges(Edges::Zero))?,
            FieldSpec::raster(raster().filter(Filter::Nearest))?,
            FieldSpec::raster(raster().tone(0.0, 1.0, 2.0)?)?,
            FieldSpec::raster(raster().tone(0.0, 0.9, 1.0)?)?,
            FieldSpec::height(heights(), [0.0, 1.0], [0.0, 1.0])?,
            FieldSpec::height(heights(), [0.0, 2.0], [0.0, 1.0])?,
            FieldSpec::height(heights().edges(Edges::Mirror), [0.0, 1.0], [0.0, 1.0])?,
            FieldSpec::slope(heights(), [0.0, 1.0], [0.0, 1.0])?,
            FieldSpec::multiply(vec![half.clone(), ramp.clone()])?,
            FieldSpec::multiply(vec![ramp.clone(), half.clone()])?,
            FieldSpec::multiply(vec![FieldSpec::multiply(vec![half.clone()])?, ramp.clone()])?,
            FieldSpec::min(vec![half.clone(), ramp.clone()])?,
            FieldSpec::max(vec![half.clone(), ramp.clone()])?,
            ramp.clone().invert()?,
            ramp.clone().curve(vec![[0.0, 0.0], [1.0, 1.0]])?,
            ramp.curve(vec![[0.0, 0.0], [0.5, 0.4], [1.0, 1.0]])?,
        ])
    };
    let (all, again) = (make().expect("valid"), make().expect("valid"));
    assert_eq!(all, again);
    let different: HashSet<_> = all.iter().map(FieldSpec::digest).collect();
    assert_eq!(different.len(), all.len());
}

#[test]
fn a_digest_and_a_share_are_those_of_every_machine() {
    let field = noise(7, 12.5, 4, [0.1, 0.9]).expect("valid");
    let digest = "3810b03aa82435398a0798dfc9ef4aeb171d4c51f3db5bbdcb8d72fc47a63c8a";
    assert_eq!(field.digest().to_string(), digest);
    let share = field.share([1.25, -7.5]);
    assert_eq!(share.to_bits(), 4_603_272_320_237_672_945);
}

#[test]
fn bad_descriptions_are_refused_by_name() {
    let (here, shares) = ([0.0, 0.0], [0.0, 1.0]);
    let half = || FieldSpec::constant(0.5).expect("a share");
    let many = Marks::Points(vec![here; FieldSpec::MAX_VERTICES + 1]);
    let pixels = || Pixels::from_bytes(1, vec![1]).expect("a row");
    let deep = (0..FieldSpec::MAX_DEPTH).try_fold(half(), |field, _| field.invert());
    let flat = Region::new(here, [0.0, 1.0]).expect("ordered");
    let ramp = |from, to| FieldSpec::ramp(from, to, shares);
    let radial = |center, radii| FieldSpec::radial(center, radii, shares);
    let distance = |marks, range| FieldSpec::distance(marks, range, shares);
    let terrain = Terrain::new(Region::chunk(1.0, [0, 0]).expect("small"), pixels());
    let heights = terrain.and_then(|terrain| FieldSpec::height(terrain, [1.0, 1.0], shares));
    let raster = Raster::of(flat, pixels()).and_then(FieldSpec::raster);
    let cases = [
        ("share", FieldSpec::constant(f64::NAN)),
        ("from", ramp([f64::INFINITY, 0.0], here)),
        ("to", ramp(here, here)),
        ("to", ramp(here, [1e-200, 0.0])),
        ("shares", FieldSpec::ramp(here, [1.0, 0.0], [0.0, 1.1])),
        ("radii", radial(here, [2.0, 2.0])),
        ("radii", radial(here, [-1.0, 2.0])),
        ("center", radial([1e101, 0.0], [1.0, 2.0])),
        ("vertices", distance(many, [0.0, 1.0])),
        ("points", distance(Marks::Points(vec![]), [0.0, 1.0])),
        (
            "lines",
            distance(Marks::Lines(vec![vec![here]]), [0.0, 1.0]),
        ),
        ("polygons", distance(Marks::Polygons(vec![]), [0.0, 1.0])),
        ("distances", distance(Marks::Points(vec![here]), [1.0, 0.0])),
        ("octaves", noise(1, 2.0, 0, shares)),
        ("wavelength", noise(1, 0.0, 3, shares)),
        ("range", noise(1, 2.0, 3, [-0.1, 1.0])),
        ("multiply", FieldSpec::multiply(vec![])),
        ("parts", FieldSpec::min(vec![half(); FieldSpec::MAX_PARTS])),
        ("depth", deep),
        ("curve", half().curve(vec![[0.0, 0.0]])),
        ("curve", half().curve(vec![[0.0, 0.0], [1.0, f64::NAN]])),
        ("region", raster),
        ("heights", heights),
    ];
    for (width, pixels) in [
        (0, vec![0.5]),
        (3, vec![0.5; 4]),
        (1, vec![-0.1]),
        (1, vec![f32::NAN]),
    ] {
        let unit = Region::chunk(1.0, [0, 0]).expect("small");
        assert!(Raster::new(unit, width, pixels).is_err());
    }
    assert!(Pixels::from_floats(1, vec![f32::NAN]).is_err());
    for (name, result) in cases {
        let error = result.expect_err(name);
        assert_eq!((error.field(), error.kind()), (name, ErrorKind::Field));
        assert!(!error.allowed().is_empty());
    }
}
