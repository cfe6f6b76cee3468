//! The controls of the page: each changes the query, appears in the URL, and is restored from it.

use crate::support::browser::{Browser, looking};

/// Chooses a value and waits for other points. Returns the hash.
fn chosen(browser: &Browser, selector: &str, value: &str) -> String {
    let before = browser.value("strew.plane.chunks.identity");
    browser.choose(selector, value);
    let changed = format!("strew.plane.chunks.identity !== {before}");
    browser.until(&changed);
    browser.ready();
    browser.hash()
}

#[test]
fn every_control_changes_the_points_and_the_url() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(&daemon, "");
    browser.click("#tab-choose");
    for (selector, value, part) in [
        ("#profile", "spaced", "profile=spaced"),
        ("#map", "m", "map=m"),
        ("#alpha", "sqrt(3)", "alpha=sqrt(3)"),
        ("#amount", "0.5", "amount=0.5"),
        ("#by", "density", "by=density"),
        ("#by", "min_distance", "by=min_distance"),
        ("#seed", "18446744073709551615", "seed=18446744073709551615"),
        ("#warp", "off", "warp=off"),
        ("#warp", "2", "warp=2"),
        ("#settle", "1", "settle=1"),
    ] {
        let hash = chosen(&browser, selector, value);
        assert!(hash.contains(part), "{selector} {value}: {hash}");
    }
    for (box_, part) in [
        ("#angle", "angle=1"),
        ("#scale", "scale=1"),
        ("#variant", "variant=1"),
    ] {
        let before = browser.value("strew.plane.chunks.identity");
        browser.click(box_);
        browser.until(&format!("strew.plane.chunks.identity !== {before}"));
        browser.ready();
        assert!(browser.hash().contains(part), "{box_}");
    }
    assert!(chosen(&browser, "#range", "0.2,0.9").contains("range=0.2,0.9"));
    assert!(chosen(&browser, "#variants", "fir:1,elm:2").contains("variants=fir:1,elm:2"));
    // The appearance changes no points.
    let identity = browser.value("strew.plane.chunks.identity");
    browser.click("#color-3");
    browser.until("location.hash.includes('color=3')");
    browser.choose("#dot", "2.5");
    browser.until("location.hash.includes('dot=2.5')");
    assert_eq!(browser.value("strew.plane.chunks.identity"), identity);
    // Layers that keep clear of each other.
    let alone = browser.ready();
    browser.click("#add-layer");
    browser.until("location.hash.includes('layers=2')");
    let more = format!("Number(document.documentElement.dataset.count) > {alone}");
    browser.until(&format!(
        "document.documentElement.dataset.state === 'ready' && {more}"
    ));
    let both = browser.ready();
    chosen(&browser, "#clear", "0.3");
    assert!(browser.ready() < both);
    let (hash, count) = (browser.hash(), browser.ready());
    // The URL alone restores everything.
    browser.look(&daemon, &hash);
    assert_eq!((browser.hash(), browser.ready()), (hash, count));
    browser.click("#layer-1");
    browser.click("#remove-layer");
    browser.until("!location.hash.includes('layers=2')");
    browser.ready();
    browser.value("history.back()");
    browser.until("location.hash.includes('layers=2')");
    browser.until(&format!(
        "document.documentElement.dataset.count === '{count}'"
    ));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn everything_fits_on_a_phone() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=20");
    let inside = "document.documentElement.scrollWidth <= 390 && [...document.querySelectorAll('button, input, select')].filter((e) => e.offsetParent).every((e) => { const b = e.getBoundingClientRect(); return b.left >= 0 && b.right <= 390; })";
    for (opener, shown) in [
        ("#tab-start", "start"),
        ("#tab-take", "take"),
        ("#tab-choose", "choose"),
        ("#open-gallery", "gallery"),
        ("#tab-choose", "choose"),
        ("#understand summary", "understand"),
    ] {
        browser.click(opener);
        browser.until(&format!("!document.querySelector('#{shown}').hidden"));
        assert_eq!(browser.value(inside), true, "{shown}");
    }
    let small = browser.ready();
    browser.click("#fold");
    browser.until("document.querySelector('#panel').classList.contains('folded')");
    browser.until("strew.plane.view.height > 600");
    assert!(browser.ready() > 0 && small > 0);
    assert_eq!(browser.value(inside), true);
    // A tap with a finger.
    browser.tap([195, 300]);
    browser.until("!document.querySelector('#card').hidden && document.querySelector('#card h2')?.textContent");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn the_panel_measures_the_view_next_to_the_table() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=100&tab=understand");
    browser.until("document.documentElement.dataset.measured");
    let drawn = "(() => { const { measured: m, recorded, count, density } = strew.understand.drawn; \
        const low = m.radial.filter(([nu]) => nu < 0.4).map(([, p]) => p); \
        const high = m.radial.filter(([nu]) => nu > 2.5).map(([, p]) => p); \
        const mean = (list) => list.reduce((a, b) => a + b) / list.length; \
        return [count, density, m.figures.least, mean(low), mean(high), \
            recorded.measured.radial.values.length]; })()";
    let drawn = browser.value(drawn);
    let number = |i: usize| drawn[i].as_f64().expect("a number");
    assert_eq!(number(0) as u64, browser.ready());
    assert!((number(1) - 1.0).abs() < 0.01, "density {drawn}");
    // The table's own least distance is 0.716; the warp takes a few hundredths at most.
    assert!((0.64..0.73).contains(&number(2)), "least distance {drawn}");
    // Blue noise: next to no power at low frequencies, that of white noise at high ones.
    assert!(number(3) < 1e-3, "low power {drawn}");
    assert!((number(4) - 1.0).abs() < 0.15, "high power {drawn}");
    assert!(number(5) > 50.0);
    browser.look(&daemon, "#at=0,0&span=5&tab=understand");
    browser.until("document.documentElement.dataset.measured === 'too-few'");
    assert!(browser.text("#measured-note").contains("too few"));
}

#[test]
fn the_gallery_shows_every_profile_and_opens_one() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30&tab=gallery");
    assert_eq!(
        browser.until("document.documentElement.dataset.gallery"),
        "ready"
    );
    assert_eq!(
        browser.value("document.querySelectorAll('#gallery article').length"),
        9
    );
    browser.click("#open-pink");
    browser.until(
        "location.hash.includes('profile=pink') && document.querySelector('#gallery').hidden",
    );
    browser.ready();
    assert_eq!(browser.errors(), Vec::<String>::new());
}
