//! Fields and pictures on the command line.

use std::fs;

use crate::support::{
    command::{Shell, assert_says, errors, run},
    daemon::Daemon,
    fields::{folder, left_half, png},
};

const SAMPLE: &str = "sample -q --bbox 0,0,40,40 --spacing 1 --seed 7 --format csv";

#[test]
fn names_documents_and_rasters_are_the_same_field() {
    let shell = Shell::of(folder());
    let sample = |flags: &str| shell.printed(&format!("{SAMPLE} {flags}"));
    let named = sample("--set fields.folder=. --field left");
    assert!(named.lines().count() > 700);
    assert_eq!(sample("--field left.toml"), named);
    let by_raster = sample("--raster left.png --raster-bbox 0,0,40,40");
    // It is linear between pixels.
    let lines = |text: &str| text.lines().count();
    assert!(lines(&by_raster).abs_diff(lines(&named)) < 100);
    let set = "--spacing 1 --seed 7 --field left.toml";
    let counted = shell.printed(&format!("count --bbox 0,0,40,40 {set}"));
    assert_eq!(counted.trim(), (lines(&named) - 1).to_string());
    let row = named.lines().nth(50).expect("a row");
    let id = row.split(',').next().expect("an id");
    assert!(shell.printed(&format!("point {id} {set}")).contains(id));
}

#[test]
fn what_a_query_describes_is_no_file_whatever_its_text_has() {
    let field =
        r#"{"raster": {"f32": "AACAPwAA/z4=", "width": 2, "height": 1, "bbox": [0, 0, 3, 3]}}"#;
    let of = |member: &str| {
        format!(r#"{{"region": {{"bbox": [0, 0, 3, 3]}}, "spacing": 1, "{member}": {field}}}"#)
    };
    let daemon = Daemon::start(&[]);
    for member in ["field", "terrain"] {
        let body: serde_json::Value = serde_json::from_str(&of(member)).expect("JSON");
        let count = daemon.post("/v1/count", &body).json()["count"].to_string();
        let output = run(&["count", "--query", "-"], &of(member));
        assert!(output.status.success(), "{member}: {}", errors(&output));
        assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), count);
    }
}

#[test]
fn bad_fields_name_the_file_and_what_is_allowed() {
    let shell = Shell::of(folder());
    shell.write("bad.json", r#"{"noise": {"wavelength": 9, "octaves": 20}}"#);
    shell.write("half.png", &left_half()[..45]);
    for (flags, words) in [
        ("--field bad.json", &["bad.json", "field.noise.octaves"][..]),
        ("--field nowhere.png", &["nowhere.png"]),
        (
            "--field nothing",
            &["--field nothing: no such field is loaded; allowed: forest"],
        ),
        (
            "--raster left.png --raster-bbox 0,0,1",
            &["--raster-bbox 0,0,1: expected 4 numbers"],
        ),
        ("--raster-bbox 0,0,1,1", &["--raster"]),
        ("--raster half.png", &["half.png", "damaged or truncated"]),
    ] {
        shell.assert_refused(&format!("{SAMPLE} {flags}"), words);
    }
}

/// A folder with a picture that is black on the left, white on the right, in shades between.
fn shades() -> Shell {
    let shell = Shell::new();
    shell.write("shades.png", png([64, 32], |x, _| (x * 4) as u8));
    shell
}

#[test]
fn dots_are_as_many_as_requested_and_as_dense_as_the_picture_is_dark() {
    let shell = shades();
    let stipple = |flags: &str| {
        let line = format!("stipple shades.png -q --points 2000 --format csv {flags}");
        shell.printed(&line)
    };
    let x = |csv: &str| {
        let values = csv
            .lines()
            .skip(1)
            .map(|line| line.split(',').nth(1).expect("x").to_owned());
        values
            .map(|x| x.parse::<f64>().expect("a number"))
            .collect::<Vec<_>>()
    };
    let dark = x(&stipple(""));
    assert_eq!(dark.len(), 2000);
    // Linear light: a gray of 128 has 22 % of the light of white.
    let expected = |from: u32, to: u32, is_light: bool| {
        let light = |v: f64| {
            if v <= 0.04045 {
                v / 12.92
            } else {
                ((v + 0.055) / 1.055).powf(2.4)
            }
        };
        let share = |x: u32| light(f64::from(x * 4) / 255.0);
        let share = |x| if is_light { share(x) } else { 1.0 - share(x) };
        let all: f64 = (0..64).map(share).sum();
        (from..to).map(share).sum::<f64>() / all
    };
    let part = |values: &[f64], from: u32, to: u32| {
        let inside = values
            .iter()
            .filter(|x| (f64::from(from)..f64::from(to)).contains(*x));
        inside.count() as f64 / values.len() as f64
    };
    let light = x(&stipple("--invert"));
    for (from, to) in [(0, 16), (16, 32), (32, 48), (48, 64)] {
        assert!((part(&dark, from, to) - expected(from, to, false)).abs() < 0.02);
        assert!((part(&light, from, to) - expected(from, to, true)).abs() < 0.02);
    }
    let hard = x(&stipple("--gamma 4"));
    assert!(part(&hard, 0, 16) > part(&dark, 0, 16) + 0.03);
}

/// The root mean square of what a Gaussian as wide as dots are apart sees of dots of [`shades`], about the mean of each
/// column, over that mean. The picture is the same along columns, so none of it is the picture's.
fn unevenness(dots: &[[f64; 2]]) -> f64 {
    let density = |at: [f64; 2]| -> f64 {
        let far = dots
            .iter()
            .map(|[x, y]| (x - at[0]).powi(2) + (y - at[1]).powi(2));
        far.map(|squared| (-squared / 2.0).exp()).sum()
    };
    let mut squares = vec![];
    for x in 4..48 {
        let column: Vec<f64> = (8..49)
            .map(|y| density([f64::from(x), f64::from(y) / 2.0]))
            .collect();
        let mean = column.iter().sum::<f64>() / column.len() as f64;
        squares.extend(column.iter().map(|v| (v / mean - 1.0).powi(2)));
    }
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn dots_settle_unless_they_shall_stay() {
    let shell = shades();
    let stipple = |flags: &str| {
        let line = format!("stipple shades.png -q -n 2000 --format csv {flags}");
        shell.printed(&line)
    };
    let dots = |csv: &str| {
        let places = csv.lines().skip(1).map(|line| {
            let mut numbers = line
                .split(',')
                .skip(1)
                .map(|v| v.parse::<f64>().expect("a number"));
            [(); 2].map(|()| numbers.next().expect("x and y"))
        });
        places.collect::<Vec<_>>()
    };
    let settled = stipple("--settle 3");
    assert_eq!(settled, stipple(""));
    let [placed, settled] = [stipple("--settle 0"), settled].map(|csv| dots(&csv));
    assert_eq!([placed.len(), settled.len()], [2000; 2]);
    assert!(placed != settled);
    for end in [16.0, 32.0, 48.0] {
        let [before, after] = [&placed, &settled].map(|dots| {
            let left = dots.iter().filter(|dot| dot[0] < end);
            left.count() as f64 / 2000.0
        });
        assert!((before - after).abs() < 0.01, "{end}: {before}, {after}");
    }
    let [before, after] = [&placed, &settled].map(|dots| unevenness(dots));
    assert!(after < 0.5 * before, "{before}, {after}");
}

#[test]
fn dots_are_written_as_pictures() {
    let shell = shades();
    for name in ["out.svg", "out.png"] {
        let line = format!("stipple shades.png --points 500 -o {name}");
        let said = errors(&shell.run(&line, ""));
        assert!(said.contains("500 points"), "{said}");
    }
    let read = |name: &str| String::from_utf8(shell.read(name)).expect("UTF-8");
    let svg = read("out.svg");
    assert_eq!(svg.matches("<circle").count(), 500);
    assert!(svg.contains("width=\"512\" height=\"256\""), "{svg:.200}");
    let radius = |svg: &str| -> f64 {
        let after = svg.split_once(" r=\"").expect("a circle").1;
        let number = after.split_once('"').expect("quoted").0;
        number.parse().expect("a number")
    };
    shell.printed("stipple shades.png -q -n 500 --dot 0.5 -o small.svg");
    assert!((radius(&svg) / radius(&read("small.svg")) - 2.0).abs() < 0.05);
    // A repeated command writes the same bytes.
    shell.printed("stipple shades.png -q -n 500 -o again.svg");
    assert_eq!(read("again.svg"), svg);
}

#[test]
fn what_cannot_be_done_is_told_before_the_work() {
    let shell = shades();
    fs::create_dir(shell.path("d.svg")).expect("a folder");
    let output = shell.run("stipple shades.png -n 9 -o d.svg", "");
    assert_eq!(output.status.code(), Some(1));
    assert_says(&output, "it is a folder");
    shell.write("white.png", png([4, 4], |_, _| 255));
    shell.write("other.gif", "GIF89a");
    for (flags, words) in [
        ("white.png -n 9", "is all white"),
        (
            "other.gif -n 9",
            "no known format; allowed: a PNG, JPEG, WebP",
        ),
        ("nothing.png -n 9", "cannot read the picture"),
        (
            "shades.png -n 0",
            "--points 0: out of range; allowed: an integer from 1",
        ),
        (
            "shades.png -n 9 --gamma 0",
            "--gamma 0: out of range; allowed: a number from 0.01",
        ),
        ("shades.png -n 9 --dot 99", "--dot 99: out of range"),
        (
            "shades.png -n 9 --settle 5",
            "--settle 5: out of range; allowed: an integer from 0 to 4",
        ),
        ("shades.png -n 9 --settle -1", "--settle -1"),
        ("shades.png -n 9 --profile red", "no such profile is loaded"),
        ("shades.png -n 9 -o x.gif", "ends with .gif"),
    ] {
        shell.assert_refused(&format!("stipple {flags}"), &[words]);
    }
}
