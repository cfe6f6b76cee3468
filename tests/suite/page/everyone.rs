//! What everybody needs of the page: contrast, names, and pictures that come at once.

use crate::support::browser::looking;

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
fn the_gallery_shows_points_before_it_has_measured_them() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30&tab=gallery");
    browser.until("strew.gallery.cards.some((card) => card.draw && !card.measured)");
    browser.until("document.documentElement.dataset.gallery");
    assert_eq!(
        browser.value("document.querySelectorAll('#gallery .awaited').length"),
        0
    );
}
