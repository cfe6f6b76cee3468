//! Links and choices that cannot be shown: the page states why and shows the rest.

use crate::support::browser::looking;

#[test]
fn places_without_points_are_said_and_left() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    for at in ["1e18,0", "0,-1e22", "1e300,1e300"] {
        browser.look(&daemon, &format!("#at={at}&span=30"));
        assert!(browser.ready() > 500, "{at}");
        assert!(browser.text("#banner").contains("too far out"), "{at}");
        browser.until("location.hash.includes('at=0,0')");
    }
    // A jump is refused at its field, and the view stays.
    browser.look(&daemon, "#at=100,200&span=30");
    browser.choose("#jump-at", "1e18, 0");
    browser.click("#jump button");
    assert!(browser.text("#banner").contains("too far out"));
    assert_eq!(
        browser.value("document.querySelector('#jump-at').getAttribute('aria-invalid')"),
        "true"
    );
    assert_eq!(browser.value("strew.plane.view.x.i"), 100);
    browser.choose("#jump-at", "nowhere");
    browser.click("#jump button");
    assert!(browser.text("#banner").contains("is not a place"));
    // As far out as doubles reach there are points.
    browser.choose("#jump-at", "1e15, -1e15");
    browser.click("#jump button");
    browser.until("strew.plane.view.x.i === 1e15");
    assert!(browser.ready() > 500);
    // Home forgets typed values.
    browser.click("#home");
    browser.until("strew.plane.view.x.i === 0");
    assert_eq!(
        browser.value("document.querySelector('#jump-at').value"),
        ""
    );
}

#[test]
fn a_profile_that_is_not_loaded_is_said_and_replaced() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30&profile=nope");
    assert!(browser.ready() > 500);
    assert!(browser.text("#banner").contains("no profile “nope”"));
    browser.until("location.hash.includes('profile=blue')");
    assert_eq!(
        browser.value("document.querySelector('#profile').value"),
        "blue"
    );
}

#[test]
fn the_view_follows_a_spacing_that_would_leave_it_empty() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30");
    browser.choose("#amount", "1000");
    browser.until("strew.plane.span === 30000");
    assert!(browser.ready() > 500);
    browser.value("history.back()");
    browser.until("strew.plane.span === 30");
    assert!(browser.ready() > 500);
    // A link to an empty view is shown as it is, with a word.
    browser.look(&daemon, "#at=300,300&span=600&amount=1000");
    browser.until("document.querySelector('#tally').textContent.includes('zoom out')");
}

#[test]
fn malformed_links_show_what_they_can() {
    let Some((daemon, browser)) = looking(640, 420) else {
        return;
    };
    // Strokes of no length, too many, or with nothing between the brackets.
    let strokes = "p(1:0,0/1,1)".repeat(6000);
    for hash in [
        "#%E0%A4%A&at=,&span=-1&tab=nope&dot=NaN&color=99&layers=1e9&renderer=no",
        "#span=Infinity&at=NaN,NaN&how.alpha=7&tab=works",
        "#at=0,0&span=30&paint=((((&2.paint=r(1:",
        &format!("#at=0,0&span=30&paint={strokes}"),
    ] {
        browser.look(&daemon, hash);
        assert!(browser.ready() > 100, "{}", &hash[..40]);
        let is_said = browser.text("#banner").contains("does not understand");
        assert_eq!(is_said, !hash.contains("paint=p"), "{}", &hash[..40]);
    }
    let open = |path: &str, ready: &str| {
        browser.go("about:blank");
        browser.go(&daemon.url(path));
        browser.until(ready);
    };
    let ready = "document.documentElement.dataset.state === 'ready'";
    for hash in [
        "#at=1e300,0&yaw=Infinity&pitch=NaN&quality=77&seed=-1&map=1",
        "#%E0%A4%A&at=nowhere&seed=99999999999999999999999999&map=1",
    ] {
        open(&format!("/walk{hash}"), ready);
        let is_near = "Math.hypot(strew.walker.x.i + 126, strew.walker.y.i) < 700";
        assert_eq!(browser.value(is_near), true, "{hash}");
    }
    for hash in ["#%", "#%E0%A4%A", "#nothing"] {
        open(&format!("/docs{hash}"), ready);
        assert_eq!(browser.text("main h2"), "The API", "{hash}");
        assert!(browser.text("main .bad").contains("no operation"), "{hash}");
    }
    for hash in [
        "#show=tile&span=0&seed=1e99&at=1e300,0&profile=%2F..%2F",
        "#%E0%A4%A&span=NaN",
    ] {
        open(
            &format!("/compare{hash}"),
            "document.documentElement.dataset.measured",
        );
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn another_link_takes_the_walk_there() {
    let Some((daemon, browser)) = looking(640, 420) else {
        return;
    };
    let ready = "document.documentElement.dataset.state === 'ready'";
    browser.go(&daemon.url("/walk#at=-126,0&map=1"));
    browser.until(ready);
    browser.value("(location.hash = '#at=500,500&seed=8', 0)");
    browser.until("strew.world.seed === '8' && strew.walker.x.i === 500");
    browser.until(ready);
    assert_eq!(browser.errors(), Vec::<String>::new());
}
