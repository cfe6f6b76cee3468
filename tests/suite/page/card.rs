//! The card of a point: away from the point and its neighbors, announced, and closed by Escape.

use crate::support::browser::{Browser, looking};

/// How many of the point and its neighbors the card covers, and whether it covers the point itself.
const COVERED: &str = "(() => { const card = strew.card; const b = card.element; \
    const isOver = ([x, y]) => x > b.offsetLeft && x < b.offsetLeft + b.offsetWidth \
        && y > b.offsetTop && y < b.offsetTop + b.offsetHeight; \
    const whole = (v) => ({ i: Math.floor(v), f: v - Math.floor(v) }); \
    const near = card.found.near.map(({ x, y }) => card.onCanvas(whole(x), whole(y))); \
    const own = card.onCanvas(card.point.x, card.point.y); \
    return [[own, ...near].filter(isOver).length, isOver(own)]; })()";

fn pinned(browser: &Browser) -> String {
    let id = browser.until("strew.card.isPinned && !document.querySelector('#card').hidden && document.querySelector('#card h2')?.textContent");
    id.as_str().expect("an id").into()
}

#[test]
fn the_card_leaves_its_point_free_and_escape_closes_it() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=20");
    for at in [[816, 400], [400, 60], [1240, 640], [420, 780]] {
        browser.tap(at);
        let id = pinned(&browser);
        let covered = browser.value(COVERED);
        assert_eq!(covered[0], 0, "{at:?}");
        browser.until(&format!(
            "document.querySelector('#said').textContent.includes('Point {id} at')"
        ));
        browser.keys(&["\u{E00C}"]);
        browser.until("document.querySelector('#card').hidden");
    }
    // Keys alone can do it; the page reports where no point is near.
    browser.value("(document.querySelector('#plane').focus(), 0)");
    browser.keys(&["\u{E007}"]);
    pinned(&browser);
    browser.keys(&["\u{E00C}"]);
    browser
        .until("document.querySelector('#card').hidden && document.activeElement.id === 'plane'");
    browser.look(&daemon, "#at=0.45,0.55&span=0.6");
    browser.value("(document.querySelector('#plane').focus(), 0)");
    browser.keys(&["\u{E007}"]);
    // The nearest point is 0.31 away, five times as far as a key may miss by.
    browser.until("document.querySelector('#said').textContent === 'No point is near here.'");
    assert_eq!(browser.value("strew.card.isPinned"), false);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn on_a_phone_the_card_leaves_the_point_free() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=20");
    for at in [[195, 210], [60, 380], [340, 130]] {
        browser.tap(at);
        pinned(&browser);
        assert_eq!(browser.value(COVERED)[1], false, "{at:?}");
        browser.keys(&["\u{E00C}"]);
        browser.until("document.querySelector('#card').hidden");
    }
}
