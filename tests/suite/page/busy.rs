//! A server that is busy, slow or refuses: the page says so over the plane, in its own words, and goes on by itself.

use serde_json::json;

use crate::support::{
    browser::looking,
    front::{Front, Points},
};

/// The words over the plane, or nothing.
const WORDS: &str =
    "(() => { const e = document.querySelector('#banner'); return !e.hidden && e.innerText; })()";
/// Whether nothing is said there.
const QUIET: &str = "document.querySelector('#banner').hidden";
/// Whether the words are where the plane's middle is.
const IN_THE_MIDDLE: &str = "(() => { const [a, b] = ['#banner', '#plane'].map((q) => document.querySelector(q).getBoundingClientRect()); \
    return a.left < b.left + b.width / 2 && a.right > b.left + b.width / 2 && a.top < b.top + b.height / 2 && a.bottom > b.top + b.height / 2; })()";

#[test]
fn a_busy_server_is_waited_for_with_a_word() {
    let Some((daemon, browser)) = looking(390, 844) else {
        return;
    };
    for status in [429, 503] {
        let front = Front::of(daemon.address(), Points::Refuse(status, 2));
        browser.go(&front.url("/"));
        let words = browser.until(WORDS);
        let words = words.as_str().expect("words");
        assert!(words.contains("The server is busy"), "{words}");
        assert!(
            words.contains("Trying again") && !words.contains("API"),
            "{words}"
        );
        assert_eq!(browser.value(IN_THE_MIDDLE), true);
        front.set(Points::Pass);
        browser.until(QUIET);
        assert!(browser.ready() > 100);
        assert_eq!(browser.value(QUIET), true);
    }
}

#[test]
fn a_busy_server_is_asked_again_at_once_by_a_button() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    let front = Front::of(daemon.address(), Points::Refuse(503, 3000));
    browser.go(&front.url("/#at=0,0&span=300"));
    browser.until(&format!("({WORDS} || '').includes('Trying again in')"));
    // Meanwhile no other requests for points are sent.
    let waiting = browser
        .value("strew.plane.chunks.wanted.filter(({ state }) => state === 'waiting').length");
    assert_ne!(waiting, 0);
    front.set(Points::Pass);
    browser.click("#banner button");
    assert!(browser.ready() > 100);
    browser.until(QUIET);
}

#[test]
fn a_slow_server_is_called_so_until_points_come() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    let front = Front::of(daemon.address(), Points::Hang);
    browser.go(&front.url("/"));
    let words = browser.until(WORDS);
    assert!(
        words.as_str().expect("words").contains("slow to answer"),
        "{words}"
    );
    front.set(Points::Pass);
    assert!(browser.ready() > 100);
    browser.until(QUIET);
}

#[test]
fn too_many_points_are_said_with_the_way_out() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    let front = Front::of(daemon.address(), Points::Refuse(413, 0));
    browser.go(&front.url("/#at=0,0&span=60"));
    let words = browser.until(WORDS);
    let words = words.as_str().expect("words");
    assert!(
        words.contains("Zoom in") && !words.contains("API"),
        "{words}"
    );
    front.set(Points::Pass);
    browser.click("#banner button");
    browser.until("strew.plane.span === 30");
    assert!(browser.ready() > 100);
    browser.until(QUIET);
}

#[test]
fn a_link_to_what_cannot_be_drawn_says_so_over_the_plane() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.go(&daemon.url("/#at=0,0&span=30&alpha=3&tab=understand"));
    let words = browser.until(WORDS);
    let words = words.as_str().expect("words");
    assert!(
        words.contains("cannot be drawn") && words.contains("“3”"),
        "{words}"
    );
    assert!(
        !words.contains('`') && !words.contains("allowed"),
        "{words}"
    );
    assert_eq!(browser.value(IN_THE_MIDDLE), true);
    browser.until("document.querySelector('#tally').textContent === 'Check the field marked red'");
    browser.click("#banner button");
    browser.until(
        "document.activeElement.id === 'alpha' && !document.querySelector('#choose').hidden",
    );
    browser.choose("#alpha", "sqrt(3)");
    assert!(browser.ready() > 100);
    browser.until(QUIET);
    browser.go("about:blank");
    browser.go(&daemon.url("/#at=0,0&span=30&amount=-1"));
    browser.until(WORDS);
    browser.click("#banner button:last-of-type");
    assert!(browser.ready() > 100);
    assert_eq!(browser.value("location.hash.includes('amount=1&')"), true);
}

#[test]
fn a_profile_that_no_server_has_is_not_requested() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30&profile=nope");
    assert_eq!(browser.errors(), Vec::<String>::new());
    assert_eq!(json!(browser.hash().contains("profile=blue")), true);
}
