//! Pixels without data: empty, whatever is made of them, while their neighbors are means of those that are there.

use strew_core::{
    Error, Field, Raster, Region,
    field::{Edges, FieldSpec, Filter, Pixels, Terrain},
};

/// Three by two pixels of ten units: 200, missing, 100 below, and 50, 0, missing above.
fn partial(edges: Edges, filter: Filter) -> FieldSpec {
    let pixels = Pixels::from_floats(3, vec![1.0, 9.0, 0.5, 0.25, 0.0, 9.0]);
    let pixels = pixels.expect("numbers").without(|at| at == 1 || at == 5);
    let region = Region::new([0.0, 0.0], [30.0, 20.0]).expect("ordered");
    let raster = Raster::of(region, pixels).expect("shares");
    FieldSpec::raster(raster.edges(edges).filter(filter)).expect("a field")
}

/// The shares at some places along a row.
fn along(field: &FieldSpec, places: [f64; 4]) -> [f64; 4] {
    places.map(|x| field.share([x, 5.0]))
}

#[test]
fn missing_pixels_are_empty_and_their_neighbors_are_means_of_those_that_are_there() {
    let field = partial(Edges::Clamp, Filter::Linear);
    for (at, share) in [
        // In missing pixels, up to their sides.
        ([10.0, 5.0], 0.0),
        ([19.9, 9.9], 0.0),
        ([25.0, 15.0], 0.0),
        ([99.0, 15.0], 0.0),
        // At centers, and beside a missing pixel: of 1, 0.25 and 0 with the weights 0.49, 0.21 and 0.09.
        ([5.0, 5.0], 1.0),
        ([8.0, 8.0], (0.49 + 0.21 * 0.25) / (0.49 + 0.21 + 0.09)),
        ([9.9, 5.0], 1.0),
        ([20.0, 5.0], 0.5),
    ] {
        let found = field.share(at);
        assert!((found - share).abs() < 1e-12, "{at:?}: {found}");
    }
    assert!(field.is_missing([10.0, 5.0]) && !field.is_missing([5.0, 5.0]));
    let three = Pixels::from_bytes(3, vec![0; 3]).expect("rows");
    let within = |right| Region::new([0.0; 2], [right, 1.0]).expect("ordered");
    let row = Raster::of(within(3.0), three.without(|at| at == 2)).expect("shares");
    let row = FieldSpec::raster(row).expect("a field");
    assert_eq!(
        [0.4, 3.0].map(|right| row.has_missing(&within(right))),
        [false, true]
    );
    let nearest = partial(Edges::Zero, Filter::Nearest);
    assert_eq!(
        along(&nearest, [9.9, 10.0, 20.0, 30.0]),
        [1.0, 0.0, 0.5, 0.0]
    );
    let words = Pixels::from_words(1, vec![0, 65535]).expect("rows");
    assert_eq!(words.ends(), [0.0, 1.0]);
    let whole = Pixels::from_bytes(2, vec![1, 2]).expect("rows");
    assert_eq!(whole.clone().without(|_| false).digest(), whole.digest());
    assert_ne!(whole.clone().without(|at| at == 0).digest(), whole.digest());
}

#[test]
fn missing_stays_missing_in_all_that_is_made_of_it() -> Result<(), Error> {
    let one = || FieldSpec::constant(1.0).expect("a share");
    let holes = || partial(Edges::Clamp, Filter::Linear);
    let (hole, full) = ([15.0, 5.0], [5.0, 5.0]);
    let inverted = holes().invert()?;
    let twice = FieldSpec::max(vec![holes(), holes()])?;
    for (field, expected) in [
        (inverted.clone(), [0.0, 0.0]),
        (inverted.clone().invert()?, [0.0, 1.0]),
        (holes().curve(vec![[0.0, 1.0], [1.0, 0.5]])?, [0.0, 0.5]),
        (FieldSpec::multiply(vec![one(), holes()])?, [0.0, 1.0]),
        (FieldSpec::min(vec![one(), holes()])?, [0.0, 1.0]),
        // The greatest of those that are there.
        (FieldSpec::max(vec![one(), holes()])?, [1.0, 1.0]),
        (FieldSpec::max(vec![inverted, holes()])?, [0.0, 1.0]),
        (twice.invert()?, [0.0, 0.0]),
    ] {
        assert_eq!([field.share(hole), field.share(full)], expected);
        let mut shares = [7.0; 2];
        field.shares(&[hole, full], &mut shares);
        assert_eq!(shares, expected);
    }
    // Tones are those of numbers alone.
    let pixels = Pixels::from_bytes(2, vec![0, 0])?.without(|at| at == 0);
    let region = Region::new([0.0, 0.0], [2.0, 1.0])?;
    let raster = Raster::of(region, pixels)?.tone(1.0, 0.0, 1.0)?;
    assert_eq!([0.5, 1.5].map(|x| raster.share([x, 0.5])), [0.0, 1.0]);
    Ok(())
}

#[test]
fn heights_that_are_missing_are_no_heights_and_no_cliffs() {
    let terrain = || {
        let heights = Pixels::from_floats(4, vec![0.0, 10.0, -9999.0, 30.0]).expect("numbers");
        let region = Region::new([0.0, 0.0], [40.0, 10.0]).expect("ordered");
        Terrain::new(region, heights.without(|at| at == 2)).expect("a terrain")
    };
    let low = FieldSpec::height(terrain(), [10.0, 30.0], [1.0, 0.0]).expect("a field");
    assert_eq!(along(&low, [5.0, 19.0, 25.0, 31.0]), [1.0, 1.0, 0.0, 0.0]);
    // A slope of 1 where two neighbors have heights, and none beside a hole where there is one.
    let steep = FieldSpec::slope(terrain(), [0.0, 2.0], [0.0, 1.0]).expect("a field");
    assert_eq!(along(&steep, [5.0, 15.0, 25.0, 35.0]), [0.5, 0.5, 0.0, 0.0]);
}
