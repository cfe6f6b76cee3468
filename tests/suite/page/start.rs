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
    assert_eq!(drawn, 5);
    let before = browser.value("strew.start.trio[2].points[0]");
    browser.click("#kinds-again");
    browser.until(&format!("strew.start.trio[2].points[0] !== {before}"));
    browser.allow_clipboard();
    browser.click("#share");
    browser.until("document.querySelector('#said').textContent === 'The link is copied.'");
    let same = "navigator.clipboard.readText().then((text) => text === location.href && text.includes('#at='))";
    assert_eq!(browser.value(same), true);
    for (view, part) in [("portrait", "field=portrait"), ("detail", "span=1600")] {
        browser.click("#tab-start");
        browser.click(&format!("#view-{view}"));
        browser.until(&format!("location.hash.includes('{part}')"));
        assert!(browser.ready() > 10_000, "{view}");
    }
    // The tile has a page of its own.
    let tile = browser.value("document.querySelector('#view-tile').getAttribute('href')");
    assert_eq!(tile, "/tile");
    assert_eq!(browser.errors(), Vec::<String>::new());
}
