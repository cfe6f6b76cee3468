//! The API as a page: it shows, finds, links and tries operations.

use crate::support::{
    browser::{Browser, looking},
    daemon::Daemon,
};

fn open(daemon: &Daemon, browser: &Browser, hash: &str) {
    browser.go("about:blank");
    browser.go(&daemon.url(&format!("/docs{hash}")));
    browser.until("document.documentElement.dataset.state === 'ready'");
}

#[test]
fn an_operation_has_an_address_is_found_and_can_be_tried() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    open(&daemon, &browser, "");
    assert_eq!(
        browser.text("#side h2"),
        "points",
        "points come before all else"
    );
    // A search also looks at parameters, and names them.
    browser.choose("#search", "heights");
    let hits = browser.text("#hits");
    assert!(hits.ends_with("operations"), "{hits}");
    let hit = browser.text("[data-id=getPoints] .hit");
    assert!(hit.contains("heights"), "{hit}");
    assert_eq!(
        browser.value("document.querySelector('[data-id=getMetrics]').hidden"),
        true
    );
    browser.click("[data-id=getPoints] a");
    browser.until("location.hash === '#getPoints' && document.querySelector('form.try')");
    // The form begins with the example, and the line for curl follows it.
    browser.choose("#try-query-bbox", "0,0,5,4");
    let line = browser.text("form.try code");
    assert!(line.contains("/v1/points?bbox=0,0,5,4&"), "{line}");
    browser.click("form.try button[type=submit]");
    browser.until("document.querySelector('#status')?.textContent.startsWith('200')");
    assert!(browser.text("#body").starts_with("id,x,y"));
    assert!(browser.text("#answer").contains("strew-count"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn references_unfold_and_answers_have_examples() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    open(&daemon, &browser, "#queryPoints");
    let body = browser.text("main");
    assert!(!body.contains("$ref"), "references are followed");
    // A field may contain fields, as deep as one likes to look.
    let unfold = "(async () => { let at = document.querySelector('main'); \
        for (const name of ['field', 'multiply']) { \
            for (let i = 0; i < 4; i += 1) { \
                for (const one of at.querySelectorAll('details:not([open])')) one.open = true; \
                await new Promise(requestAnimationFrame); } \
            at = [...at.querySelectorAll('li')].find((li) => \
                li.querySelector('.name')?.textContent === name); \
            if (!at) return name; } \
        return at.textContent; })()";
    let found = browser.value(&format!("await {unfold}"));
    let found = found.as_str().expect("text");
    assert!(found.starts_with("multiply") && found.len() > 20, "{found}");
    open(&daemon, &browser, "#getCount");
    browser.value(
        "(document.querySelectorAll('main details').forEach((one) => { one.open = true; }), 0)",
    );
    browser.until("[...document.querySelectorAll('main pre')].some((pre) => pre.textContent.includes('\"count\":'))");
    // Each operation can be shown.
    let all = "[...document.querySelectorAll('#operations a')].map((a) => a.hash)";
    let empty = browser.value(&format!(
        "await (async () => {{ const empty = []; for (const hash of {all}) {{ location.hash = hash; \
         await new Promise((done) => setTimeout(done)); \
         if (!document.querySelector('form.try')) empty.push(hash); }} return empty; }})()"
    ));
    assert_eq!(empty, serde_json::json!([]));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_search_without_a_hit_says_so_and_offers_the_way_back() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    open(&daemon, &browser, "");
    browser.choose("#search", "stipple");
    assert_eq!(browser.text("#hits"), "No operation found");
    let main = browser.text("#main");
    assert!(main.contains("“stipple” is in no operation"), "{main}");
    assert!(!main.contains("Choose an operation"), "{main}");
    browser.click("#clear");
    assert_eq!(browser.text("#main h2"), "The API");
    assert_eq!(browser.value("document.activeElement.id"), "search");
    // An operation that is open stays.
    open(&daemon, &browser, "#getCount");
    browser.choose("#search", "stipple");
    assert!(
        browser
            .value("document.querySelector('form.try')")
            .is_object()
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn rules_between_parameters_are_a_table() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    open(&daemon, &browser, "#getNearest");
    browser.value(
        "(document.querySelectorAll('#main details').forEach((one) => { one.open = true; }), 0)",
    );
    let row = |name: &str| {
        let rows = "[...document.querySelectorAll('.rules tbody tr')]";
        let row = format!(
            "{rows}.find((row) => row.cells[0].textContent === '{name}')?.cells[1].innerText"
        );
        let text = browser.until(&row);
        text.as_str().expect("text").to_owned()
    };
    assert_eq!(row("heights"), "only with terrain");
    assert_eq!(row("spacing"), "exactly one: this, density or min_distance");
    assert_eq!(
        row("scale_range"),
        "only with attributes (scale)\nnot with scale_ranges"
    );
    assert_eq!(row("spread"), "even needs variants\njoint needs variants");
}

#[test]
fn a_server_that_is_away_is_said() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    open(&daemon, &browser, "#getCount");
    browser.value("(window.fetch = () => Promise.reject(new TypeError('away')), 0)");
    browser.click("form.try button[type=submit]");
    browser.until("!document.querySelector('#banner').hidden");
    assert!(
        browser
            .text("#banner")
            .starts_with("The server does not answer.")
    );
    assert!(browser.text("#answer").starts_with("No answer came."));
}
