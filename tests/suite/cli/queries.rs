//! `sample`, `count`, `point`, `nearest` and `split`: the features and answers of REST without a
//! server.

use std::collections::BTreeSet;

use parquet::file::reader::{FileReader as _, SerializedFileReader};
use serde_json::{Value, json};
use strew_testkit::http1;

use super::output;
use crate::support::{command::run, daemon::Daemon};

fn lines(bytes: &[u8]) -> Vec<String> {
    let text = std::str::from_utf8(bytes).expect("UTF-8");
    text.lines().map(Into::into).collect()
}

fn read(text: &[u8]) -> Value {
    serde_json::from_slice(text).expect("JSON")
}

/// Queries as flags and as parameters of REST.
const QUERIES: [(&str, &str); 9] = [
    (
        "--bbox -3.5,1,40,33.25 --density 0.7",
        "bbox=-3.5,1,40,33.25&density=0.7",
    ),
    (
        "--circle 5,-5,9.5 --spacing 0.9 --seed 3",
        "circle=5,-5,9.5&spacing=0.9&seed=3",
    ),
    (
        "--polygon 0,0,20,3,4,17 --min-distance 0.5 --warp 0.4",
        "polygon=0,0,20,3,4,17&min_distance=0.5&warp=0.4",
    ),
    (
        "--bbox 0,0,10,10 --count 77 --seed 5",
        "bbox=0,0,10,10&count=77&seed=5",
    ),
    (
        "--bbox 0,0,30,30 --spacing 1 --keep 0.3 --profile spaced --alpha sqrt(3) --map s",
        "bbox=0,0,30,30&spacing=1&keep=0.3&profile=spaced&alpha=sqrt(3)&map=s",
    ),
    (
        "--bbox 0,0,9,9 --spacing 1 --attributes angle,scale,variant,rank,u7 --scale-range 0.8,1.2 \
         --variants oak:3,birch:1 --decimals 4",
        "bbox=0,0,9,9&spacing=1&attributes=angle,scale,variant,rank,u7&scale_range=0.8,1.2&\
         variants=oak:3,birch:1&decimals=4",
    ),
    (
        "--bbox 0,0,30,30 --spacing 1 --offset 10 --limit 25",
        "bbox=0,0,30,30&spacing=1&offset=10&limit=25",
    ),
    (
        "--bbox 0,0,9,9 --spacing 1 --table \
         964d5f8f3b54b47d272533f84423daa3e9b1dd6624fa906325132538c062fa4a",
        "bbox=0,0,9,9&spacing=1&table=\
         964d5f8f3b54b47d272533f84423daa3e9b1dd6624fa906325132538c062fa4a",
    ),
    ("--chunk 64/-3/2 --spacing 5 --seed 1", "spacing=5&seed=1"),
];

fn path_of(query: &str) -> String {
    let place = if query.contains("bbox") || query.contains("circle") || query.contains("polygon") {
        "points"
    } else {
        "chunks/64/-3/2"
    };
    format!("/v1/{place}?{query}")
}

#[test]
fn the_flags_are_the_parameters_of_rest() {
    let document = Daemon::start(&[]).get("/openapi.json").json();
    let own = [
        "help",
        "config",
        "listen",
        "tables",
        "set",
        "raster",
        "raster-bbox",
        "white",
        "space",
    ];
    // Where the query comes from.
    let query = [
        "query",
        "region",
        "features",
        "feature-id",
        "feature-count",
        "strata",
        "classes",
        "chunk",
        "ball",
    ];
    for (command, path, more) in [
        ("sample", "/v1/points", &["output", "quiet", "zstd"][..]),
        ("count", "/v1/count", &["json"]),
        ("point", "/v1/points/{id}", &["json"]),
        ("nearest", "/v1/nearest", &["json"]),
    ] {
        let parameters = document["paths"][path]["get"]["parameters"].as_array();
        let documented: BTreeSet<String> = parameters
            .expect("a list")
            .iter()
            .map(|parameter| {
                let reference = parameter["$ref"].as_str().expect("a reference");
                document.pointer(&reference[1..]).expect("a component")
            })
            .filter(|parameter| parameter["in"] == "query")
            .map(|parameter| {
                parameter["name"]
                    .as_str()
                    .expect("a name")
                    .replace('_', "-")
            })
            .collect();
        let help = lines(&output(&[command, "--help"], ""));
        let flags = help.iter().filter_map(|line| line.split_once("--"));
        let flags = flags.filter(|(before, _)| before.trim().is_empty() || before.ends_with(", "));
        let names = flags.map(|(_, rest)| {
            let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '-');
            rest[..end.unwrap_or(rest.len())].to_owned()
        });
        let has_region = ["sample", "count"].contains(&command);
        let ignored = |name: &str| {
            own.contains(&name) || more.contains(&name) || has_region && query.contains(&name)
        };
        let flags: BTreeSet<String> = names.filter(|name| !ignored(name)).collect();
        assert_eq!(flags, documented, "{command}");
    }
}

#[test]
fn samples_are_the_answers_of_rest() {
    let daemon = Daemon::start(&[]);
    for (flags, query) in QUERIES {
        for format in ["json", "csv", "ply"] {
            if format == "ply" && query.contains("decimals") {
                continue;
            }
            let answer = daemon.get(&format!("{}&format={format}", path_of(query)));
            assert_eq!(answer.status, 200, "{query}: {:?}", answer.headers);
            let mut arguments = vec!["sample", "--format", format];
            arguments.extend(flags.split_whitespace());
            let output = run(&arguments, "");
            assert!(output.stdout == answer.body, "{flags} as {format}");
            let message = String::from_utf8(output.stderr).expect("UTF-8");
            let count = answer.header("strew-count");
            assert!(
                message.starts_with(&format!("{count} points as {format}")),
                "{message}"
            );
            let next = answer.header("strew-next");
            assert_eq!(
                message.contains("the rest begins"),
                !next.is_empty(),
                "{message}"
            );
            assert!(message.contains(next), "{message}");
        }
    }
}

#[test]
fn count_point_and_nearest_print_the_documents_of_rest() {
    let daemon = Daemon::start(&[]);
    for (flags, query) in QUERIES {
        if ["decimals", "offset"]
            .iter()
            .any(|word| query.contains(word))
            || flags.contains("chunk")
        {
            continue;
        }
        let document = daemon.get(&format!("/v1/count?{query}"));
        let mut arguments = vec!["count", "--json"];
        arguments.extend(flags.split_whitespace());
        assert_eq!(output(&arguments, ""), document.body, "{flags}");
        arguments.remove(1);
        let count = lines(&output(&arguments, ""));
        assert_eq!(count, [document.json()["count"].to_string()]);
    }
    let set = "--spacing 1 --seed 2 --attributes angle,u1";
    let same = "spacing=1&seed=2&attributes=angle,u1";
    let nearest = daemon.get(&format!("/v1/nearest?at=-3,4&k=3&radius=2&{same}"));
    let mut arguments = vec!["nearest", "--at", "-3,4", "--k=3", "--radius=2"];
    arguments.extend(set.split_whitespace());
    let listed = lines(&output(&arguments, ""));
    arguments.push("--json");
    assert_eq!(output(&arguments, ""), nearest.body);
    let neighbors = nearest.json()["neighbors"].clone();
    let listed: Vec<Value> = listed.iter().map(|line| read(line.as_bytes())).collect();
    assert_eq!(neighbors, Value::Array(listed));

    let id = neighbors[0]["id"].as_str().expect("an id");
    let point = daemon.get(&format!("/v1/points/{id}?{same}"));
    let mut arguments = vec!["point", id];
    arguments.extend(set.split_whitespace());
    let line = read(&output(&arguments, ""));
    arguments.push("--json");
    assert_eq!(output(&arguments, ""), point.body);
    assert_eq!(line, point.json()["point"]);
}

/// Layers and a region with a hole, which only a body can express.
fn layered() -> Value {
    json!({
        "region": {
            "include": [{ "bbox": [0, 0, 30, 20] }],
            "exclude": [{ "circle": { "center": [9.1, 9.3], "radius": 4 } }],
        },
        "layers": [
            { "name": "trees", "min_distance": 1.7, "seed": 1, "attributes": ["angle", "variant"],
              "variants": { "oak": 3, "birch": 1 } },
            { "name": "rocks", "spacing": 0.9, "seed": 2, "clear_of": { "trees": 0.6 },
              "attributes": ["scale"], "scale_range": [0.1, 0.7] },
        ],
    })
}

#[test]
fn a_query_file_is_a_rest_body_and_flags_override_its_format() {
    let daemon = Daemon::start(&[]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("query.json");
    std::fs::write(&file, layered().to_string()).expect("writable");
    let name = file.to_str().expect("Unicode");
    for (flags, looks) in [
        (vec![], json!({})),
        (
            vec!["--format", "csv", "--decimals=2"],
            json!({ "format": "csv", "decimals": 2 }),
        ),
        (
            vec!["--format", "png", "--size", "99"],
            json!({ "format": "png", "size": 99 }),
        ),
        (vec!["--format", "arrow"], json!({ "format": "arrow" })),
    ] {
        let mut query = layered();
        query["format"] = "json".into();
        for (name, value) in looks.as_object().expect("an object") {
            query[name] = value.clone();
        }
        let body = query.to_string();
        let answer = http1::open_post(daemon.address(), "/v1/points:query", &[], body.as_bytes());
        assert_eq!(answer.status, 200, "{body}");
        let (expected, _) = answer.finish();
        let mut arguments = vec!["sample", "--query", name];
        arguments.extend(&flags);
        assert!(output(&arguments, "") == expected, "{flags:?}");
        assert!(
            output(&["sample", "--query", "-"], &body) == expected,
            "{body}"
        );
    }
}

#[test]
fn parquet_holds_layers_and_attributes() {
    let folder = tempfile::tempdir().expect("a folder");
    let query = layered().to_string();
    let csv = output(&["sample", "--query=-", "--format=csv"], &query);
    let csv = lines(&csv);
    let file = folder.path().join("points.parquet");
    let name = file.to_str().expect("Unicode");
    output(&["sample", "--query=-", "-o", name], &query);
    let mut by_name = layered();
    by_name["format"] = "parquet".into();
    let named = output(&["sample", "--query=-"], &by_name.to_string());
    assert!(std::fs::read(&file).expect("written") == named);

    let file = std::fs::File::open(&file).expect("written");
    let reader = SerializedFileReader::new(file).expect("Parquet");
    let columns: BTreeSet<String> = reader
        .metadata()
        .file_metadata()
        .schema()
        .get_fields()
        .iter()
        .map(|field| field.name().to_owned())
        .collect();
    let names: BTreeSet<String> = csv[0].split(',').map(Into::into).collect();
    let geometry = BTreeSet::from(["geometry".to_owned()]);
    assert_eq!(columns, &names | &geometry);
    let mut rows = 0;
    for row in reader {
        row.expect("whole");
        rows += 1;
    }
    assert_eq!(rows, csv.len() - 1);
    assert!(csv[1].starts_with("trees,") && csv[rows].starts_with("rocks,"));
}

#[test]
fn the_parts_of_a_split_make_the_whole() {
    let daemon = Daemon::start(&[]);
    let mut whole = layered();
    whole["format"] = "csv".into();
    let body = whole.to_string();
    let expected = output(&["sample", "--query=-"], &body);
    let parts = lines(&output(&["split", "--parts=5", "--query=-"], &body));
    assert_eq!(parts.len(), 5);
    let sampled = |part: &String| lines(&output(&["sample", "--query=-"], part))[1..].to_vec();
    let joined: Vec<String> = parts.iter().flat_map(sampled).collect();
    assert_eq!(joined, lines(&expected)[1..]);

    let path = "/v1/points:split?parts=5";
    let (answer, _) = http1::open_post(daemon.address(), path, &[], body.as_bytes()).finish();
    let document = read(&output(
        &["split", "--parts=5", "--query=-", "--json"],
        &body,
    ));
    let answered = read(&answer);
    assert_eq!(document["count"], answered["count"]);
    for (i, part) in parts.iter().enumerate() {
        let (own, rest) = (&document["parts"][i], &answered["parts"][i]);
        assert_eq!(own["query"], read(part.as_bytes()));
        assert_eq!(own["count"], rest["count"]);
        for name in ["cursor", "limit", "format"] {
            assert_eq!(own["query"][name], rest["query"][name], "{name}");
        }
    }
    // Numbers with many digits survive being written.
    let odd = "--circle=0.1,-1e-7,7.3000000000000025 --density=1.1000000000000003 --seed=9";
    let mut arguments = vec!["split", "--parts=2"];
    arguments.extend(odd.split_whitespace());
    for part in lines(&output(&arguments, "")) {
        output(&["sample", "--query=-"], &part);
    }
}

#[test]
fn regions_are_read_from_geojson() {
    let left = json!([[[0, 0], [10, 0], [3, 10], [0, 0]]]);
    let right = json!([[[10, 0], [13, 10], [3, 10], [10, 0]]]);
    let feature = |rings: &Value| {
        json!({ "type": "Feature", "properties": {},
                "geometry": { "type": "Polygon", "coordinates": rings } })
    };
    let both =
        json!({ "type": "FeatureCollection", "features": [feature(&left), feature(&right)] });
    let sample = |region: &Value| {
        let region = region.to_string();
        let arguments = [
            "sample",
            "--region=-",
            "--spacing=0.3",
            "--seed=4",
            "--format=csv",
        ];
        let rows = lines(&output(&arguments, &region))[1..].to_vec();
        rows.into_iter().collect::<BTreeSet<_>>()
    };
    let [left, right] = [feature(&left), feature(&right)].map(|region| sample(&region));
    assert!(left.is_disjoint(&right) && !left.is_empty());
    assert_eq!(sample(&both), &left | &right);
}
