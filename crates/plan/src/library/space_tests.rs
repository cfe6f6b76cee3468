//! A library has the points, the documents and the words of a daemon's service in space.

use super::*;

fn library() -> Library {
    Library::new().expect("built-in tables")
}

const QUERIES: [&str; 6] = [
    "bbox=-9,-8,-7,20,11,12&spacing=1.3&seed=5&attributes=rotation,u1",
    "ball=1e6,-7,20,9&spacing=1.1&keep=0.5",
    r#"{"region": {"chunk": {"size": 16, "x": -3, "y": 2, "z": 1}}, "spacing": 2, "seed": 7}"#,
    r#"{"region": {"prism": {"polygon": {"type": "Polygon", "coordinates": [[[0, 0], [19, 1], [2, 17], [0, 0]]]},
        "bottom": -3, "top": 8}}, "spacing": 1.7, "attributes": ["variant"], "variants": {"gas": 1, "dust": 2}}"#,
    r#"{"region": {"bbox": [3, 4, 5, 23, 24, 25]}, "layers": [
        {"name": "a", "spacing": 2, "attributes": ["scale"]}, {"name": "b", "spacing": 3, "clear_of": {"a": 1}}]}"#,
    "bbox=0.1,0.1,0.1,0.2,0.2,0.2&spacing=50&attributes=rotation",
];

fn planned(library: &Library, query: &str) -> (Planned, Options) {
    let draft = Library::read_in_space(query).expect("read");
    library.plan_draft(&draft).expect(query)
}

#[test]
fn columns_are_the_rows_of_the_answer() {
    let library = library();
    for query in QUERIES {
        let (planned, options) = planned(&library, query);
        let columns = library.columns(&planned).expect("few");
        assert_eq!((columns.axes, planned.axes()), (3, 3));
        assert_eq!(columns.len() as u128, planned.count(), "{query}");
        assert_eq!(library.coordinates(&planned), Ok(columns.at.clone()));
        let json = library.document(&planned, options, Encoding::Json);
        let json: Vec<u8> = json
            .expect("written")
            .flat_map(|block| block.expect("whole"))
            .collect();
        let json: serde_json::Value = serde_json::from_slice(&json).expect("JSON");
        let rows = json["points"].as_array().expect("a list");
        assert_eq!(rows.len(), columns.len());
        let places = columns.at.chunks(3).zip(columns.ids.chunks(3));
        for (i, (row, (at, id))) in rows.iter().zip(places).enumerate() {
            let place = ["x", "y", "z"].map(|axis| row[axis].as_f64().expect("a number"));
            assert_eq!(place, at);
            assert_eq!(row["id"], format!("{}:{}:{}", id[0], id[1], id[2]));
            for column in &columns.further {
                match &column.values {
                    FurtherValues::Numbers(v) if v[i].is_nan() => {
                        assert!(row[&column.name].is_null());
                    }
                    FurtherValues::Numbers(v) => assert_eq!(row[&column.name], v[i]),
                    FurtherValues::Names(names, v) => {
                        let name = usize::try_from(v[i]).expect("a name");
                        assert_eq!(row[&column.name], names[name]);
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
    assert_eq!(names(QUERIES[5]), ["qx", "qy", "qz", "qw"]);
    assert_eq!(names(QUERIES[4]), ["layer", "scale"]);
}

#[test]
fn offsets_are_those_of_the_format_f32_and_need_room() {
    let library = library();
    for query in &QUERIES[..5] {
        let (planned, options) = planned(&library, query);
        let count = usize::try_from(planned.count()).expect("few");
        let mut at = vec![0_f32; 3 * (count + 1)];
        let (filled, origin) = library.fill_offsets(&planned, &mut at).expect("room");
        assert_eq!((filled, &at[3 * count..]), (count, &[0.0; 3][..]));
        let answer = library.document(&planned, options, Encoding::F32);
        let answer = answer.expect("written");
        assert_eq!(answer.origin(), Some(origin));
        let bytes: Vec<u8> = answer.flat_map(|block| block.expect("whole")).collect();
        for (record, at) in bytes.chunks(bytes.len() / count).zip(at.chunks(3)) {
            let expected: Vec<u8> = at.iter().flat_map(|v| v.to_le_bytes()).collect();
            assert_eq!(record[..12], expected);
        }
        let few = library.fill_coordinates(&planned, &mut vec![0.0; 3 * count - 1]);
        assert_eq!(few.expect_err("no room").faults()[0].field, "capacity");
    }
}

#[test]
fn many_threads_make_the_points_of_one() {
    let library = library();
    let query = "bbox=-30,-30,-30,30,31,32&spacing=1&seed=5&attributes=u1";
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

#[test]
fn parts_are_the_whole_and_chunks_have_a_corner() {
    let library = library();
    let whole = library
        .columns(&planned(&library, QUERIES[2]).0)
        .expect("few");
    assert_eq!(whole.origin, Some(Place::Space([-48.0, 32.0, 16.0])));
    assert!(whole.at.iter().all(|v| (0.0..16.0).contains(v)));
    let mut joined = vec![];
    let parts = library.split(&planned(&library, QUERIES[2]).0, "3");
    for (cursor, count) in parts.expect("three") {
        let more = format!(r#", "cursor": "{cursor}", "limit": {count}}}"#);
        let body = QUERIES[2].strip_suffix('}').expect("an object").to_owned() + &more;
        let (part, _) = library.plan_in_space(body.as_bytes()).expect("valid");
        joined.extend(library.columns(&part).expect("few").ids);
    }
    assert_eq!(joined, whole.ids);
}

#[test]
fn single_points_and_faults() {
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
    let refused = library.plan_in_space(br#"{"region": {"bbox": [0, 0, 0, 1]}, "settle": 1}"#);
    let refused = refused.expect_err("faults");
    let fields: Vec<&str> = refused.faults().iter().map(|fault| &*fault.field).collect();
    assert_eq!(fields, ["settle", "region.bbox", "spacing"]);
}
