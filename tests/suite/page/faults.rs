//! The page reports a faulty choice at its field, in words for people, and leaves the panel as it is.

use crate::support::{
    browser::{Browser, looking},
    daemon::Daemon,
    keys::{entry, keys},
};

const KEY: &str = "a-key-that-no-client-guesses";

/// Waits until a field is marked as wrong, by words under it. Returns them.
fn wrong(browser: &Browser, field: &str) -> String {
    let words = format!(
        "(() => {{ const [e, w] = ['#{field}', '#wrong-{field}'].map((q) => document.querySelector(q)); \
         return e && !w.hidden && e.getAttribute('aria-invalid') === 'true' \
         && e.getAttribute('aria-describedby').includes(w.id) && w.textContent; }})()"
    );
    browser
        .until(&words)
        .as_str()
        .expect("words")
        .replace('`', "API: ")
}

fn right(browser: &Browser, field: &str) {
    browser.until(&format!(
        "document.querySelector('#{field}').getAttribute('aria-invalid') === 'false' \
         && document.querySelector('#wrong-{field}').hidden"
    ));
}

#[test]
fn what_is_wrong_is_said_at_its_field() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    // On a page that begins with a refused query, the plane is hidden.
    browser.go(&daemon.url("/#at=0,0&span=30&amount=-1"));
    browser.until("document.querySelector('#amount')");
    wrong(&browser, "amount");
    assert_eq!(
        browser.value("getComputedStyle(document.querySelector('#plane')).opacity"),
        "0"
    );
    browser.look(&daemon, "#at=0,0&span=30&scale=1&variant=1");
    for (field, value, says, good) in [
        ("amount", "-1", "“-1” does not work", "2"),
        ("seed", "abc", "whole number", "7"),
        ("range", "2,a", "Two numbers", "0.5,2"),
        ("variants", "a:x", "Names with weights", "a:1"),
    ] {
        browser.choose(&format!("#{field}"), value);
        let words = wrong(&browser, field);
        assert!(
            words.contains(says) && !words.contains("API"),
            "{field}: {words}"
        );
        browser.choose(&format!("#{field}"), good);
        right(&browser, field);
        browser.ready();
    }
    browser.choose("#profile", "pink");
    browser.ready();
    browser.choose("#by", "min_distance");
    assert!(wrong(&browser, "amount").contains("as near as they like"));
}

#[test]
fn distances_between_layers_are_checked_and_what_they_leave_is_said() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30&layers=2&2.seed=2");
    browser.click("#layer-1");
    for value in ["0,4", "abc", "-1", "100"] {
        browser.choose("#clear", value);
        assert!(
            wrong(&browser, "clear").contains("does not work"),
            "{value}"
        );
        browser.choose("#clear", "");
        right(&browser, "clear");
        browser.ready();
    }
    browser.choose("#clear", "1.2");
    browser.until("document.querySelector('#about-clear').textContent.includes('leaves no room')");
    browser.choose("#clear", "0.4");
    browser.until("!document.querySelector('#about-clear').textContent");
}

#[test]
fn the_panel_stays_and_back_restores_a_field_with_the_focus() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(&daemon, "#at=0,0&span=30&profile=blue&amount=1&seed=1");
    browser.value("(window.kept = document.querySelector('#amount'), 0)");
    browser.click("#amount");
    browser.keys(&["\u{E010}", "\u{E003}", "2"]);
    browser.until("location.hash.includes('amount=2')");
    browser.ready();
    let same = "kept === document.querySelector('#amount') && document.activeElement === kept";
    assert_eq!(browser.value(same), true);
    browser.value("history.back()");
    browser.until("location.hash.includes('amount=1') && strew.plane.look.spacing === 1");
    browser.until("kept.value === '1'");
    assert_eq!(browser.value(same), true);
    // Sliders act while they are held, and are one step of the history.
    let steps = browser.value("history.length").as_u64().expect("a number");
    let held = |id: &str, value: &str| {
        browser.value(&format!(
            "(() => {{ const e = document.querySelector('#{id}'); e.value = {value}; \
             e.dispatchEvent(new Event('input')); }})()"
        ));
    };
    for (value, spacing) in [(-1, "0.5"), (0, "1"), (1, "2")] {
        held("amount-slider", &value.to_string());
        browser.until(&format!("strew.plane.look.spacing === {spacing}"));
    }
    held("dot", "2");
    browser.until("strew.plane.look.layers[0].dot === 2");
    let after = browser.value("history.length").as_u64().expect("a number");
    assert!(after <= steps + 1, "{steps} {after}");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_key_is_taken_by_enter() {
    let Some((_, browser)) = looking(1280, 800) else {
        return;
    };
    let daemon = Daemon::start(&[&keys(&entry("guest", KEY, ""))]);
    browser.go(&daemon.url("/"));
    browser.until("document.activeElement.id === 'key'");
    let words = browser.text("#banner");
    assert!(
        words.contains("key") && !words.contains("Bearer"),
        "{words}"
    );
    let typed: Vec<String> = KEY.chars().map(String::from).collect();
    browser.keys(&typed.iter().map(String::as_str).collect::<Vec<_>>());
    browser.keys(&["\u{E007}"]);
    assert!(browser.ready() > 100);
}

#[test]
fn figures_are_compared_with_their_own_kind() {
    let Some((daemon, browser)) = looking(1280, 900) else {
        return;
    };
    for (warp, word) in [("", "table, warped"), ("&warp=off", "table")] {
        browser.look(
            &daemon,
            &format!("#at=0,0&span=100&profile=spaced&tab=understand{warp}"),
        );
        browser.until("Number(document.documentElement.dataset.measured) > 0");
        let pair =
            browser.value("[strew.understand.drawn.measured.figures.least, strew.understand.drawn.reference.least]");
        let [here, table] = [0, 1].map(|i| pair[i].as_f64().expect("a number"));
        assert!((here - table).abs() < 0.02, "{warp}: {here} {table}");
        let list = browser.text("#understand dl");
        assert!(list.contains(word), "{list}");
        assert!(!list.contains("in view"), "{list}");
    }
}

#[test]
fn nine_variants_have_nine_shapes() {
    let Some((daemon, browser)) = looking(1280, 800) else {
        return;
    };
    browser.look(
        &daemon,
        "#at=0,0&span=12&variant=1&variants=a:1,b:1,c:1,d:1,e:1,f:1,g:1,h:1,i:1",
    );
    let signs = browser.text("#legend");
    let mut signs: Vec<char> = signs.chars().filter(|c| !c.is_ascii()).collect();
    signs.sort_unstable();
    signs.dedup();
    assert_eq!(signs.len(), 9, "{signs:?}");
    assert_eq!(browser.errors(), Vec::<String>::new());
}
