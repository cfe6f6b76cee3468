//! The command line has the points of REST.

use serde_json::Value;

use crate::support::{
    command::{errors, run},
    daemon::Daemon,
};

fn read(text: &[u8]) -> Value {
    serde_json::from_slice(text).expect("JSON")
}

#[test]
fn flags_have_the_points_of_addresses() {
    let daemon = Daemon::built_in();
    for (flags, query) in [
        (
            "--bbox=-3,10,-20,4,16,-15 --spacing 0.9 --seed 5",
            "bbox=-3,10,-20,4,16,-15&spacing=0.9&seed=5",
        ),
        (
            "--ball 1,2,3,4 --density 2 --attributes rotation,rank",
            "ball=1,2,3,4&density=2&attributes=rotation,rank",
        ),
        (
            "--ball 1,2,3,4 --min-distance 0.5 --profile spaced --keep 0.5 --limit 9",
            "ball=1,2,3,4&min_distance=0.5&profile=spaced&keep=0.5&limit=9",
        ),
    ] {
        for format in ["csv", "f32", "json"] {
            let flags: Vec<&str> = flags.split(' ').collect();
            let format_flag = format!("--format={format}");
            let arguments = [&["sample", "--space", "-q"], &flags[..], &[&format_flag]].concat();
            let output = run(&arguments, "");
            assert!(output.status.success(), "{}", errors(&output));
            let answer = daemon.get(&format!("/v1/space/points?{query}&format={format}"));
            assert_eq!(output.stdout, answer.body, "{query} {format}");
        }
    }
}

#[test]
fn chunks_counts_parts_and_single_points_are_those_of_rest() {
    let daemon = Daemon::built_in();
    let set = ["--space", "--spacing=0.8", "--seed=3"];
    let with = |command: &str, more: &[&str]| {
        let output = run(&[&[command], &set[..], more].concat(), "");
        assert!(output.status.success(), "{command}: {}", errors(&output));
        output.stdout
    };
    let chunk = with("sample", &["--chunk=4/-1/2/-3", "--format=csv"]);
    let answer = daemon.get("/v1/space/chunks/4/-1/2/-3?spacing=0.8&seed=3&format=csv");
    assert_eq!(chunk, answer.body);
    let count = with("count", &["--chunk=4/-1/2/-3"]);
    assert_eq!(
        String::from_utf8_lossy(&count).trim(),
        answer.header("strew-count")
    );
    let parts = with("split", &["--ball=0,0,0,5", "--parts=3"]);
    let mut joined = vec![];
    for part in String::from_utf8(parts).expect("UTF-8").lines() {
        let output = run(&["sample", "--space", "--query=-", "--format=f64"], part);
        assert!(output.status.success(), "{}", errors(&output));
        joined.extend(output.stdout);
    }
    let whole = daemon.get("/v1/space/points?ball=0,0,0,5&spacing=0.8&seed=3&format=f64");
    assert_eq!(joined, whole.body);
    let near = with("nearest", &["--at=1,2,3", "--json"]);
    let by_rest = daemon
        .get("/v1/space/nearest?at=1,2,3&spacing=0.8&seed=3")
        .json();
    assert_eq!(read(&near), by_rest);
    let id = by_rest["neighbors"][0]["id"]
        .as_str()
        .expect("a text")
        .to_owned();
    let point = with("point", &["--json", &id]);
    assert_eq!(
        read(&point),
        daemon
            .get(&format!("/v1/space/points/{id}?spacing=0.8&seed=3"))
            .json()
    );
}
