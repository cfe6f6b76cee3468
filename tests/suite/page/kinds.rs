//! Kinds and worlds under Choose: they are in the address, in the request to take away, and in their colors.

use super::export::{assert_same, rows, run};
use crate::support::{
    browser::{Browser, looking},
    daemon::{Daemon, no_tables},
};

/// The colors of the canvas that are those of the palette, by their numbers.
const COLORS: &str = "(() => { const { canvas, look } = strew.plane; \
    const d = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data; const seen = new Set(); \
    for (let i = 0; i < d.length; i += 4) seen.add(`${d[i]} ${d[i + 1]} ${d[i + 2]}`); \
    return look.colors.map((rgb) => rgb.map((v) => Math.round(v * 255)).join(' ')).flatMap((c, i) => (seen.has(c) ? [i] : [])); })()";

/// The line for curl.
fn line(browser: &Browser) -> String {
    browser.click("#tab-take");
    browser.until("document.documentElement.dataset.weighed");
    browser.text("#command")
}

#[test]
fn kinds_are_chosen_and_drawn_in_their_colors() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    for (spread, kinds) in [
        ("chance", ""),
        ("even", "spread=even"),
        ("joint", "spread=joint"),
    ] {
        browser.look(&daemon, "#at=0,0&span=12");
        browser.choose("#spread", spread);
        browser.until(&format!(
            "location.hash.includes('spread={spread}') && strew.plane.look.layers[0].spread === '{spread}'"
        ));
        let count = browser.ready();
        assert_eq!(browser.value(COLORS), serde_json::json!([0, 1]), "{spread}");
        assert_eq!(browser.text("#legend"), "birchoak");
        let line = line(&browser);
        assert!(
            line.contains("variants=birch:1,oak:3") && line.contains(kinds),
            "{line}"
        );
        run(&line, "curl", |text| {
            assert_same(&browser, &rows(text));
            assert!(text.contains("birch") && text.contains("oak"), "{text}");
        });
        let hash = browser.hash();
        browser.look(&daemon, &hash);
        assert_eq!(browser.ready(), count);
    }
    // The shares of joint kinds are those that the server has tables for.
    browser.click("#tab-choose");
    let shares =
        browser.value("[...document.querySelectorAll('#ratio option')].map((e) => e.value)");
    assert_eq!(shares, serde_json::json!(["1:1", "1:1:2", "1:3", "1:3:10"]));
    browser.choose("#ratio", "1:3:10");
    browser.until("strew.plane.look.layers[0].variants.includes('pine:10')");
    assert!(browser.ready() > 100);
    assert_eq!(browser.value(COLORS), serde_json::json!([0, 1, 2]));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_world_of_the_server_is_shown_by_its_name() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    drop(daemon);
    let folder = concat!("worlds.folder=", env!("CARGO_MANIFEST_DIR"), "/docs/worlds");
    let daemon = Daemon::with_tables(no_tables(), &[folder, "server.first_byte_seconds=300"]);
    browser.look(&daemon, "#at=0,0&span=60");
    browser.choose("#world", "forest");
    browser.until("location.hash.includes('world=forest') && strew.plane.look.layers.length === 3");
    let count = browser.ready();
    assert_eq!(browser.in_view().len() as u64, count);
    let expected = daemon
        .get("/v1/count?world=forest&bbox=-30,-30,30,30")
        .json()["count"]
        .as_u64();
    assert!(
        count > expected.expect("a count"),
        "the window is wider: {count}"
    );
    // Trees and bushes are green, rocks gray.
    assert_eq!(browser.value(COLORS), serde_json::json!([8, 9, 10]));
    assert_eq!(browser.text("#world-layers"), "treesbushesrocks");
    browser.click("#plane");
    browser.until("document.querySelector('#card h2')?.textContent && !document.querySelector('#card').hidden");
    assert!(browser.text("#card").contains("Nearest"));
    let line = line(&browser);
    assert!(
        line.contains("world=forest") && !line.contains("-d "),
        "{line}"
    );
    run(&line, "curl", |text| assert_same(&browser, &rows(text)));
    let hash = browser.hash();
    assert!(!hash.contains("layers="), "{hash}");
    browser.look(&daemon, &hash);
    assert_eq!(browser.ready(), count);
    // Another seed is another forest; without a world there are layers again.
    browser.click("#tab-choose");
    browser.choose("#world-seed", "8");
    browser.until(
        "location.hash.includes('world.seed=8') && strew.plane.look.layers[0].world.seed === '8'",
    );
    assert_ne!(browser.ready(), 0);
    browser.choose("#world", "");
    browser.until("!location.hash.includes('world') && strew.plane.look.layers.length === 1");
    assert!(browser.ready() > 100);
    assert_eq!(browser.errors(), Vec::<String>::new());
    browser.go("about:blank");
    browser.go(&daemon.url("/#at=0,0&span=30&world=nope"));
    browser.until("document.querySelector('#banner').innerText.includes('no world “nope”')");
}
