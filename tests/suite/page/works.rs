//! The laboratory: its pattern is the server's, and everything it shows can be chosen by mouse, keys and
//! address.

use serde_json::Value;

use crate::support::{
    browser::{Browser, looking},
    daemon::Daemon,
};

/// Opens the tab, and waits until it has drawn a mode at an α.
fn open(browser: &Browser, daemon: &Daemon, hash: &str, drawn: &str) {
    browser.look(daemon, &format!("#tab=works{hash}"));
    drawn_as(browser, drawn);
}

fn drawn_as(browser: &Browser, drawn: &str) {
    browser.until(&format!(
        "document.documentElement.dataset.works === '{drawn}'"
    ));
}

fn facts(browser: &Browser) -> String {
    browser.text("#works-facts")
}

#[test]
fn the_points_of_the_page_are_those_of_the_server() {
    let Some((daemon, browser)) = looking(1440, 900) else {
        return;
    };
    for alpha in ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2", "13/8", "1.3"] {
        let written = alpha.replace('+', "%2B").replace('/', "%2F");
        open(
            &browser,
            &daemon,
            &format!("&how.alpha={written}"),
            &format!("index {alpha}"),
        );
        let shown = browser.value("strew.works.points");
        // Every point of the pattern is an occurrence of the arrangement of itself.
        let address = format!(
            "/v1/pattern/arrangements?alpha={written}&offsets=0,0&grid=-24,-24,25,25&list=json"
        );
        let listed = daemon.get(&address).json();
        let listed = listed["occurrences"].as_array().expect("a list");
        let places = |points: &[Value]| {
            let mut places: Vec<[i64; 2]> = points
                .iter()
                .map(|place| serde_json::from_value(place.clone()).expect("a place"))
                .collect();
            places.sort_unstable();
            places
        };
        let listed: Vec<Value> = listed.iter().map(|one| one["at"].clone()).collect();
        assert_eq!(
            places(shown.as_array().expect("a list")),
            places(&listed),
            "{alpha}"
        );
        // So are the blocks of its map.
        let map = daemon
            .get(&format!("/v1/pattern/map?alpha={written}&radius=7"))
            .json();
        let fewer = browser.value("strew.works.last.starts(7).length");
        // A fraction that is no binary one has further intervals, which only rounding makes.
        assert_eq!(fewer, map["intervals"], "{alpha}");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn modes_and_arrangements_are_steps_that_back_undoes() {
    let Some((daemon, browser)) = looking(1440, 900) else {
        return;
    };
    open(&browser, &daemon, "", "index (5-sqrt(3))/2");
    assert!(
        facts(&browser).contains("has the index dX"),
        "{}",
        facts(&browser)
    );
    browser.click("#works-arrangement");
    drawn_as(&browser, "arrangement (5-sqrt(3))/2");
    let path = "/v1/pattern/arrangements?offsets=2,1+3,3&grid=0,0,1000000,1000000";
    let count = daemon.get(path).json()["count"].as_u64().expect("a number");
    let digits: String = count.to_string();
    browser.until(&format!(
        "document.querySelector('#works-facts').textContent.replaceAll(',', '').includes('exactly {digits}')"
    ));
    browser.click("#works-clear");
    browser.until("strew.session.state.works.offsets === ''");
    assert!(
        facts(&browser).contains("a single point"),
        "{}",
        facts(&browser)
    );
    // The first point is chosen, and then another one is added by keys.
    browser.value("document.querySelector('#works-plane').focus()");
    browser.keys(&["\u{E014}", "\u{E007}"]);
    browser.until("strew.session.state.works.point === strew.works.point().join(':')");
    let before = browser.hash();
    browser.value("strew.works.tap(strew.works.points.find(([x, y]) => x > 3 && y > 3))");
    browser.until("strew.session.state.works.offsets !== ''");
    assert_ne!(browser.hash(), before);
    browser.value("history.back()");
    browser.until("strew.session.state.works.offsets === ''");
    browser.value("history.go(-2)");
    browser.until("strew.session.state.works.mode !== 'arrangement' || strew.session.state.works.offsets !== ''");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn alpha_is_a_slider_a_field_and_a_part_of_the_address() {
    let Some((daemon, browser)) = looking(1024, 700) else {
        return;
    };
    open(&browser, &daemon, "", "index (5-sqrt(3))/2");
    let count = || browser.value("strew.works.points.length");
    let before = count();
    // As a drag does: it is live before it is a choice.
    browser.value(
        "(() => { const slider = document.querySelector('#works-slider'); slider.value = '1.4'; \
         slider.dispatchEvent(new Event('input')); })()",
    );
    drawn_as(&browser, "index 1.4");
    assert_ne!(count(), before);
    assert!(!browser.hash().contains("how.alpha"));
    browser.value("document.querySelector('#works-slider').dispatchEvent(new Event('change'))");
    browser.until("location.hash.includes('how.alpha=1.4')");
    browser.value("history.back()");
    drawn_as(&browser, "index (5-sqrt(3))/2");
    browser.value(
        "(() => { const field = document.querySelector('#works-alpha'); field.value = '2'; \
         field.dispatchEvent(new Event('change')); })()",
    );
    browser.until("document.querySelector('#works-alpha').getAttribute('aria-invalid') === 'true'");
    assert!(facts(&browser).contains("between 1 and 2"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn the_first_point_is_one_of_several_in_its_block() {
    let Some((daemon, browser)) = looking(1440, 900) else {
        return;
    };
    open(&browser, &daemon, "", "index (5-sqrt(3))/2");
    let said = facts(&browser);
    assert!(said.contains("others of this window: they have"), "{said}");
    // One that is alone is not said to be like others.
    open(&browser, &daemon, "&how.radius=40", "index (5-sqrt(3))/2");
    let said = facts(&browser);
    assert!(said.contains("alone in it here."), "{said}");
    // Settings are right where α is not.
    browser.look(&daemon, "#tab=works&how.alpha=1&how.radius=9");
    browser.until("document.querySelector('#works-alpha').getAttribute('aria-invalid') === 'true'");
    let slider = "document.querySelector('#works-radius')";
    assert_eq!(browser.value(&format!("{slider}.value")), "9");
    assert_eq!(
        browser.value(&format!("{slider}.getAttribute('aria-valuetext')")),
        "9 grid units"
    );
}

#[test]
fn a_phone_shows_what_a_mode_is_about_and_all_drawings() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    open(&browser, &daemon, "", "index (5-sqrt(3))/2");
    let top = |selector: &str| {
        let script = format!("document.querySelector('{selector}').getBoundingClientRect().top");
        browser.value(&script).as_f64().expect("pixels")
    };
    let about = browser.text("#works-about");
    assert!(about.contains("place on a torus"), "{about}");
    assert!(top("#works-about") + 60.0 < top("#panel"));
    // The torus follows the pattern that it belongs to.
    assert!(top("#works-torus") < top("#works-facts"));
    let below =
        browser.value("document.querySelector('#works-plane').getBoundingClientRect().bottom");
    assert!(top("#works-torus") - below.as_f64().expect("pixels") < 80.0);
    browser.click("#works-map");
    drawn_as(&browser, "map (5-sqrt(3))/2");
    assert!(browser.text("#works-about").contains("into blocks"));
}

#[test]
fn displaced_points_end_where_the_server_has_them() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    let hash = "&how.mode=displacement&how.moved=1";
    open(&browser, &daemon, hash, "displacement (5-sqrt(3))/2");
    browser.until("strew.works.displaced && strew.works.displaced.places.size > 300");
    let place = browser.value("[...strew.works.displaced.places][40]");
    let id = place[0].as_str().expect("an id");
    let spacing = browser.value("1 / strew.works.last.t");
    let point = daemon
        .get(&format!(
            "/v1/points/{id}?spacing={spacing}&seed=0&warp=off"
        ))
        .json();
    let near = |i: usize, name: &str| {
        let (a, b) = (place[1][i].as_f64(), point["point"][name].as_f64());
        assert!((a.expect("a number") - b.expect("a number")).abs() < 1e-6);
    };
    near(0, "x");
    near(1, "y");
    // What this mode holds does not stand in the way of what the page tells its parts.
    browser.value("strew.plane.drag(1, 0)");
    // The caption says what is drawn.
    let caption = browser.text("#works-caption");
    assert!(caption.contains("displaced by their vectors"), "{caption}");
    assert!(facts(&browser).contains("129 × 129 blocks"));
    browser.choose("#works-moved", "0");
    browser.until("document.querySelector('#works-caption').textContent.includes('belong to it')");
    // An α without a table has an answer in words.
    open(
        &browser,
        &daemon,
        "&how.mode=displacement&how.alpha=1.4",
        "displacement 1.4",
    );
    browser.until("document.querySelector('#works-facts').textContent.includes('No table moves')");
}

#[test]
fn a_finger_chooses_points_and_modes_on_a_phone() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    open(&browser, &daemon, "", "index (5-sqrt(3))/2");
    let middle = |selector: &str| {
        let script = format!(
            "(() => {{ const seen = document.querySelector('{selector}'); seen.scrollIntoView({{ block: 'center' }}); \
             const box = seen.getBoundingClientRect(); \
             return [Math.round(box.left + box.width / 2), Math.round(box.top + box.height / 2)]; }})()"
        );
        serde_json::from_value::<[i32; 2]>(browser.value(&script)).expect("a place")
    };
    let center = middle("#works-plane");
    // A point of the pattern away from the one that is looked at, by its place in the drawing.
    let place = browser.value(
        "(() => { const { plane, points } = strew.works, box = plane.canvas.getBoundingClientRect(); \
         const point = points.find(([x, y]) => x > 3 && x < 9 && y > 3 && y < 9); \
         return { point: point.join(':'), at: [box.left + plane.x(point[0]), box.top + plane.y(point[1])] \
         .map(Math.round) }; })()",
    );
    let at: [i32; 2] = serde_json::from_value(place["at"].clone()).expect("a place");
    assert_ne!(at, center);
    browser.tap(at);
    browser.until(&format!(
        "strew.works.point().join(':') === {}",
        place["point"]
    ));
    browser.tap(middle("#works-arrangement"));
    drawn_as(&browser, "arrangement (5-sqrt(3))/2");
    let before = browser.value("strew.session.state.works.offsets");
    middle("#works-plane");
    let place = browser.value(
        "(() => { const { plane, points } = strew.works, box = plane.canvas.getBoundingClientRect(); \
         const point = points.find(([x, y]) => x < -3 && x > -9 && y < -3 && y > -9); \
         return [box.left + plane.x(point[0]), box.top + plane.y(point[1])].map(Math.round); })()",
    );
    browser.tap(serde_json::from_value(place).expect("a place"));
    browser.until(&format!("strew.session.state.works.offsets !== {before}"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}
