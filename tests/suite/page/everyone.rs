//! Accessibility of the pages: contrast, pictures that come at once, links that skip parts, and no motion of its own.

use crate::support::browser::{
    key::{ENTER, TAB},
    looking,
};

/// The least contrast of pairs of colors of the theme: of edges and dots with their grounds, and of text with its.
const CONTRAST: &str = "(() => { \
    const probe = document.createElement('i'); document.body.append(probe); \
    const rgb = (css) => { probe.style.color = css; return getComputedStyle(probe).color.match(/[\\d.]+/g).slice(0, 3).map(Number); }; \
    const light = (css) => rgb(css).map((v) => v / 255).map((v) => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4) \
        .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0); \
    const ratio = (a, b) => { const [x, y] = [light(a), light(b)].sort((p, q) => q - p); return (x + 0.05) / (y + 0.05); }; \
    const dots = [...document.querySelectorAll('.swatches i')].map((e) => getComputedStyle(e).backgroundColor); \
    const grounds = ['var(--ground)', 'var(--raised)']; \
    const all = (front) => Math.min(...grounds.flatMap((g) => front.map((f) => ratio(f, g)))); \
    const found = [all([...dots, 'var(--edge)', 'var(--accent)']), \
        Math.min(all(['var(--ink)', 'var(--soft)', 'var(--bad)']), ratio('var(--soft)', 'var(--sunken)'), ratio('var(--on-accent)', 'var(--accent)'))]; \
    probe.remove(); return found; })()";

#[test]
fn edges_and_dots_stand_out_and_text_is_legible() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    for theme in ["light", "dark"] {
        browser.look(&daemon, "#at=0,0&span=30");
        browser.value(&format!(
            "(document.documentElement.dataset.theme = '{theme}', 0)"
        ));
        let found = browser.value(CONTRAST);
        let number = |i: usize| found[i].as_f64().expect("a number");
        assert!(number(0) >= 3.0, "{theme}: {found}");
        assert!(number(1) >= 4.5, "{theme}: {found}");
    }
}

#[test]
fn no_page_is_wider_than_its_window() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    for (width, height) in [(390, 844), (320, 568)] {
        browser.resize(width, height);
        for path in ["/", "/how", "/compare", "/walk", "/space", "/docs"] {
            browser.go(&daemon.url(path));
            browser.until(
                "document.querySelector('button, a, canvas') && document.readyState === 'complete'",
            );
            let wide = browser.value("document.documentElement.scrollWidth - innerWidth");
            assert!(
                wide.as_i64() <= Some(0),
                "{path} at {width} × {height}: {wide}"
            );
        }
    }
}

#[test]
fn the_gallery_shows_points_before_it_has_measured_them() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30&tab=gallery");
    let is_drawn = "({ points }) => points.getContext('2d') \
        .getImageData(0, 0, points.width, points.height).data.some(Boolean)";
    browser.until(&format!(
        "strew.gallery.cards.filter((card) => !card.measured).some({is_drawn})"
    ));
    browser.until("document.documentElement.dataset.gallery");
    assert_eq!(
        browser.value("document.querySelectorAll('#gallery .awaited').length"),
        0
    );
}

#[test]
fn the_first_key_leads_past_what_repeats() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    for (path, target) in [
        ("/#tab=start", "panel-body"),
        ("/how", "essay"),
        ("/compare", "methods"),
        ("/space#at=4,4,4", "choices"),
        ("/docs#getPoints", "main"),
    ] {
        browser.go("about:blank");
        browser.go(&daemon.url(path));
        browser.until("document.querySelector('h1, h2')");
        browser.until("document.documentElement.dataset.state === 'ready' && (location.pathname !== '/' || location.hash.includes('at=')) || document.querySelector('article canvas')");
        let hash = browser.hash();
        browser.keys(&[TAB]);
        assert_eq!(
            browser.value("document.activeElement.className"),
            "skip",
            "{path}"
        );
        let top = browser.value("document.activeElement.getBoundingClientRect().top");
        assert!(
            top.as_f64().expect("pixels") >= 0.0,
            "it is seen on {path}: {top}"
        );
        browser.keys(&[ENTER]);
        assert_eq!(browser.value("document.activeElement.id"), target, "{path}");
        if !hash.is_empty() {
            assert_eq!(browser.hash(), hash, "the address stays");
        }
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn what_lies_under_another_tab_takes_no_focus() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30&tab=gallery");
    let covered = "['plane', 'jump-at', 'theme', 'gallery'] \
        .map((id) => Boolean(document.getElementById(id).closest('[inert]')))";
    assert_eq!(
        browser.value(covered),
        serde_json::json!([true, true, true, false])
    );
    browser.click("#tab-choose");
    assert_eq!(
        browser.value(covered),
        serde_json::json!([false, false, false, false])
    );
}

#[test]
fn nothing_moves_by_itself_where_less_motion_is_wanted() {
    let Some((daemon, browser)) = looking(640, 420) else {
        return;
    };
    let walk = |hash: &str| {
        browser.go("about:blank");
        browser.go(&daemon.url(&format!("/walk#quality=0{hash}")));
        browser.until("document.documentElement.dataset.state === 'ready'");
    };
    walk("");
    assert_eq!(browser.value("strew.walker.isFlying"), true);
    let fold = "(document.querySelector('#fold').click(), document.getAnimations().length)";
    browser.look(&daemon, "#at=0,0&span=30");
    assert_eq!(browser.value(fold), 1);
    browser.reduce_motion();
    browser.look(&daemon, "#at=0,0&span=30");
    assert_eq!(browser.value(fold), 0);
    walk("");
    let state = "[strew.walker.isFlying, strew.look.time]";
    assert_eq!(browser.value(state), serde_json::json!([false, 0]));
    // The button flies all the same.
    browser.click("#fly");
    browser.until("strew.walker.isFlying && document.querySelector('#fly').textContent === 'Land'");
    assert_eq!(browser.errors(), Vec::<String>::new());
}
