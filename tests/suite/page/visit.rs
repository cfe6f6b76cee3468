//! The path of a first visit: pick the forest, change the density, paint a road, take away a curl line;
//! with keys alone, and with a finger alone.

use super::{
    export::{assert_same, rows, run},
    paint::changed,
    start::first_visit,
};
use crate::support::browser::{
    Browser,
    key::{ENTER, ESCAPE, LEFT, PAGE_DOWN, RIGHT},
    looking,
};

/// Fails unless the last stroke is a road, free of the points that are in view.
fn assert_road(browser: &Browser) {
    let inside = "(() => { const { kind, size, line } = strew.paint.work.strokes.at(-1); \
        const [[ax, ay], [bx, by]] = [line[0], line.at(-1)]; \
        const [mx, my] = [strew.plane.view.x, strew.plane.view.y].map(({ i, f }) => i + f); let found = 0; \
        strew.plane.each((layer, u, v) => { const [x, y] = [u + mx - ax, v + my - ay]; \
            const [dx, dy] = [bx - ax, by - ay]; \
            const t = Math.max(0, Math.min(1, (x * dx + y * dy) / (dx * dx + dy * dy))); \
            if (layer === 0 && Math.hypot(x - t * dx, y - t * dy) < size / 2) found += 1; }); \
        return kind === 'road' ? found : kind; })()";
    assert_eq!(browser.value(inside), 0);
}

/// Fails unless the line in the clipboard is that of the page and returns the points in view.
fn assert_taken(browser: &Browser) {
    browser.until("document.querySelector('#copy').textContent === 'Copied'");
    let line = browser.text("#command");
    assert_eq!(
        browser.value("navigator.clipboard.readText()"),
        line.as_str()
    );
    assert!(
        line.starts_with("curl -f ") && line.contains("clear_of"),
        "{line}"
    );
    run(&line, "curl", |text| assert_same(browser, &rows(text)));
}

#[test]
fn a_first_visit_with_keys_alone() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    first_visit(&browser, &daemon);
    browser.allow_clipboard();
    // Take is the last tab, so it is to the left of the first.
    browser.tab_to("tab-start");
    browser.keys(&[LEFT]);
    browser.until("document.documentElement.dataset.weighed");
    browser.keys(&[RIGHT]);
    browser.tab_to("view-forest");
    browser.keys(&[ENTER]);
    browser.until("location.hash.includes('field=forest')");
    let before = browser.ready();
    // Fewer doublings of the spacing: more trees.
    browser.tab_to("amount-slider");
    let more = changed(&browser, || browser.keys(&[PAGE_DOWN]));
    assert!(more > before * 3 / 2, "{more} after {before}");
    browser.tab_back_to("paint-open");
    browser.keys(&[ENTER]);
    browser.until("document.activeElement.id === 'brush'");
    browser.tab_to("paint-tool-road");
    browser.keys(&[ENTER]);
    browser.until("document.activeElement.id === 'brush'");
    changed(&browser, || {
        browser.keys(&[
            " ", RIGHT, RIGHT, RIGHT, RIGHT, RIGHT, RIGHT, RIGHT, RIGHT, " ",
        ]);
    });
    assert_road(&browser);
    browser.keys(&[ESCAPE]);
    browser.until("document.activeElement.id === 'paint-open'");
    browser.tab_to("tab-choose");
    browser.keys(&[RIGHT]);
    browser.until("document.documentElement.dataset.weighed");
    browser.tab_to("copy");
    browser.keys(&[ENTER]);
    assert_taken(&browser);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_first_visit_with_a_finger() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    browser.use_touch();
    first_visit(&browser, &daemon);
    browser.allow_clipboard();
    browser.touch("#view-forest");
    browser.until("location.hash.includes('field=forest')");
    let before = browser.ready();
    let slider = browser.middle("#amount-slider");
    let more = changed(&browser, || browser.swipe(slider, [-60, 0]));
    assert!(more > before, "{more} after {before}");
    browser.touch("#paint-open");
    browser.touch("#paint-tool-road");
    let [x, y] = browser.middle("#brush");
    changed(&browser, || browser.swipe([x - 120, y - 150], [240, 60]));
    assert_road(&browser);
    browser.touch("#paint-done");
    browser.touch("#tab-take");
    browser.until("document.documentElement.dataset.weighed");
    browser.touch("#copy");
    assert_taken(&browser);
    assert_eq!(browser.errors(), Vec::<String>::new());
}
