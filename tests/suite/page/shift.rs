//! Nothing that is read moves away while a page loads: the layout of every page shifts by 0.05 at most, as Chromium
//! counts it.

use serde_json::Value;

use crate::support::browser::looking;

/// The last two for `/` alone: a phone on its side, and a window at 400 %.
const SIZES: [(u32, u32); 4] = [(390, 844), (1280, 800), (844, 390), (320, 568)];
const MOST: f64 = 0.05;

/// Other contents of pages, by the hashes of their addresses.
const MORE: [&str; 3] = [
    "/#tab=gallery",
    "/#at=0,0&span=30&layers=2&2.amount=3",
    "/docs#getNearest",
];

/// The elements that each page shows last: its points, then its pictures or its times.
const READY: &str = "(({ state, start, measured, gallery }) => location.pathname !== '/' ? state === 'ready' || measured \
                     : location.hash.includes('tab=gallery') ? gallery \
                     : state === 'ready' && (location.hash || start === 'ready'))\
                     (document.documentElement.dataset)";

/// The layout shift since the page was opened, with the elements that moved.
const SHIFTS: &str = "new Promise((resolve) => { \
    const name = ({ node }) => node?.id ? `#${node.id}` : node?.className || node?.nodeName || 'something'; \
    const found = []; \
    const take = (list) => found.push(...list.filter((one) => !one.hadRecentInput) \
        .map((one) => [one.value, one.sources.map(name).join(' ')])); \
    const observer = new PerformanceObserver((list) => take(list.getEntries())); \
    observer.observe({ type: 'layout-shift', buffered: true }); \
    requestAnimationFrame(() => requestAnimationFrame(() => { take(observer.takeRecords()); resolve(found); })); })";

#[test]
fn no_page_shifts_while_it_loads() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    let counts = "PerformanceObserver.supportedEntryTypes.includes('layout-shift')";
    if browser.value(counts) == false {
        return eprintln!("skipped: only Chromium counts layout shifts");
    }
    let api = daemon.get("/openapi.json").json();
    let is_page = |what: &Value| {
        what["get"]["responses"]["200"]["content"]["text/html; charset=utf-8"].is_object()
    };
    let paths = api["paths"].as_object().expect("paths");
    let pages = paths.iter().filter(|(_, what)| is_page(what));
    let pages: Vec<&str> = pages.map(|(path, _)| path.as_str()).chain(MORE).collect();
    assert!(pages.len() > 7, "{pages:?}");
    let mut failed = vec![];
    for (number, (width, height)) in SIZES.into_iter().enumerate() {
        let is_start = |path: &&&str| **path == "/" || path.starts_with("/#at");
        for path in pages.iter().filter(|path| number < 2 || is_start(path)) {
            browser.go("about:blank");
            browser.resize(width, height);
            browser.go(&daemon.url(path));
            browser.until(READY);
            let shifts = browser.value(SHIFTS);
            let shifts = shifts.as_array().expect("a list");
            let sum: f64 = shifts.iter().filter_map(|one| one[0].as_f64()).sum();
            println!("{path} at {width} × {height}: {sum:.3}");
            if sum > MOST {
                failed.push(format!(
                    "{path} at {width} × {height}: {sum:.3}, {shifts:?}"
                ));
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
