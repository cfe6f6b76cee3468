//! The page of a tile at `/tile`: its copies continue one another, and what it offers to save is what it shows.

use crate::support::browser::{Browser, looking};

const READY: &str = "document.documentElement.dataset.state === 'ready'";

/// A sum of the canvas's colors, once it shows a place.
fn picture(browser: &Browser, x: i64) -> i64 {
    let sum = browser.value(&format!(
        "await new Promise((done) => {{ \
           strew.kinds.points.renew(); \
           strew.joint.lookAt({{ i: {x}, f: 0.25 }}, {{ i: -{x}, f: 0.5 }}); \
           requestAnimationFrame(() => requestAnimationFrame(() => {{ \
             const canvas = document.querySelector('#view'); \
             const {{ data }} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height); \
             done(data.reduce((sum, v) => (31 * sum + v) % 1e9, 7)); }})); }})"
    ));
    sum.as_i64().expect("a number")
}

#[test]
fn a_tile_repeats_and_is_saved_as_it_is_shown() {
    let Some((daemon, browser)) = looking(1100, 800) else {
        return;
    };
    browser.go(&daemon.url("/tile"));
    browser.until(READY);
    assert!(
        browser
            .text("#about")
            .starts_with("5,041 points on a square of 71 × 71")
    );
    let is_whole = "(({ scrollHeight, clientHeight }) => scrollHeight <= clientHeight)(document.querySelector('#about'))";
    assert_eq!(
        browser.value(is_whole),
        true,
        "no picture lies on its words"
    );
    // A period farther everything looks the same, half of one farther it does not.
    browser.click("#seams");
    let here = picture(&browser, 0);
    assert_eq!(picture(&browser, 71), here);
    assert_ne!(picture(&browser, 35), here);
    browser.click("#seams");
    picture(&browser, 0);
    // The line to paste returns the tile.
    let line = browser.text("#command");
    assert!(
        line.contains("periodic=5041") && line.contains("size=1024"),
        "{line}"
    );
    let path = line.split('\'').nth(1).expect("an address");
    let path = path.strip_prefix(&daemon.url("")).expect("of this daemon");
    let tile = daemon.get(path);
    assert_eq!(tile.header("content-type"), "image/png");
    assert_eq!(tile.header("strew-count"), "5041");
    // Fewer of the points, by the keyboard; the address holds it.
    browser.value("(document.querySelector('#share').focus(), 0)");
    browser.keys(&["\u{E010}"]);
    browser.keys(&["\u{E011}"]);
    browser.until("location.hash.includes('share=0.02')");
    browser.until(READY);
    browser.until("document.querySelector('#about').textContent.startsWith('101 points')");
    assert!(browser.text("#command").contains("keep=0.02"));
    // Back restores the earlier choices.
    browser.value("(document.querySelector('#points').value = '9409', document.querySelector('#points').dispatchEvent(new Event('change')), 0)");
    browser.until(&format!(
        "{READY} && document.querySelector('#about').textContent.includes('97 × 97')"
    ));
    browser.value("(history.back(), 0)");
    browser.until(&format!(
        "{READY} && document.querySelector('#about').textContent.includes('71 × 71')"
    ));
    assert_eq!(browser.errors(), Vec::<String>::new());
    // The page reports an invalid seed at its field.
    browser.value("(document.querySelector('#seed').value = 'x', document.querySelector('#seed').dispatchEvent(new Event('input')), 0)");
    browser.until("!document.querySelector('#wrong-seed').hidden");
    assert!(browser.text("#wrong-seed").contains("whole number"));
    // Nothing of the tile before is left.
    assert_eq!(browser.text("#about"), "");
    assert_eq!(
        browser.value("document.querySelector('#download').disabled"),
        true
    );
}

#[test]
fn a_mask_is_the_servers_and_dithers_a_ramp() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    browser.go(&daemon.url("/tile#what=mask&size=64&seed=5"));
    browser.until(READY);
    assert_eq!(browser.value("strew.kinds.mask.side"), 64);
    // Half of a ramp's pixels are white, and none is gray.
    let white = "(() => { const canvas = document.querySelector('#picture'); \
        const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height); \
        const grays = Array.from({ length: data.length / 4 }, (_, i) => data[4 * i]); \
        if (grays.some((v) => v !== 0 && v !== 255)) return null; \
        return grays.filter((v) => v === 255).length / grays.length; })()";
    let white = browser.value(white).as_f64().expect("black and white");
    assert!((white - 0.5).abs() < 0.01, "{white}");
    let line = browser.text("#command");
    assert!(line.contains("/v1/mask.png?size=64&seed=5"), "{line}");
    browser.click("#what-points");
    browser.until("document.querySelector('#about').textContent.includes('points on a square')");
    // The page reports a profile that is not loaded, and shows another one.
    browser.go(&daemon.url("/livez"));
    browser.go(&daemon.url("/tile#what=points&profile=nothing"));
    browser.until(READY);
    browser.until("document.querySelector('#banner').textContent.includes('nothing')");
    assert_eq!(browser.errors(), Vec::<String>::new());
}
