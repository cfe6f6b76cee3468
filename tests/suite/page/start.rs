//! The first screen: what it shows, and the path of a first visit: understand, pick the forest, change the density,
//! take away a curl line; with keys alone, and with a finger.

use serde_json::json;

use crate::support::{
    browser::{Browser, looking},
    clients,
    daemon::Daemon,
};

const TAB: &str = "\u{E004}";
const ENTER: &str = "\u{E007}";
const RIGHT: &str = "\u{E014}";

/// Opens the page without a link, and waits for its pictures.
fn first_visit(browser: &Browser, daemon: &Daemon) {
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
    let names = json!({ "permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"] });
    browser.cdp("Browser.grantPermissions", &names);
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

/// Presses Tab until an element has the focus.
fn tab_to(browser: &Browser, id: &str) {
    for _ in 0..60 {
        if browser.value("document.activeElement.id") == id {
            return;
        }
        browser.keys(&[TAB]);
    }
    panic!("no way by Tab to {id}");
}

#[test]
fn a_first_visit_with_keys_alone() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    first_visit(&browser, &daemon);
    tab_to(&browser, "view-forest");
    browser.keys(&[ENTER]);
    browser.until("location.hash.includes('field=forest')");
    let before = browser.ready();
    tab_to(&browser, "amount-slider");
    // Fewer doublings of the spacing: more trees.
    let identity = browser.value("strew.plane.chunks.identity");
    browser.keys(&["\u{E011}"]);
    browser.until(&format!("strew.plane.chunks.identity !== {identity}"));
    assert!(browser.ready() > 2 * before);
    browser.value("(document.querySelector('#tab-choose').focus(), 0)");
    browser.keys(&[RIGHT, RIGHT]);
    browser.until("document.documentElement.dataset.weighed");
    tab_to(&browser, "copy");
    let line = browser.text("#command");
    assert!(
        line.starts_with("curl -f ") && line.contains("forest") && line.contains("clear_of"),
        "{line}"
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}

/// Taps the middle of an element with a finger.
fn tap(browser: &Browser, id: &str) {
    let script = format!(
        "(() => {{ const e = document.querySelector('#{id}'); e.scrollIntoView({{ block: 'center' }}); \
         const b = e.getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2].map(Math.round); }})()"
    );
    let at = browser.value(&script);
    let at = json!([{ "x": at[0], "y": at[1] }]);
    let touch = |kind: &str, at: &serde_json::Value| {
        let touch = json!({ "type": kind, "touchPoints": at });
        browser.cdp("Input.dispatchTouchEvent", &touch);
    };
    touch("touchStart", &at);
    touch("touchEnd", &json!([]));
}

#[test]
fn a_first_visit_with_a_finger() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    browser.cdp(
        "Emulation.setTouchEmulationEnabled",
        &json!({ "enabled": true }),
    );
    first_visit(&browser, &daemon);
    tap(&browser, "view-forest");
    browser.until("location.hash.includes('field=forest')");
    browser.ready();
    let identity = browser.value("strew.plane.chunks.identity");
    tap(&browser, "another-seed");
    browser.until(&format!("strew.plane.chunks.identity !== {identity}"));
    browser.ready();
    tap(&browser, "tab-take");
    browser.until("document.documentElement.dataset.weighed");
    assert!(browser.text("#command").starts_with("curl -f "));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

/// axe-core finds nothing at three sizes. Skipped where NODE_PATH does not lead to it.
#[test]
fn axe_finds_nothing_to_complain_about() {
    let path = std::env::var("NODE_PATH").unwrap_or_default();
    let Ok(axe) = std::fs::read_to_string(format!("{path}/axe-core/axe.min.js")) else {
        eprintln!("skipped: axe-core is not installed");
        return;
    };
    if clients::find("chromedriver").is_none() {
        return;
    }
    for (width, height, theme) in [
        (1440, 900, "light"),
        (1024, 700, "dark"),
        (390, 844, "light"),
    ] {
        let Some((daemon, browser)) = looking(width, height) else {
            return;
        };
        first_visit(&browser, &daemon);
        browser.value(&format!(
            "(document.documentElement.dataset.theme = '{theme}', 0)"
        ));
        browser.value(&format!("(new Function({}).call(window), 0)", json!(axe)));
        // The gallery measures in the meantime, so one size of it is enough.
        let tabs = ["start", "choose", "take", "understand", "gallery"];
        for tab in &tabs[..if width == 1440 { 5 } else { 4 }] {
            browser.click(&format!("#tab-{tab}"));
            browser.until(&format!("!document.querySelector('#{tab}').hidden"));
            let found = browser.value(
                "axe.run().then(({ violations }) => violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.html).join(' ')}`))",
            );
            assert_eq!(found, json!([]), "{tab} at {width} × {height}");
        }
    }
}
