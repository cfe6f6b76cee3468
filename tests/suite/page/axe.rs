//! axe-core finds nothing on any page, at three sizes, in light and dark. Skipped where NODE_PATH does not lead to it.

use serde_json::json;

use super::start::first_visit;
use crate::support::browser::{Browser, looking};

const SIZES: [(u32, u32); 3] = [(1440, 900), (1024, 700), (390, 844)];

const READY: &str = "document.documentElement.dataset.state === 'ready'";

fn axe() -> Option<String> {
    let path = std::env::var("NODE_PATH").unwrap_or_default();
    let axe = std::fs::read_to_string(format!("{path}/axe-core/axe.min.js")).ok();
    if axe.is_none() {
        eprintln!("skipped: axe-core is not installed");
    }
    axe
}

/// Adds axe to the page that is open.
fn add(browser: &Browser, axe: &str) {
    browser.value(&format!("(new Function({}).call(window), 0)", json!(axe)));
}

fn assert_clean(browser: &Browser, what: &str) {
    let found = browser.value(
        "axe.run().then(({ violations }) => violations.map((v) => \
         `${v.id}: ${v.nodes.map((n) => `${n.html} ${n.failureSummary}`).join(' ')}`))",
    );
    assert_eq!(found, json!([]), "{what}");
}

/// Checks the open page in both themes.
fn assert_clean_in_both(browser: &Browser, what: &str) {
    for theme in ["light", "dark"] {
        browser.value(&format!(
            "(document.documentElement.dataset.theme = '{theme}', 0)"
        ));
        assert_clean(browser, &format!("{what}, {theme}"));
    }
}

#[test]
fn axe_finds_nothing_in_the_tabs() {
    let Some(axe) = axe() else { return };
    let Some((daemon, browser)) = looking(1440, 900) else {
        return;
    };
    first_visit(&browser, &daemon);
    add(&browser, &axe);
    let tabs = ["start", "choose", "take"];
    for (i, (width, height)) in SIZES.into_iter().enumerate() {
        browser.resize(width, height);
        // One size of the gallery, which measures for long, is enough.
        let theme = ["light", "dark", "light"][i];
        browser.value(&format!(
            "(document.documentElement.dataset.theme = '{theme}', 0)"
        ));
        for tab in tabs {
            browser.click(&format!("#tab-{tab}"));
            browser.until(&format!("!document.querySelector('#{tab}').hidden"));
            assert_clean(&browser, &format!("{tab} at {width} × {height}"));
        }
        browser.click("#tab-choose");
        browser.click("#understand summary");
        browser.until("document.documentElement.dataset.measured");
        assert_clean(&browser, &format!("measures at {width} × {height}"));
        if i == 0 {
            browser.click("#open-gallery");
            browser.until("document.documentElement.dataset.gallery");
            assert_clean(&browser, "the gallery");
            browser.click("#close-gallery");
        }
    }
    browser.click("#paint-open");
    assert_clean_in_both(&browser, "painting");
    browser.click("#paint-done");
    browser.click("#tab-choose");
    browser.choose("#spread", "joint");
    browser.until("strew.plane.look.layers[0].spread === 'joint'");
    assert_clean_in_both(&browser, "kinds");
    browser.go("about:blank");
    browser.go(&daemon.url("/#at=0,0&span=30&alpha=3"));
    browser.until("!document.querySelector('#banner').hidden");
    add(&browser, &axe);
    assert_clean_in_both(&browser, "a link that is refused");
}

#[test]
fn axe_finds_nothing_on_the_other_pages() {
    let Some(axe) = axe() else { return };
    let Some((daemon, browser)) = looking(1440, 900) else {
        return;
    };
    for (path, ready) in [
        ("/compare", "document.documentElement.dataset.measured"),
        ("/how", READY),
        ("/walk#fly=0&quality=0", READY),
        ("/space#at=4,4,4", READY),
        ("/docs", READY),
        ("/docs#getCount", READY),
    ] {
        browser.go("about:blank");
        browser.go(&daemon.url(path));
        browser.until(ready);
        add(&browser, &axe);
        for (width, height) in SIZES {
            browser.resize(width, height);
            assert_clean_in_both(&browser, &format!("{path} at {width} × {height}"));
        }
    }
}
