//! The first screen: what it shows, and what it leads to.

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
fn the_argument_is_shown_with_views_to_begin_with() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    first_visit(&browser, &daemon);
    // A square a billion away, beside what Poisson disk makes first.
    let far = browser.value("strew.start.argument.points.length / 2");
    assert!(
        (390..=410).contains(&far.as_u64().expect("a count")),
        "{far}"
    );
    assert_eq!(browser.text("#argument-first"), "4 × 10¹⁸ points");
    browser.choose("#argument-far", "3");
    assert_eq!(browser.text("#argument-first"), "4,161,600 points");
    let sizes =
        "[...document.querySelectorAll('.view img')].every((one) => one.naturalWidth >= 360)";
    browser.until(sizes);
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
    // The tile is something to take away.
    browser.click("#tab-start");
    browser.click("#view-tile");
    browser.until("location.hash.includes('take=tile') && document.documentElement.dataset.weighed === '5041'");
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

/// What a card shows of the view that is open, as JPEG: the plane and its spectrum, or copies of a tile.
const PICTURE: &str = "await (async () => { \
    const small = Object.assign(document.createElement('canvas'), { width: 360, height: 240 }); \
    const context = small.getContext('2d'); \
    context.imageSmoothingQuality = 'high'; \
    context.scale(0.75, 0.75); \
    const { state } = strew.session; \
    if (state.take) context.drawImage(document.querySelector('#repeat-picture'), 0, 0); \
    else context.drawImage(document.querySelector('#plane'), 0, 0); \
    if (state.tab === 'understand') context.drawImage(document.querySelector('#spectrum'), 160, 0, 320, 320); \
    const picture = await new Promise((done) => small.toBlob(done, 'image/jpeg', 0.5)); \
    return [...new Uint8Array(await picture.arrayBuffer())]; })()";

/// Writes the pictures of the cards: `just pictures`.
#[test]
fn pictures() {
    if std::env::var_os("STREW_TEST_PICTURES").is_none() {
        eprintln!("skipped: STREW_TEST_PICTURES writes the pictures of the cards");
        return;
    }
    let (daemon, browser) = looking(1280, 800).expect("a browser");
    browser.look(&daemon, "");
    let links =
        browser.value("[...document.querySelectorAll('.view')].map(({ id, hash }) => [id, hash])");
    for link in links.as_array().expect("a list") {
        let [id, hash] = [0, 1].map(|i| link[i].as_str().expect("text"));
        if hash.is_empty() {
            continue;
        }
        // Dots of the portrait would be finer than the pixels of its picture.
        let hash = hash.replace("amount=0.42", "amount=0.8");
        browser.look(&daemon, &hash);
        browser.value(
            "(Object.assign(document.querySelector('#stage').style, \
                { right: 'auto', bottom: 'auto', width: '480px', height: '320px' }), 0)",
        );
        browser.until(
            "strew.plane.view.width === 480 && document.documentElement.dataset.state === 'ready'",
        );
        browser.until("!location.hash.includes('tab=') || ['measured', 'weighed'].some((one) => document.documentElement.dataset[one])");
        let bytes: Vec<u8> = serde_json::from_value(browser.value(PICTURE)).expect("a picture");
        let name = id.trim_start_matches("view-");
        let path = format!("{}/page/files/start/{name}.jpg", env!("CARGO_MANIFEST_DIR"));
        std::fs::write(path, bytes).expect("a file");
    }
}
