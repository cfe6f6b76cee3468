//! The first seconds of `/`: points pour into place; all fits in windows of phones.

use serde_json::json;

use crate::support::browser::{Browser, key::ESCAPE, looking};

const POUR: &str = "document.documentElement.dataset.pour";

/// Whether the canvas of the pouring and the words are there.
const SEEN: &str = "['#pour', '#caption'].map((q) => !document.querySelector(q).hidden)";

#[test]
fn points_pour_into_place_on_a_first_visit() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.go(&daemon.url("/"));
    // First there is the flight, over all of the window, and ways on.
    browser.until("document.querySelector('#flight img').naturalWidth === 1200");
    assert_eq!(browser.value(SEEN), json!([false, false]));
    for way in [
        "#flight-points",
        "#flight a[href*=walk]",
        "#flight a[href*=how]",
    ] {
        assert_in_sight(&browser, way);
    }
    browser.keys(&[ESCAPE]);
    browser.until(&format!("{POUR} === 'done'"));
    assert_eq!(browser.value(SEEN), json!([false, true]));
    assert!(browser.text("#caption").contains("without an edge"));
    assert!(browser.ready() > 500);
    // A drag moves the plane, and the words go.
    let before = browser.value("strew.plane.view.x.f");
    browser.drag([900, 400], [-90, 20]);
    browser.until(&format!("strew.plane.view.x.f !== {before}"));
    assert_eq!(browser.value(SEEN), json!([false, false]));
    // The first frame is what chance would make: the same each time, with clumps and holes.
    let places = "(() => { const { pour } = strew; pour.begin(false); const all = []; \
        const { moveTo } = CanvasRenderingContext2D.prototype; \
        CanvasRenderingContext2D.prototype.moveTo = function (x, y) { all.push([x, y]); }; \
        pour.draw(0); CanvasRenderingContext2D.prototype.moveTo = moveTo; pour.end(); \
        const near = all.map(([x, y], i) => Math.min(...all.filter((_, j) => j !== i).map(([u, v]) => Math.hypot(x - u, y - v)))); \
        return [all.length, near.filter((v) => v < strew.plane.look.spacing / strew.plane.view.unit * 0.3).length / all.length]; })()";
    let first = browser.value(places);
    // Among independent points 1 - exp(-π·0.3²) of all, a quarter, have one so near; among those of the plane none.
    let close = first[1].as_f64().expect("a share");
    assert!((0.15..0.35).contains(&close), "{first}");
    assert_eq!(browser.value(places), first);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn the_pouring_is_left_at_once_and_only_seen_without_a_link() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=3,4&span=30");
    assert_eq!(browser.value(POUR), json!(null));
    assert_eq!(browser.value(SEEN), json!([false, false]));
    // A key ends it, whenever it comes.
    browser.value("strew.pour.begin(false)");
    assert_eq!(browser.value(SEEN), json!([true, true]));
    browser.keys(&[ESCAPE]);
    assert_eq!(browser.value(SEEN), json!([false, false]));
    // So does another view.
    browser.value("strew.pour.begin(false)");
    browser.value("strew.plane.zoom(2)");
    assert_eq!(browser.value(SEEN), json!([false, false]));
    browser.reduce_motion();
    browser.look(&daemon, "");
    assert_eq!(browser.value(POUR), "still");
    assert_eq!(browser.value(SEEN), json!([false, true]));
}

/// Fails unless an element is in the window, with nothing else over its middle.
fn assert_in_sight(browser: &Browser, selector: &str) {
    let found = browser.value(&format!(
        "(() => {{ const e = document.querySelector('{selector}'); const b = e.getBoundingClientRect(); \
         const over = document.elementFromPoint(b.left + b.width / 2, b.top + b.height / 2); \
         return b.left >= 0 && b.right <= innerWidth && b.bottom <= innerHeight && e.contains(over); }})()"
    ));
    assert_eq!(found, true, "{selector}");
}

#[test]
fn what_leads_on_is_in_sight_on_phones() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    browser.look(&daemon, "");
    for selector in [
        "#panel > header p",
        "#view-walk",
        "#view-portrait",
        "#view-plane",
        "#tab-take",
        "#paint-open",
    ] {
        assert_in_sight(&browser, selector);
    }
    // A phone on its side, and a window at 400 %.
    for (width, height) in [(844, 390), (320, 568)] {
        browser.resize(width, height);
        browser.look(&daemon, "#at=0,0&span=30&tab=start");
        let cards = ["#view-walk", "#view-portrait", "#view-plane"];
        for selector in cards.iter().filter(|_| width > height) {
            assert_in_sight(&browser, selector);
        }
        for selector in [
            "#paint-open",
            "#jump-at",
            "#jump button",
            "#theme",
            "#tab-take",
        ] {
            assert_in_sight(&browser, selector);
        }
        let field = browser.value("document.querySelector('#jump-at').clientWidth");
        assert!(field.as_u64() > Some(100), "{width}: {field}");
    }
    // The gallery says what its pictures mean.
    browser.resize(390, 844);
    browser.look(&daemon, "#at=0,0&span=30&tab=gallery");
    browser.click(".meaning summary");
    assert!(browser.text(".meaning").contains("Spectrum"));
    assert_in_sight(&browser, ".meaning p:last-child");
    assert_in_sight(&browser, "#tab-choose");
}
