//! A library has the points, the documents and the words of a daemon's service.

use strew_core::{Kinds, PointSet, Region};

use super::*;

fn library() -> Library {
    Library::new().expect("built-in tables")
}

#[test]
fn columns_are_the_rows_of_the_answer() {
    let library = library();
    let layers = br#"{"region": {"bbox": [0, 0, 40, 30]}, "layers": [
        {"name": "trees", "spacing": 2, "seed": 3, "attributes": ["angle", "variant"], "variants": {"oak": 2, "birch": 1}},
        {"name": "rocks", "spacing": 3, "clear_of": {"trees": 1}}]}"#;
    let (planned, options) = library.plan(layers).expect("valid");
    let columns = library.columns(&planned).expect("few");
    assert_eq!(columns.len() as u128, planned.count());
    let csv = Options {
        encoding: Some(Encoding::Csv),
        ..options
    };
    let csv = library
        .document(&planned, csv, Encoding::Json)
        .expect("csv");
    let csv: Vec<u8> = csv.flat_map(|block| block.expect("whole")).collect();
    let mut lines = String::from_utf8(csv)
        .expect("text")
        .lines()
        .map(Into::into)
        .collect::<Vec<String>>();
    assert_eq!(lines.remove(0), "layer,id,x,y,angle,variant");
    assert_eq!(lines.len(), columns.len());
    for (i, line) in lines.iter().enumerate() {
        let [x, y] = [columns.at[2 * i], columns.at[2 * i + 1]];
        let [a, b] = [columns.ids[2 * i], columns.ids[2 * i + 1]];
        let value = |column: &Further| match &column.values {
            FurtherValues::Numbers(v) if v[i].is_nan() => String::new(),
            FurtherValues::Numbers(v) => strew_error::number(v[i]),
            FurtherValues::Names(names, v) => {
                usize::try_from(v[i]).map_or(String::new(), |index| names[index].to_string())
            }
        };
        let mut values: Vec<String> = columns.further.iter().map(value).collect();
        let at = format!(
            "{a}:{b},{},{}",
            strew_error::number(x),
            strew_error::number(y)
        );
        values.insert(1, at);
        let text = values.join(",");
        let plain = |text: &str| text.replace(".0,", ",");
        assert_eq!(plain(&text), plain(line));
    }
    assert_eq!(library.coordinates(&planned), Ok(columns.at));
}

#[test]
fn many_threads_make_the_points_of_one() {
    let library = library();
    for query in [
        "bbox=-200,-200,200,210&spacing=0.7&seed=5&attributes=angle",
        "circle=0,0,250&spacing=0.8",
    ] {
        let (planned, _) = library.plan_address(query).expect("valid");
        assert!(planned.count() > 3 * (1 << 16), "{}", planned.count());
        let alone = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .build()
            .expect("a thread");
        let many = rayon::ThreadPoolBuilder::new()
            .num_threads(3)
            .build()
            .expect("threads");
        let one = alone.install(|| library.columns(&planned)).expect("few");
        let three = many.install(|| library.columns(&planned)).expect("few");
        assert_eq!(one, three);
        assert_eq!(many.install(|| library.coordinates(&planned)), Ok(one.at));
    }
}

#[test]
fn chunks_are_relative_to_their_corner_and_parts_are_the_whole() {
    let library = library();
    let body = |more: &str| {
        format!(r#"{{"region": {{"chunk": {{"size": 64, "x": -3, "y": 2}}}}, "spacing": 3{more}}}"#)
    };
    let plan = |more: &str| library.plan(body(more).as_bytes()).expect("valid").0;
    let whole = library.columns(&plan("")).expect("few");
    assert_eq!(whole.origin, Some(Place::Plane([-192.0, 128.0])));
    assert!(whole.at.iter().all(|v| (0.0..64.0).contains(v)));
    let mut joined = vec![];
    for (cursor, count) in library.split(&plan(""), "3").expect("three") {
        let part = plan(&format!(r#", "cursor": "{cursor}", "limit": {count}"#));
        let part = library.columns(&part).expect("few");
        assert_eq!(part.len() as u64, count);
        joined.extend(part.at);
    }
    assert_eq!(joined, whole.at);
    let fault = library.split(&plan(""), "0").expect_err("too few");
    assert_eq!(fault.faults()[0].field, "parts");
}

#[test]
fn offsets_are_those_of_the_format_f32_and_need_room() {
    let library = library();
    for query in [
        "bbox=-500,-300,200,210&spacing=0.9&seed=5&attributes=angle",
        "circle=1e9,-7,20&spacing=0.8&keep=0.5",
        r#"{"region": {"chunk": {"size": 64, "x": -3, "y": 2}}, "spacing": 3}"#,
        r#"{"region": {"bbox": [3, 4, 40, 30]}, "layers": [
            {"name": "a", "spacing": 2}, {"name": "b", "spacing": 3, "region": {"bbox": [9, 9, 20, 20]}}]}"#,
    ] {
        let draft = Library::read(query).expect("read");
        let (planned, options) = library.plan_draft(&draft).expect(query);
        let count = library.columns(&planned).expect("few").len();
        let mut at = vec![0_f32; 2 * (count + 1)];
        let (filled, origin) = library.fill_offsets(&planned, &mut at).expect("room");
        assert_eq!((filled, &at[2 * count..]), (count, &[0.0; 2][..]));
        let answer = library.document(&planned, options, Encoding::F32);
        let answer = answer.expect("written");
        assert_eq!(answer.origin(), Some(origin));
        let bytes: Vec<u8> = answer.flat_map(|block| block.expect("whole")).collect();
        let record = bytes.len() / count;
        for (record, at) in bytes.chunks(record).zip(at.chunks(2)) {
            assert_eq!(
                record[..8],
                [at[0].to_le_bytes(), at[1].to_le_bytes()].concat()
            );
        }
        let few = library.fill_coordinates(&planned, &mut vec![0.0; 2 * count - 1]);
        assert_eq!(few.expect_err("no room").faults()[0].field, "capacity");
    }
}

#[test]
fn kinds_of_the_core_are_those_of_queries() {
    let library = library();
    let names = |column: &Further| match &column.values {
        FurtherValues::Names(names, values) => {
            let name = |i: &i32| usize::try_from(*i).ok().map(|i| names[i].to_string());
            values.iter().filter_map(name).collect::<Vec<_>>()
        }
        FurtherValues::Numbers(_) => vec![],
    };
    let region = Region::new([-30.0, 4.0], [50.0, 60.0]).expect("ordered");
    for variants in [
        "oak:1,birch:1",
        "oak:3,birch:1",
        "oak:2,birch:1,ash:1",
        "oak:10,birch:3,ash:1",
    ] {
        for (spread, kinds) in [
            ("even", Kinds::even(variants)),
            ("joint", Kinds::joint(variants)),
        ] {
            let forest = PointSet::blue().spacing(1.5).expect("valid").seed(11);
            let forest = forest.kinds(kinds.expect("shares")).expect("built in");
            for (share, more) in [(1.0, ""), (0.4, "&keep=0.4")] {
                let forest = forest.clone().keep(share).expect("a share");
                let query = format!(
                    "bbox=-30,4,50,60&spacing=1.5&seed=11&attributes=variant&variants={variants}&spread={spread}{more}"
                );
                let columns = |query: &str| {
                    let (planned, _) = library.plan_address(query).expect("valid");
                    library.columns(&planned).expect("few")
                };
                let whole = columns(&query);
                let points = forest.within(region).expect("near").to_vec();
                let at: Vec<f64> = points.iter().flat_map(|point| point.at()).collect();
                assert_eq!(whole.at, at, "{query}");
                let ids = points.iter().flat_map(|point| [point.id.x, point.id.y]);
                assert_eq!(whole.ids, ids.collect::<Vec<_>>(), "{query}");
                let own = points.iter().filter_map(|point| forest.kind_name(point.id));
                assert_eq!(names(&whole.further[0]), own.collect::<Vec<_>>(), "{query}");
                let birches = columns(&format!("{query}&only=birch"));
                let own = forest.clone().only("birch").expect("a kind");
                let own = own.within(region).expect("near").to_vec();
                let at: Vec<f64> = own.iter().flat_map(|point| point.at()).collect();
                assert_eq!(birches.at, at, "{query}");
            }
        }
    }
}

#[test]
fn an_empty_answer_has_its_columns() {
    let library = library();
    let query = "bbox=0.1,0.1,0.2,0.2&spacing=50&attributes=angle,variant&variants=oak:1,birch:1";
    let (planned, _) = library.plan_address(query).expect("valid");
    let columns = library.columns(&planned).expect("none");
    assert!(columns.is_empty());
    let names: Vec<&str> = columns.further.iter().map(|column| &*column.name).collect();
    assert_eq!(names, ["angle", "variant"]);
}

#[test]
fn tables_in_memory_have_the_points_of_the_built_in_ones() {
    let whole = library();
    let library = Library::of_tables([strew_core::table::BLUE.to_vec()]).expect("a table");
    assert_eq!(library.limits(), whole.limits());
    let plan = |library: &Library| {
        let planned = library.plan_address("bbox=0,0,30,30&spacing=1&seed=2&keep=0.5");
        library.columns(&planned.expect("valid").0).expect("few")
    };
    assert_eq!(plan(&library), plan(&whole));
    let missing = library.plan_address("bbox=0,0,30,30&spacing=1&profile=step");
    assert_eq!(missing.expect_err("not there").faults()[0].field, "profile");
    let damaged = Library::of_tables([vec![1, 2, 3]]).expect_err("no table");
    assert!(
        damaged.to_string().contains("table 0 in memory"),
        "{damaged}"
    );
}

#[test]
fn single_points_fields_and_faults() {
    let library = library();
    let found = library.nearest("at=5,5&k=2&spacing=1&seed=4").expect("two");
    let again = library
        .point(&found[0].id, "spacing=1&seed=4")
        .expect("there");
    assert_eq!((found[0].x, found[0].y), (again.x, again.y));
    let field = r#"{"radial": {"center": [0, 0], "radii": [5, 20]}}"#;
    let digest = library.hold_field(field).expect("held");
    let named = format!("bbox=-30,-30,30,30&spacing=1&field={digest}");
    let (named, _) = library.plan_address(&named).expect("valid");
    let own =
        format!(r#"{{"region": {{"bbox": [-30, -30, 30, 30]}}, "spacing": 1, "field": {field}}}"#);
    let (own, _) = library.plan(own.as_bytes()).expect("valid");
    assert_eq!(library.columns(&named), library.columns(&own));
    let refused = library.plan(br#"{"region": {"bbox": [0, 0, 0, 1]}, "sed": 3}"#);
    let refused = refused.expect_err("three faults");
    let fields: Vec<&str> = refused.faults().iter().map(|fault| &*fault.field).collect();
    assert_eq!(fields, ["sed", "region.bbox", "spacing"]);
}

#[test]
fn a_document_states_the_plane_of_its_query() {
    let library = library();
    let polygon = r#"{"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 0]]],
        "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2154"}}}"#;
    let body = format!(r#"{{"region": {{"polygon": {polygon}}}, "spacing": 2}}"#);
    let (planned, options) = library.plan(body.as_bytes()).expect("valid");
    let written = |stated: Option<&str>| {
        let stated = stated.map(|crs| crs.parse().expect("a system"));
        let wanted = Options {
            crs: stated,
            ..Options::default()
        };
        let wanted = wanted.of_plane(options.plane.clone())?;
        let blocks = library.document(&planned, wanted, Encoding::Geojson)?;
        let blocks = blocks.collect::<Result<Vec<_>, _>>().expect("written");
        Ok::<_, Error>(String::from_utf8(blocks.concat()).expect("UTF-8"))
    };
    let own = written(None).expect("valid");
    assert!(own.contains("urn:ogc:def:crs:EPSG::2154"), "{own}");
    assert_eq!(written(Some("epsg:2154")), Ok(own));
    let refused = written(Some("EPSG:4326")).expect_err("another plane");
    assert_eq!(
        (&*refused.faults()[0].field, &*refused.faults()[0].allowed),
        ("crs", "EPSG:2154")
    );
}

#[test]
fn points_of_a_square_are_measured() {
    let library = library();
    let (planned, _) = library
        .plan_address("bbox=0,0,60,60&spacing=1&seed=1")
        .expect("valid");
    let points = library.coordinates(&planned).expect("few");
    let points = points.as_chunks::<2>().0.to_vec();
    let of = Measured {
        bbox: [0.0, 0.0, 60.0, 60.0],
        density: Some(1.0),
        is_periodic: false,
        resolution: strew_forge::Resolution::default(),
    };
    let report = measure(points.clone(), &of).expect("a square");
    let document = measured::document(&report);
    assert_eq!(document["points"], points.len());
    let oblong = Measured {
        bbox: [0.0, 0.0, 60.0, 61.0],
        ..of.clone()
    };
    let far = Measured {
        bbox: [0.0, 0.0, 50.0, 50.0],
        ..of
    };
    for (of, field) in [(oblong, "bbox"), (far, "points")] {
        let refused = measure(points.clone(), &of).expect_err(field);
        assert_eq!(refused.faults()[0].field, field);
    }
}
