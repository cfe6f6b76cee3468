//! The walk at `/walk`: it draws the server's points, the same on the way back, and keys do all of it.

use crate::support::{
    browser::{Browser, looking},
    daemon::Daemon,
};

const READY: &str = "document.documentElement.dataset.state === 'ready'";

/// Opens a walk that stands still, drawn as coarsely as it can be.
fn walk(daemon: &Daemon, browser: &Browser, more: &str) {
    let hash = "#at=-126,0&yaw=20&fly=0&quality=0";
    browser.go(&daemon.url(&format!("/walk{hash}{more}")));
    browser.until(READY);
}

/// Goes where the button leads, and waits until points surround the walker, near the first coordinate `x`.
fn jump(browser: &Browser, x: f64) {
    browser.click("#jump");
    browser.until(&format!("Math.abs(strew.world.around.x.i - {x}) < 700"));
    browser.until(READY);
}

/// How far the nearest tree is from the walker, in units.
const NEAREST_TREE: &str = "(() => { let least = Infinity; \
    for (const { leaf, runs, floats } of strew.look.things.filter(({ set }) => set === strew.world.sets[0])) \
      for (const { kind, first, ranks } of runs) if (kind < 2) \
        for (let i = first; i < first + ranks.length; i += 1) \
          least = Math.min(least, Math.hypot(leaf.from[0] + floats[10 * i], leaf.from[1] + floats[10 * i + 1])); \
    return least; })()";

/// The id of what Enter picks.
fn picked(browser: &Browser) -> String {
    browser.value("(strew.walker.canvas.focus(), 0)");
    browser.keys(&["\u{E007}"]);
    let id = browser.until("document.querySelector('#card').dataset.id");
    browser.keys(&["\u{E00C}"]);
    browser.until("document.querySelector('#card').hidden");
    id.as_str().expect("text").into()
}

/// Compares what stands in a leaf with the chunk that the server answers for it: `null` if they agree.
const COMPARED: &str = "(async (leaf) => { \
    const thing = strew.world.sets[0].built.get(`${leaf.level}/${leaf.cx}/${leaf.cy}`); \
    const path = `/v1/chunks/${leaf.size}/${leaf.cx}/${leaf.cy}?spacing=2&seed=7&format=csv&lod=${leaf.keep}`; \
    const lines = (await (await fetch(path)).text()).trim().split('\\n').slice(1); \
    const theirs = lines.map((line) => line.split(',').slice(1).map(Math.fround).join()).sort(); \
    const ours = []; \
    for (let i = 0; i < thing.floats.length; i += 10) ours.push(thing.floats.subarray(i, i + 2).join()); \
    ours.sort(); \
    return theirs.length > 500 && ours.join(' ') === theirs.join(' ') ? null : [ours.length, theirs.length]; })";

#[test]
fn what_stands_there_is_what_the_server_has_there() {
    let Some((daemon, browser)) = looking(640, 420) else {
        return;
    };
    if browser.lacks_webgl2() {
        return;
    }
    walk(&daemon, &browser, "");
    let leaves = "strew.world.sets[0].leaves";
    for leaf in [
        format!("{leaves}[0]"),
        format!("{leaves}.find((one) => one.level === 1)"),
        format!("{leaves}.at(-1)"),
    ] {
        let difference = browser.value(&format!("await {COMPARED}({leaf})"));
        assert!(difference.is_null(), "{leaf}: {difference}");
    }
    let tally = browser.text("#tally");
    assert!(
        tally.contains("points drawn") && tally.contains("chunks"),
        "{tally}"
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn keys_walk_and_pick_and_the_same_trees_stand_there_on_the_way_back() {
    let Some((daemon, browser)) = looking(640, 420) else {
        return;
    };
    if browser.lacks_webgl2() {
        return;
    }
    walk(&daemon, &browser, "");
    let press = |kind: &str, key: &str| {
        let event = format!("new KeyboardEvent('{kind}', {{ key: '{key}', bubbles: true }})");
        browser.value(&format!("document.activeElement.dispatchEvent({event})"));
    };
    // A tool that was clicked has the focus, and keys walk all the same.
    browser.click("#theme");
    press("keydown", "w");
    browser.until("strew.walker.y.i >= 1");
    press("keyup", "w");
    assert_eq!(browser.value("strew.walker.held.size"), 0);
    // How far the walk went depends on how quickly the key was let go.
    let start = browser
        .value("strew.walker.x.i")
        .as_f64()
        .expect("a number");
    let here = picked(&browser);
    let path = format!("/v1/points/{here}?spacing=2&seed=7");
    assert_eq!(daemon.get(&path).status, 200, "{path}");
    // Far away the walk works as it does here, and begins in a clearing; the address has the place.
    jump(&browser, 1e9);
    let nearest = browser.value(NEAREST_TREE).as_f64().expect("a distance");
    assert!(nearest > 5.0, "a tree {nearest} units away");
    let there = picked(&browser);
    assert_ne!(there, here);
    let path = format!("/v1/points/{there}?spacing=2&seed=7");
    let x = daemon.get(&path).json()["point"]["x"].as_f64();
    assert!((x.expect("a number") - 1e9).abs() < 800.0, "{x:?}");
    let nearest = format!("await {COMPARED}(strew.world.sets[0].leaves[0])");
    assert!(browser.value(&nearest).is_null());
    jump(&browser, start);
    assert_eq!(picked(&browser), here);
    browser.until(&format!(
        "Math.abs(parseFloat(location.hash.slice('#at='.length)) - {start}) < 2"
    ));
    let plane = browser.until("document.querySelector('#plane').getAttribute('href').slice(1)");
    assert!(
        plane.as_str().expect("text").contains("variants="),
        "{plane}"
    );
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_flight_is_above_the_crowns_and_lands_in_a_clearing() {
    let Some((daemon, browser)) = looking(640, 420) else {
        return;
    };
    browser.go(&daemon.url("/walk#quality=0&map=1"));
    browser.until("globalThis.strew?.look?.things.length > 0");
    // The map moves as the picture does, and is drawn more quickly. No tree is taller than 15.5 units times 1.3; the flight is so high from its first frame on.
    let lift = "(strew.look.height - strew.world.heightAt(strew.walker))";
    let lift = browser.value(lift).as_f64().expect("a height");
    assert!(lift > 20.5, "{lift} above the ground");
    browser.until("strew.walker.y.i >= 2 && location.hash.includes('fly=1')");
    assert_eq!(browser.text("#fly"), "Land");
    browser.click("#fly");
    browser.until("!strew.walker.isAloft && !strew.walker.target");
    browser.until("strew.look.lift < 2");
    browser.until(READY);
    let nearest = browser.value(NEAREST_TREE).as_f64().expect("a distance");
    assert!(nearest > 4.0, "a tree {nearest} units away");
    assert_eq!(browser.text("#fly"), "Fly");
    // Where less motion is wanted, the walk begins on the ground, in a clearing.
    browser.reduce_motion();
    browser.go("about:blank");
    browser.go(&daemon.url("/walk#quality=0&map=1"));
    browser.until(READY);
    assert_eq!(browser.value("strew.walker.isAloft"), false);
    let nearest = browser.value(NEAREST_TREE).as_f64().expect("a distance");
    assert!(nearest > 5.0, "a tree {nearest} units away");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn two_thumbs_walk_and_look_and_a_mouse_sees_no_sticks() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    let shown =
        "[...document.querySelectorAll('.stick')].filter((one) => one.offsetWidth > 0).length";
    walk(&daemon, &browser, "&map=1");
    assert_eq!(browser.value(shown), 0);
    browser.use_touch();
    browser.until(&format!("{shown} === 2"));
    let [walks, looks] = ["#stick-walk", "#stick-look"].map(|stick| browser.middle(stick));
    // One thumb pushes forth, the other to the right, at once.
    let yaw = browser
        .value("strew.walker.yaw")
        .as_f64()
        .expect("an angle");
    let north = "Math.cos(strew.walker.yaw)";
    assert!(browser.value(north).as_f64().expect("a number") > 0.0);
    browser.press_two([walks[0], walks[1] - 45], [looks[0] + 45, looks[1]]);
    browser.until("strew.walker.y.i >= 1 && strew.walker.looks[0] > 0.3");
    browser.until(&format!("strew.walker.yaw > {yaw} + 0.2"));
    browser.release();
    browser.until("[...strew.walker.walks, ...strew.walker.looks].every((one) => one === 0)");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn without_graphics_there_is_a_sentence_and_the_small_map_which_is_drawn_and_put_away() {
    let Some((daemon, browser)) = looking(640, 420) else {
        return;
    };
    walk(&daemon, &browser, "&map=1");
    assert!(browser.text("#banner").contains("WebGL2 is missing"));
    // Woods, clearings, the trail, and the walker in the middle.
    let colors = "(() => { const map = document.querySelector('#map'); \
        const { data } = map.getContext('2d').getImageData(0, 0, map.width, map.height); \
        const middle = 4 * (map.width * map.height / 2 + map.width / 2); \
        return map.width > 100 && data[middle] > 150 && data[middle + 2] < 60 \
          && new Set(new Uint32Array(data.buffer)).size > 50; })()";
    browser.until(colors);
    browser.click("#chart");
    assert_eq!(browser.value("document.querySelector('#map').hidden"), true);
    browser.click("#chart");
    browser.until(colors);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

/// Draws the view of the pictures twice as large as the larger of them, once all of it is there; returns them as JPEG.
const PICTURES: &str = "await (async () => { const { scene, walker } = strew; const paint = scene.draw; \
    scene.draw = () => 0; \
    scene.resize = () => Object.assign(scene.canvas, { width: 2400, height: 1260 }); \
    scene.mode = 'dusk'; \
    walker.step = (_, heightAt) => { walker.height = heightAt(walker) + 27; }; \
    while (!strew.world.isReady || scene.canvas.width !== 2400) await new Promise(requestAnimationFrame); \
    await new Promise(requestAnimationFrame); \
    paint.call(scene, strew.look); \
    return Promise.all([[1200, 630, 0.85], [480, 252, 0.6]].map(async ([width, height, quality]) => { \
      const small = Object.assign(document.createElement('canvas'), { width, height }); \
      const context = small.getContext('2d'); \
      context.imageSmoothingQuality = 'high'; \
      context.drawImage(scene.canvas, 0, 0, width, height); \
      const picture = await new Promise((done) => small.toBlob(done, 'image/jpeg', quality)); \
      return [...new Uint8Array(await picture.arrayBuffer())]; })); })()";

/// Writes the pictures of the walk that previews of links and cards show: `just pictures`.
#[test]
fn pictures() {
    if std::env::var_os("STREW_TEST_PICTURES").is_none() {
        eprintln!("skipped: STREW_TEST_PICTURES writes the pictures of the walk");
        return;
    }
    let (daemon, browser) = looking(1200, 630).expect("a browser");
    browser.go(&daemon.url("/walk#at=-126,0&yaw=16&pitch=-5&fly=0&quality=3"));
    browser.until("globalThis.strew?.look");
    let pictures = browser.value(PICTURES);
    for (i, name) in ["walk/preview.jpg", "start/walk.jpg"]
        .into_iter()
        .enumerate()
    {
        let bytes: Vec<u8> = serde_json::from_value(pictures[i].clone()).expect("a picture");
        let path = format!("{}/page/files/{name}", env!("CARGO_MANIFEST_DIR"));
        std::fs::write(path, bytes).expect("a file");
    }
}
