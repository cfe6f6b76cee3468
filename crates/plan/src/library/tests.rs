//! A library has the points, the documents and the words of a daemon's service, in the plane and in space.

use strew_core::{Kinds, PointSet, Region};

use super::*;

fn library() -> Library {
    Library::new().expect("built-in tables")
}

const FLAT: [&str; 5] = [
    "bbox=0.1,0.1,0.2,0.2&spacing=50&attributes=angle,variant&variants=oak:1,birch:1",
    r#"{"region": {"chunk": {"size": 64, "x": -3, "y": 2}}, "spacing": 3}"#,
    "bbox=-500,-300,200,210&spacing=0.9&seed=5&attributes=angle",
    "circle=1e9,-7,20&spacing=0.8&keep=0.5",
    r#"{"region": {"bbox": [0, 0, 40, 30]}, "layers": [{"name": "trees", "spacing": 2, "seed": 3,
        "attributes": ["angle", "variant"], "variants": {"oak": 2, "birch": 1}},
        {"name": "rocks", "spacing": 3, "clear_of": {"trees": 1}, "region": {"bbox": [9, 9, 20, 20]}}]}"#,
];
const IN_SPACE: [&str; 6] = [
    "bbox=0.1,0.1,0.1,0.2,0.2,0.2&spacing=50&attributes=rotation",
    r#"{"region": {"chunk": {"size": 16, "x": -3, "y": 2, "z": 1}}, "spacing": 2, "seed": 7}"#,
    "bbox=-9,-8,-7,20,11,12&spacing=1.3&seed=5&attributes=rotation,u1",
    "ball=1e6,-7,20,9&spacing=1.1&keep=0.5",
    r#"{"region": {"prism": {"polygon": {"type": "Polygon", "coordinates": [[[0, 0], [19, 1], [2, 17], [0, 0]]]},
        "bottom": -3, "top": 8}}, "spacing": 1.7, "attributes": ["variant"], "variants": {"gas": 1, "dust": 2}}"#,
    r#"{"region": {"bbox": [3, 4, 5, 23, 24, 25]}, "layers": [
        {"name": "a", "spacing": 2, "attributes": ["scale"]}, {"name": "b", "spacing": 3, "clear_of": {"a": 1}}]}"#,
];

/// All queries with the number of their axes.
fn queries() -> impl Iterator<Item = (usize, &'static str)> {
    let in_space = IN_SPACE.map(|query| (3, query));
    FLAT.map(|query| (2, query)).into_iter().chain(in_space)
}

fn planned(library: &Library, (axes, query): (usize, &str)) -> (Planned, Options) {
    let draft = match axes {
        2 => Library::read(query),
        _ => Library::read_in_space(query),
    };
    library.plan_draft(&draft.expect("read")).expect(query)
}

#[test]
fn columns_are_the_rows_of_the_answer() {
    let library = library();
    for (axes, query) in queries() {
        let (planned, options) = planned(&library, (axes, query));
        let columns = library.columns(&planned).expect("few");
        assert_eq!((columns.axes, planned.axes()), (axes, axes));
        assert_eq!(columns.len() as u128, planned.count(), "{query}");
        assert_eq!(library.coordinates(&planned), Ok(columns.at.clone()));
        let json = (library.document(&planned, options, Encoding::Json)).expect("written");
        let json: Vec<u8> = json.flat_map(|block| block.expect("whole")).collect();
        let json: serde_json::Value = serde_json::from_slice(&json).expect("JSON");
        let rows = json["points"].as_array().expect("a list");
        assert_eq!(rows.len(), columns.len());
        let places = columns.at.chunks(axes).zip(columns.ids.chunks(axes));
        for (i, (row, (at, id))) in rows.iter().zip(places).enumerate() {
            let place = ["x", "y", "z"].map(|axis| row[axis].as_f64());
            assert_eq!(
                place[..axes],
                at.iter().copied().map(Some).collect::<Vec<_>>()
            );
            let id: Vec<String> = id.iter().map(ToString::to_string).collect();
            assert_eq!(row["id"], id.join(":"));
            for column in &columns.further {
                match &column.values {
                    FurtherValues::Numbers(v) if v[i].is_nan() => {
                        assert!(row[&column.name].is_null());
                    }
                    FurtherValues::Numbers(v) => assert_eq!(row[&column.name], v[i]),
                    FurtherValues::Names(names, v) => {
                        let name = usize::try_from(v[i]).ok().map(|i| &*names[i]);
                        assert_eq!(row[&column.name].as_str(), name);
                    }
                }
            }
        }
    }
    let names = |query| {
        let columns = library.columns(&planned(&library, query).0).expect("few");
        let names = columns.further.into_iter().map(|column| column.name);
        names.collect::<Vec<_>>()
    };
    // Answers without points have their columns.
    assert_eq!(names((3, IN_SPACE[0])), ["qx", "qy", "qz", "qw"]);
    assert_eq!(names((2, FLAT[0])), ["angle", "variant"]);
    assert_eq!(names((3, IN_SPACE[5])), ["layer", "scale"]);
}

#[test]
fn offsets_are_those_of_the_format_f32_and_need_room() {
    let library = library();
    // The first ones have no points.
    for (axes, query) in queries().filter(|(_, query)| !query.contains("spacing=50")) {
        let (planned, options) = planned(&library, (axes, query));
        let count = usize::try_from(planned.count()).expect("few");
        let mut at = vec![0_f32; axes * (count + 1)];
        let (filled, origin) = library.fill_offsets(&planned, &mut at).expect("room");
        assert_eq!((filled, &at[axes * count..]), (count, &[0.0; 3][..axes]));
        let answer = library.document(&planned, options, Encoding::F32);
        let answer = answer.expect("written");
        assert_eq!(answer.origin(), Some(origin));
        let bytes: Vec<u8> = answer.flat_map(|block| block.expect("whole")).collect();
        for (record, at) in bytes.chunks(bytes.len() / count).zip(at.chunks(axes)) {
            let expected: Vec<u8> = at.iter().flat_map(|v| v.to_le_bytes()).collect();
            assert_eq!(record[..4 * axes], expected);
        }
        let few = library.fill_coordinates(&planned, &mut vec![0.0; axes * count - 1]);
        assert_eq!(few.expect_err("no room").faults()[0].field, "capacity");
    }
}

#[test]
fn many_threads_make_the_points_of_one() {
    let library = library();
    for query in [
        (
            2,
            "bbox=-200,-200,200,210&spacing=0.7&seed=5&attributes=angle",
        ),
        (2, "circle=0,0,250&spacing=0.8"),
        (
            3,
            "bbox=-30,-30,-30,30,31,32&spacing=1&seed=5&attributes=u1",
        ),
    ] {
        let (planned, _) = planned(&library, query);
        assert!(planned.count() > 3 * (1 << 16), "{}", planned.count());
        let pool = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads")
        };
        let one = pool(1).install(|| library.columns(&planned)).expect("few");
        let three = pool(3).install(|| library.columns(&planned)).expect("few");
        assert_eq!(one, three);
        assert_eq!(
            pool(3).install(|| library.coordinates(&planned)),
            Ok(one.at)
        );
    }
}

#[test]
fn chunks_are_relative_to_their_corner_and_parts_are_the_whole() {
    let library = library();
    for (query, corner, side) in [
        ((2, FLAT[1]), Place::Plane([-192.0, 128.0]), 64.0),
        ((3, IN_SPACE[1]), Place::Space([-48.0, 32.0, 16.0]), 16.0),
    ] {
        let (whole, (axes, body)) = (planned(&library, query).0, query);
        let columns = library.columns(&whole).expect("few");
        assert_eq!(columns.origin, Some(corner));
        assert!(columns.at.iter().all(|v| (0.0..side).contains(v)));
        let mut joined = vec![];
        for (cursor, count) in library.split(&whole, "3").expect("three") {
            let body = body.strip_suffix('}').expect("an object");
            let part = format!(r#"{body}, "cursor": "{cursor}", "limit": {count}}}"#);
            let part = library.columns(&planned(&library, (axes, &part)).0);
            let part = part.expect("few");
            assert_eq!(part.len() as u64, count);
            joined.extend(part.ids);
        }
        assert_eq!(joined, columns.ids);
        let fault = library.split(&whole, "0").expect_err("too few");
        assert_eq!(fault.faults()[0].field, "parts");
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
    let missing = missing.expect_err("not there").faults()[0].clone();
    let way = Audience::PROCESS.table.expect("a way");
    assert!(
        missing.field == "profile" && missing.detail.ends_with(way),
        "{missing}"
    );
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
fn single_points_in_space_and_faults() {
    let library = library();
    let set = "spacing=1&seed=4&attributes=rotation";
    let found = library.nearest_in_space(&format!("at=5,5,5&k=2&{set}"));
    let found = found.expect("two");
    let again = library.point_in_space(&found[0].id, set).expect("there");
    assert_eq!(
        (again.x, again.y, again.z),
        (found[0].x, found[0].y, found[0].z)
    );
    assert!(again.z.is_some() && again.attributes.contains_key("qw"));
    let flat = library.nearest_in_space("at=5,5&spacing=1");
    assert_eq!(flat.expect_err("no z").faults()[0].field, "at");
    let flat = library.point_in_space("1:2", "spacing=1");
    assert_eq!(flat.expect_err("no z").faults()[0].field, "id");
    let refused = library.plan_in_space(br#"{"region": {"bbox": [0, 0, 0, 1]}, "periodic": 1}"#);
    let refused = refused.expect_err("faults");
    let fields: Vec<&str> = refused.faults().iter().map(|fault| &*fault.field).collect();
    assert_eq!(fields, ["periodic", "region.bbox", "spacing"]);
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
    let report = measure(points.clone(), &of, library.work()).expect("a square");
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
        let refused = measure(points.clone(), &of, library.work()).expect_err(field);
        assert_eq!(refused.faults()[0].field, field);
    }
}
