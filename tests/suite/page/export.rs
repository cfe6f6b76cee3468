//! The exports that the page offers: requests that return exactly the points in view, and files.

use std::process::Command;

use serde_json::{Value, json};
use strew_testkit::wait::until;

use crate::support::{
    browser::{Browser, looking},
    clients,
};

/// The request that the copy button puts into the clipboard; `way` is its language.
pub(super) fn copied(browser: &Browser, way: &str) -> String {
    browser.click(&format!("#way-{way}"));
    browser.click("#copy");
    browser.until("document.querySelector('#copy').textContent === 'Copied'");
    let text = browser.value("navigator.clipboard.readText()");
    text.as_str().expect("text").into()
}

/// Fails unless these points are those in view.
pub(super) fn assert_same(browser: &Browser, found: &[[f64; 2]]) {
    let middle = browser.value("[strew.plane.view.x, strew.plane.view.y].map(({ i, f }) => i + f)");
    let middle = [0, 1].map(|i| middle[i].as_f64().expect("a number"));
    let mut found: Vec<[f64; 2]> = found
        .iter()
        .map(|p| [p[0] - middle[0], p[1] - middle[1]])
        .collect();
    let mut seen = browser.in_view();
    assert_eq!(seen.len(), found.len());
    for list in [&mut seen, &mut found] {
        list.sort_by_key(|p| p.map(|v| (v * 1000.0).round() as i64));
    }
    for (a, b) in seen.iter().zip(&found) {
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-3, "{a:?} {b:?}");
    }
}

pub(super) fn rows(csv: &str) -> Vec<[f64; 2]> {
    let header = csv.lines().next().expect("a header");
    let columns: Vec<&str> = header.split(',').collect();
    let [x, y] = ["x", "y"].map(|name| columns.iter().position(|c| *c == name).expect("a column"));
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        [x, y].map(|i| fields[i].parse().expect("a number"))
    };
    csv.lines().skip(1).map(row).collect()
}

#[test]
fn a_copied_request_returns_the_points_in_view() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(
        &daemon,
        "#at=1000.5,-20&span=35&seed=3&profile=spaced&warp=1.5&angle=1&tab=take",
    );
    browser.allow_clipboard();
    browser.until("document.documentElement.dataset.weighed");
    let url = copied(&browser, "url");
    let path = url
        .strip_prefix(&daemon.url(""))
        .expect("an address of the daemon");
    let answer = daemon.get(path);
    assert_eq!(answer.status, 200, "{}", answer.text());
    assert_same(&browser, &rows(answer.text()));
    let line = copied(&browser, "curl");
    assert!(
        line.starts_with(&format!("curl -f '{url}' -o points.csv")),
        "{line}"
    );
    run(&line, "curl", |text| assert_same(&browser, &rows(text)));
    let program = copied(&browser, "python");
    let python = Command::new("python3").args(["-c", &program]).output();
    match python {
        Ok(output) => {
            let printed = String::from_utf8_lossy(&output.stdout).into_owned();
            let errors = String::from_utf8_lossy(&output.stderr).into_owned();
            let count = browser.ready();
            assert!(
                printed.starts_with(&format!("{count} points")),
                "{printed} {errors}"
            );
        }
        Err(_) => eprintln!("skipped: python3 is not installed"),
    }
}

/// Runs a shell command that writes points.csv, in a folder of its own, and passes the file to
/// `look`.
pub(super) fn run(line: &str, needs: &str, look: impl Fn(&str)) {
    if clients::find(needs).is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let shell = Command::new("sh")
        .args(["-c", line])
        .current_dir(folder.path())
        .output()
        .expect("a shell");
    assert!(
        shell.status.success(),
        "{line}: {}",
        String::from_utf8_lossy(&shell.stderr)
    );
    look(&std::fs::read_to_string(folder.path().join("points.csv")).expect("written"));
}

#[test]
fn a_copied_request_for_layers_returns_the_points_in_view() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    let hash = "#at=-5,7&span=25&layers=2&seed=18446744073709551615&2.amount=2&2.seed=4&2.variant=1&2.scale=1&2.clear=0.6&tab=take";
    browser.look(&daemon, hash);
    browser.allow_clipboard();
    browser.until("document.documentElement.dataset.weighed");
    let line = copied(&browser, "curl");
    let body = line
        .split("-d '")
        .nth(1)
        .expect("a body")
        .trim_end_matches('\'');
    let body: Value = serde_json::from_str(body).expect("JSON");
    assert_eq!(body["layers"][0]["seed"], u64::MAX);
    let answer = daemon.post("/v1/points:query", &body);
    assert_eq!(answer.status, 200, "{}", answer.text());
    assert_same(&browser, &rows(answer.text()));
    let layer = &body["layers"][1];
    assert_eq!(layer["clear_of"]["layer1"], 0.6);
    assert_eq!(layer["scale_range"], json!([0.5, 1.5]));
}

#[test]
fn what_repeats_is_taken_away_as_it_is_shown() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30&seed=7&tab=take&take=tile");
    browser.until("document.documentElement.dataset.weighed === '5041'");
    assert_eq!(browser.text("#take-count"), "5,041 points");
    // The picture shows two copies along each side.
    let half = "(() => { const { width, height } = document.querySelector('#repeat-picture'); \
        const part = (x) => document.querySelector('#repeat-picture').getContext('2d') \
            .getImageData(x, 0, width / 2, height).data; \
        const [left, right] = [part(0), part(width / 2)]; \
        return left.some((v) => v !== left[0]) && left.every((v, i) => v === right[i]); })()";
    assert_eq!(browser.value(half), true);
    browser.allow_clipboard();
    let url = copied(&browser, "url");
    let path = url.strip_prefix(&daemon.url("")).expect("of this daemon");
    let answer = daemon.get(path);
    assert_eq!(answer.header("strew-count"), "5041", "{path}");
    // Another size, then a mask, and Back to the tile.
    browser.choose("#repeat-size", "9409");
    browser.until("document.querySelector('#take-count').textContent === '9,409 points'");
    assert!(browser.text("#command").contains("periodic=9409"));
    browser.choose("#take-what", "mask");
    browser.until("document.querySelector('#take-size').textContent.endsWith(' as png')");
    let line = copied(&browser, "curl");
    assert!(
        line.contains("/v1/mask.png?size=128") && line.contains("-o mask.png"),
        "{line}"
    );
    browser.value("(history.back(), 0)");
    browser.until("document.querySelector('#take-what').value === 'tile'");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_download_has_the_count_and_the_size_that_were_shown() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    for (hash, format) in [("", "f64"), ("", "csv"), ("&layers=2&2.amount=2", "npy")] {
        browser.look(&daemon, &format!("#at=0,0&span=30&tab=take{hash}"));
        browser.until("document.documentElement.dataset.weighed");
        browser.choose("#format", format);
        browser.until(&format!("document.querySelector('#take-size').textContent.endsWith(' as {format}') && !document.querySelector('#download').disabled"));
        let count: u64 = browser
            .text("#take-count")
            .replace(',', "")
            .trim_end_matches(" points")
            .parse()
            .expect("a count");
        assert_eq!(count, browser.ready());
        let size = browser.value("[strew.take.weight.bytes, strew.take.weight.isExact]");
        let (size, is_exact) = (size[0].as_u64().expect("bytes"), size[1] == true);
        browser.click("#download");
        let file = browser.downloads().join(format!("points.{format}"));
        let bytes = until("the file is whole", || {
            let partial = browser
                .downloads()
                .join(format!("points.{format}.crdownload"));
            let bytes = std::fs::read(&file).ok()?;
            (!partial.exists() && !bytes.is_empty()).then_some(bytes)
        });
        match format {
            "csv" => {
                assert_eq!(
                    bytes.iter().filter(|b| **b == b'\n').count() as u64,
                    count + 1
                );
                assert!(
                    (bytes.len() as f64 / size as f64 - 1.0).abs() < 0.1,
                    "{size}"
                );
            }
            "f64" => assert_eq!((bytes.len() as u64, is_exact), (16 * count, true)),
            _ => assert!(bytes.starts_with(b"\x93NUMPY")),
        }
        if is_exact {
            assert_eq!(bytes.len() as u64, size, "{format}");
        }
        std::fs::remove_file(&file).expect("removed");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}
