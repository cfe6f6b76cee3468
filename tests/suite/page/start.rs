//! The first screen: what it shows, and what it leads to.

use serde_json::json;

use crate::support::{
    browser::{Browser, looking},
    daemon::Daemon,
};

/// Opens the page without a link, and waits for its pictures.
pub(super) fn first_visit(browser: &Browser, daemon: &Daemon) {
    browser.look(daemon, "");
    browser.until("document.documentElement.dataset.start === 'ready'");
}

#[test]
fn three_kinds_of_points_are_shown_with_views_to_begin_with() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    first_visit(&browser, &daemon);
    let counts = browser.value("strew.start.trio.map((one) => one.points.length / 2)");
    assert_eq!(counts, json!([196, 196, 196]));
    let drawn = browser.value("strew.start.views.filter((view) => view.draw).length");
    assert_eq!(drawn, 6);
    assert_eq!(
        browser.value("document.querySelector('#view-walk img').naturalWidth"),
        480
    );
    let before = browser.value("strew.start.trio[2].points[0]");
    browser.click("#kinds-again");
    browser.until(&format!("strew.start.trio[2].points[0] !== {before}"));
    browser.allow_clipboard();
    browser.click("#share");
    browser.until("document.querySelector('#said').textContent === 'The link is copied.'");
    let same = "navigator.clipboard.readText().then((text) => text === location.href && text.includes('#at='))";
    assert_eq!(browser.value(same), true);
    for (view, part) in [("portrait", "field=portrait"), ("forest", "field=forest")] {
        browser.click("#tab-start");
        browser.click(&format!("#view-{view}"));
        browser.until(&format!("location.hash.includes('{part}')"));
        assert!(browser.ready() > 500, "{view}");
    }
    // The tile has a page of its own.
    let tile = browser.value("document.querySelector('#view-tile').getAttribute('href')");
    assert_eq!(tile, "/tile");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn the_open_plane_is_one_click_away_and_level_of_detail_shows_each_level() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    first_visit(&browser, &daemon);
    browser.click("#view-plane");
    browser.until("document.activeElement.id === 'plane' && document.querySelector('#panel').matches('.folded')");
    assert!(browser.ready() > 500);
    browser.click("#tab-start");
    browser.click("#view-detail");
    browser.until("location.hash.includes('2.lod=0.0625')");
    browser.ready();
    // Each level is a sixteenth of the one before, and its dots are larger.
    let counts = browser.value("(() => { const n = [0, 0, 0]; strew.plane.each((layer) => (n[layer] += 1)); return n; })()");
    let count = |i: usize| counts[i].as_f64().expect("a number");
    assert!((count(0) / count(1) / 16.0 - 1.0).abs() < 0.2, "{counts}");
    assert!((count(1) / count(2) / 16.0 - 1.0).abs() < 0.4, "{counts}");
    assert_eq!(
        browser.value("strew.plane.sheets.front.sizes.every((size, i, all) => i === 0 || size > 1.5 * all[i - 1])"),
        true
    );
}
