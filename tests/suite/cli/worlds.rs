//! Worlds on the command line.

use super::{printed, settings};
use crate::support::command::{errors, run};

const WORLDS: &str = "\
[[worlds.forest.layers]]
name = 'oak'
spacing = 3
seed = 7
[[worlds.forest.layers]]
name = 'rock'
spacing = 2
clear_of = { oak = 1 }
";

#[test]
fn a_sample_of_a_world_has_its_layers() {
    let (_folder, file) = settings(WORLDS);
    let sample = ["sample", "-q", "--chunk", "16/3/-2", "--format", "csv"];
    let of_world = ["--config", &file, "--world", "forest"];
    let all = printed(&[&sample[..], &of_world].concat());
    let oaks = printed(&[&sample[..], &of_world, &["--only", "oak"]].concat());
    let rows = |text: &str| text.lines().filter(|row| row.starts_with("oak,")).count();
    assert!(rows(&all) > 0 && rows(&all) == oaks.lines().count() - 1);
    // The parts of a split need no world.
    let chunk = ["--chunk", "16/3/-2", "--parts", "2"];
    let parts = printed(&[&["split"], &chunk[..], &of_world].concat());
    let points = parts.lines().map(|part| {
        let output = run(&["sample", "-q", "--query", "-", "--format", "csv"], part);
        assert!(output.status.success(), "{}", errors(&output));
        let text = String::from_utf8(output.stdout).expect("UTF-8");
        text.lines()
            .skip(1)
            .map(ToString::to_string)
            .collect::<Vec<_>>()
    });
    let points: Vec<String> = points.flatten().collect();
    assert_eq!(points, all.lines().skip(1).collect::<Vec<_>>());
}

#[test]
fn a_check_names_what_is_wrong() {
    let (_folder, file) = settings(WORLDS);
    let list = printed(&["worlds", "list", "--config", &file]);
    assert_eq!(printed(&["worlds", "check", "--config", &file]), list);
    let words: Vec<&str> = list.split_whitespace().collect();
    assert_eq!(
        (words[0], words[1].len(), words[2]),
        ("forest", 64, "oak,rock")
    );
    let wrong = WORLDS.replace("spacing = 3", "spacing = -3");
    let other = "[worlds.heath]\nprofile = 'step'\nmin_distance = 2\n[worlds.fen]\ndensity = 1\n";
    let (_folder, file) = settings(&format!("{other}{wrong}"));
    let output = run(&["worlds", "check", "--config", &file], "");
    assert_eq!(output.status.code(), Some(2));
    let errors = errors(&output);
    for fault in [
        "`worlds.forest.layers.oak.spacing` = `-3`",
        "`worlds.heath.min_distance` = `2",
    ] {
        assert!(errors.contains(fault), "{errors}");
    }
    assert!(output.stdout.starts_with(b"fen  "));
}

#[test]
fn a_check_looks_at_the_format_of_a_world_too() {
    let of = |more: &str| format!("[worlds.heath]\nspacing = 2\nattributes = ['u1']\n{more}\n");
    for (more, words) in [
        ("format = 'instances'", "no room for u1"),
        (
            "format = 'f32'\ndecimals = 3",
            "has no effect in the format f32",
        ),
    ] {
        let (_folder, file) = settings(&of(more));
        let output = run(&["worlds", "check", "--config", &file], "");
        assert_eq!(output.status.code(), Some(2), "{more}");
        let text = errors(&output);
        assert!(text.contains("heath") && text.contains(words), "{text}");
    }
    let (_folder, file) = settings(&of("format = 'csv'\ndecimals = 3"));
    assert!(printed(&["worlds", "check", "--config", &file]).contains("heath"));
}
