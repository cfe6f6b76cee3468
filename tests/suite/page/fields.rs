//! Fields on the page: a loaded one, and a picture that becomes dots.

use crate::support::browser::looking;

/// Waits until the shade under the points is drawn.
const SHADED: &str = "!strew.shade.canvas.hidden && strew.shade.canvas.dataset.missing === '0'";

/// Whether the shade has any ink.
const INK: &str = "(() => { const c = strew.shade.canvas; \
    const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; \
    return d.some((v, i) => i % 4 === 3 && v > 40); })()";

#[test]
fn a_field_thins_the_points_and_is_shaded_under_them() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=200&amount=2");
    let all = browser.ready();
    let before = browser.value("strew.plane.chunks.identity");
    browser.choose("#field", "forest");
    browser.until(&format!("strew.plane.chunks.identity !== {before}"));
    let forest = browser.ready();
    assert!(forest > 500 && forest < all * 3 / 4, "{forest} of {all}");
    assert!(browser.hash().contains("field=forest"));
    // Points show it well enough; it is shaded on request.
    assert_eq!(browser.value("strew.shade.canvas.hidden"), true);
    browser.click("#shade-field");
    browser.until(SHADED);
    assert_eq!(browser.value(INK), true);
    browser.ready();
    let (hash, count) = (browser.hash(), browser.ready());
    assert!(hash.contains("shade=1"), "{hash}");
    browser.look(&daemon, &hash);
    assert_eq!((browser.hash(), browser.ready()), (hash, count));
    assert_eq!(browser.errors(), Vec::<String>::new());
    // The page reports a field that does not exist.
    browser.go("about:blank");
    browser.go(&daemon.url("/#at=0,0&span=100&field=nothing"));
    browser.until("document.documentElement.dataset.state === 'failed'");
    assert!(
        browser
            .text("#wrong-field")
            .contains("no such field is loaded")
    );
}

#[test]
fn a_picture_is_sent_once_and_becomes_dots_where_it_is_dark() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    browser.look(&daemon, "#at=50,50&span=100");
    browser.ready();
    // Its left half is black.
    let picture = "(async () => { const c = document.createElement('canvas'); c.width = 400; c.height = 300; \
        const t = c.getContext('2d'); t.fillStyle = '#fff'; t.fillRect(0, 0, 400, 300); \
        t.fillStyle = '#000'; t.fillRect(0, 0, 200, 300); \
        const blob = await new Promise((done) => c.toBlob(done)); \
        await strew.stipple(new File([blob], 'half.png')); })()";
    let before = browser.value("strew.plane.chunks.identity");
    browser.value(&format!("({picture}, 0)"));
    browser.until(&format!("strew.plane.chunks.identity !== {before}"));
    let count = browser.ready();
    assert!((20_000..40_000).contains(&count), "{count}");
    let right = browser.in_view().iter().filter(|[x, _]| *x > 51.0).count();
    assert!(right < 50, "{right}");
    // It is dark on light in both themes, without a shade.
    assert_eq!(browser.value("strew.shade.canvas.hidden"), true);
    for theme in ["light", "dark"] {
        browser.click("#theme");
        browser.until(&format!(
            "document.documentElement.dataset.theme !== '{theme}'"
        ));
        browser.ready();
        let light = "[strew.plane.look.ground, strew.plane.look.colors[0]].map((rgb) => rgb.reduce((a, b) => a + b) / 3)";
        let light = browser.value(light);
        assert!(
            light[0].as_f64() > Some(0.9) && light[1].as_f64() < Some(0.2),
            "{theme}: {light}"
        );
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
    // The page reports a file that is no picture.
    browser.value("(strew.stipple(new File(['GIF'], 'other.gif')), 0)");
    browser.until("document.querySelector('#banner').textContent.includes('cannot read')");
}

#[test]
fn a_forest_has_the_colors_of_woods_and_rocks_that_touch_no_tree() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    super::start::first_visit(&browser, &daemon);
    browser.click("#view-forest");
    browser.until("location.hash.includes('field=forest') && strew.plane.look.layers.length === 2");
    browser.ready();
    assert_eq!(browser.value("strew.shade.canvas.hidden"), true);
    assert_eq!(
        browser.value("strew.plane.look.layers.map(({ color }) => color)"),
        serde_json::json!([9, 8])
    );
    // The largest rock and the largest tree, as they are drawn, are no wider than the distance that they keep.
    let room = "(() => { const { look, view, sheets } = strew.plane; \
        const [tree, rock] = look.layers.map(({ range }, i) => sheets.front.sizes[i] * Number(range.split(',')[1]) / 2 * view.unit); \
        return [tree + rock, Number(look.layers[1].clear)]; })()";
    let room = browser.value(room);
    assert!(
        room[0].as_f64() < room[1].as_f64().map(|v| v + 1e-9),
        "{room}"
    );
}
