//! Nothing moves under the reader while a page loads: the layout shift of the pages beside `/`, at two sizes.

use crate::support::browser::{Browser, looking};

const READY: &str = "document.documentElement.dataset.state === 'ready'";

/// The sum of the shifts that no input caused, as browsers measure them; `null` where they do not.
const SHIFT: &str = "await new Promise((done) => { \
    if (!PerformanceObserver.supportedEntryTypes.includes('layout-shift')) return done(null); \
    let sum = 0; \
    new PerformanceObserver((list) => { \
      for (const entry of list.getEntries()) sum += entry.hadRecentInput ? 0 : entry.value; \
    }).observe({ type: 'layout-shift', buffered: true }); \
    requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(() => done(sum)))); })";

fn assert_steady(browser: &Browser, what: &str) {
    let shift = browser.value(SHIFT);
    let Some(shift) = shift.as_f64() else {
        eprintln!("skipped: this browser does not measure layout shifts");
        return;
    };
    assert!(shift <= 0.05, "{what} moves by {shift}");
}

#[test]
fn pages_stay_where_they_are_while_they_load() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    for (width, height) in [(1280, 800), (390, 844)] {
        browser.resize(width, height);
        for (path, ready) in [
            ("/compare", "document.documentElement.dataset.timed"),
            (
                "/compare#show=strew,poisson,tile,jitter,halton,white",
                "document.documentElement.dataset.timed",
            ),
            (
                "/walk#quality=0",
                "globalThis.strew?.look?.things.length > 0",
            ),
            ("/tile", READY),
            ("/space#at=4,4,4", READY),
            ("/docs", READY),
            ("/docs#getNearest", READY),
        ] {
            browser.go("about:blank");
            browser.go(&daemon.url(path));
            browser.until(ready);
            assert_steady(&browser, &format!("{path} at {width} × {height}"));
        }
    }
}
