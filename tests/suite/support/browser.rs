//! A real browser without a window: Chromium, or another [`Engine`], driven by the W3C WebDriver protocol, which is
//! JSON over HTTP.

use std::{
    path::PathBuf,
    sync::{Mutex, MutexGuard, PoisonError},
};

use serde_json::{Value, json};
use strew_testkit::wait::until;

use super::{
    daemon::Daemon,
    engine::{Engine, logged_errors},
    session::Session,
};

/// The browser that runs, or ran for a test before: one, because nothing else that tests start is as heavy.
static PLACE: Mutex<Option<Session>> = Mutex::new(None);

/// Keys by their names.
pub mod key {
    pub const TAB: &str = "\u{E004}";
    pub const ENTER: &str = "\u{E007}";
    pub const SHIFT: &str = "\u{E008}";
    pub const PAGE_DOWN: &str = "\u{E00F}";
    pub const ESCAPE: &str = "\u{E00C}";
    pub const LEFT: &str = "\u{E012}";
    pub const RIGHT: &str = "\u{E014}";
}

/// A browser with one window, which nothing was done in. The next test has the same browser, with another window.
pub struct Browser(MutexGuard<'static, Option<Session>>);

/// A daemon with the built-in tables, and a browser. `None`, with a message, where no browser is
/// installed.
pub fn looking(width: u32, height: u32) -> Option<(Daemon, Browser)> {
    let browser = Browser::start(width, height)?;
    Some((Daemon::built_in(), browser))
}

impl Browser {
    fn start(width: u32, height: u32) -> Option<Self> {
        let engine = Engine::chosen();
        let (driver, program) = engine.programs()?;
        let mut place = PLACE.lock().unwrap_or_else(PoisonError::into_inner);
        let is_new = place.is_none();
        place.get_or_insert_with(|| Session::start(engine, &driver, &program));
        let browser = Self(place);
        if !is_new {
            browser.renew();
        }
        if engine == Engine::Chromium {
            let folder = json!({ "behavior": "allow", "downloadPath": browser.downloads() });
            browser.cdp("Browser.setDownloadBehavior", &folder);
        }
        browser.resize(width, height);
        Some(browser)
    }

    fn session(&self) -> &Session {
        self.0.as_ref().expect("it runs")
    }

    /// A new window, with a history of its own, in a browser that has forgotten everything.
    fn renew(&self) {
        let opened = self.call("window/new", &json!({ "type": "tab" }));
        let path = format!("/session/{}/window", self.session().id);
        self.session().send("DELETE", &path, &json!({}));
        self.call("window", &json!({ "handle": opened["handle"] }));
        let everywhere = json!({ "origin": "*", "storageTypes": "all" });
        self.cdp("Storage.clearDataForOrigin", &everywhere);
        self.cdp("Network.clearBrowserCache", &json!({}));
        self.cdp("Browser.resetPermissions", &json!({}));
        self.errors();
        std::fs::remove_dir_all(self.downloads()).expect("a folder");
        std::fs::create_dir_all(self.downloads()).expect("a folder");
    }

    /// The folder of downloads.
    pub fn downloads(&self) -> PathBuf {
        self.session().folder.path().join("downloads")
    }

    fn call(&self, path: &str, body: &Value) -> Value {
        let session = self.session();
        session.send("POST", &format!("/session/{}/{path}", session.id), body)
    }

    /// Sends a command of the Chrome DevTools Protocol.
    fn cdp(&self, name: &str, parameters: &Value) -> Value {
        self.call(
            "goog/cdp/execute",
            &json!({ "cmd": name, "params": parameters }),
        )
    }

    /// Sets a preference of Firefox.
    fn prefer(&self, name: &str, value: u32) {
        let context = |name: &str| self.call("moz/context", &json!({ "context": name }));
        context("chrome");
        self.value(&format!("Services.prefs.setIntPref({name:?}, {value})"));
        context("content");
    }

    /// Sets the inner size of the window, in CSS pixels.
    pub fn resize(&self, width: u32, height: u32) {
        if self.session().engine == Engine::Chromium {
            let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
            self.cdp("Emulation.setDeviceMetricsOverride", &size);
            return;
        }
        let outer = |width: u32, height: u32| {
            self.call("window/rect", &json!({ "width": width, "height": height }))
        };
        outer(width, height);
        let frame = self.value("[outerWidth - innerWidth, outerHeight - innerHeight]");
        let frame = |i: usize| frame[i].as_u64().expect("pixels") as u32;
        outer(width + frame(0), height + frame(1));
        self.until(&format!(
            "innerWidth === {width} && innerHeight === {height}"
        ));
    }

    /// Says that the visitor wants less motion.
    pub fn reduce_motion(&self) {
        match self.session().engine {
            Engine::Chromium => {
                let feature = json!({ "name": "prefers-reduced-motion", "value": "reduce" });
                self.cdp(
                    "Emulation.setEmulatedMedia",
                    &json!({ "features": [feature] }),
                );
            }
            Engine::Firefox => self.prefer("ui.prefersReducedMotion", 1),
        }
        self.until("matchMedia('(prefers-reduced-motion: reduce)').matches");
    }

    /// Says that the visitor uses fingers.
    pub fn use_touch(&self) {
        match self.session().engine {
            Engine::Chromium => {
                self.cdp(
                    "Emulation.setTouchEmulationEnabled",
                    &json!({ "enabled": true }),
                );
            }
            Engine::Firefox => self.prefer("ui.primaryPointerCapabilities", 1),
        }
    }

    /// Whether this is a Firefox that cannot draw by WebGL2, as where there is no screen; with a message, because the
    /// test is skipped.
    pub fn lacks_webgl2(&self) -> bool {
        let draws = "document.createElement('canvas').getContext('webgl2') !== null";
        let lacks = self.session().engine == Engine::Firefox && self.value(draws) == false;
        if lacks {
            eprintln!("skipped: this Firefox has no WebGL2");
        }
        lacks
    }

    /// Lets pages read the clipboard.
    pub fn allow_clipboard(&self) {
        if self.session().engine == Engine::Chromium {
            let names = json!({ "permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"] });
            self.cdp("Browser.grantPermissions", &names);
        }
    }

    /// Loads a URL.
    pub fn go(&self, url: &str) {
        self.call("url", &json!({ "url": url }));
    }

    /// Loads the page of a daemon with a hash, and waits until all points are painted.
    pub fn look(&self, daemon: &Daemon, hash: &str) {
        // A change of the hash alone does not load the page again.
        self.go("about:blank");
        self.go(&daemon.url(&format!("/{hash}")));
        if hash.is_empty() {
            self.click("#flight-points");
        }
        self.ready();
    }

    /// The value of a JavaScript expression; promises are awaited.
    pub fn value(&self, expression: &str) -> Value {
        let script = format!("return (async () => ({expression}))()");
        self.call("execute/sync", &json!({ "script": script, "args": [] }))
    }

    /// Waits until an expression is truthy. Returns its value.
    pub fn until(&self, expression: &str) -> Value {
        until(&format!("the page says {expression}"), || {
            let value = self.value(expression);
            let is_true = match &value {
                Value::Null | Value::Bool(false) => false,
                Value::String(text) => !text.is_empty(),
                _ => true,
            };
            is_true.then_some(value)
        })
    }

    /// Waits until all points in view are painted and counted. Returns the count.
    pub fn ready(&self) -> u64 {
        let words = "document.documentElement.dataset.state === 'ready' && document.documentElement.dataset.count";
        let count = self.until(words);
        count.as_str().expect("text").parse().expect("a number")
    }

    /// The points in view, relative to its middle.
    pub fn in_view(&self) -> Vec<[f64; 2]> {
        let script = "(() => { const all = []; \
            strew.plane.each((layer, x, y) => all.push([x, y])); return all; })()";
        let points = self.value(script);
        let points = points.as_array().expect("a list").iter();
        let number = |point: &Value, i: usize| point[i].as_f64().expect("a number");
        points.map(|p| [number(p, 0), number(p, 1)]).collect()
    }

    /// The hash of the URL.
    pub fn hash(&self) -> String {
        self.value("location.hash").as_str().expect("text").into()
    }

    /// The text of an element.
    pub fn text(&self, selector: &str) -> String {
        let text = self.value(&format!("document.querySelector({selector:?}).textContent"));
        text.as_str().expect("text").into()
    }

    /// The element that a selector matches, as a reference of the protocol.
    fn element(&self, selector: &str) -> Value {
        self.call(
            "element",
            &json!({ "using": "css selector", "value": selector }),
        )
    }

    /// Clicks an element with the mouse; again if the page has replaced it meanwhile.
    pub fn click(&self, selector: &str) {
        until(&format!("{selector} is clicked"), || {
            // Drivers scroll only to what cannot be seen at all.
            self.middle(selector);
            let element = self.element(selector);
            let id = element.as_object().expect("an element").values().next();
            let id = id.and_then(Value::as_str).expect("an element");
            let path = format!("/session/{}/element/{id}/click", self.session().id);
            match self.session().ask("POST", &path, &json!({})) {
                Err(error) if error["error"] == "stale element reference" => None,
                clicked => Some(clicked.expect("clicked")),
            }
        });
    }

    /// Sets the value of a field or a list and fires the events of a change.
    pub fn choose(&self, selector: &str, value: &str) {
        let script = format!(
            "(() => {{ const e = document.querySelector({selector:?}); e.value = {value:?}; \
             e.dispatchEvent(new Event('input')); e.dispatchEvent(new Event('change')); \
             return e.value; }})()"
        );
        assert_eq!(self.value(&script), value, "{selector} takes {value}");
    }

    /// Presses keys, one after another.
    pub fn keys(&self, keys: &[&str]) {
        let pressed: Vec<Value> = keys
            .iter()
            .flat_map(|key| ["keyDown", "keyUp"].map(|kind| json!({ "type": kind, "value": key })))
            .collect();
        let source = json!({ "type": "key", "id": "keys", "actions": pressed });
        self.call("actions", &json!({ "actions": [source] }));
    }

    /// Presses Tab until the element of an id has the focus.
    pub fn tab_to(&self, id: &str) {
        self.seek(id, || self.keys(&[key::TAB]));
    }

    /// Presses Tab with Shift until the element of an id has the focus.
    pub fn tab_back_to(&self, id: &str) {
        let event = |kind: &str, key: &str| json!({ "type": kind, "value": key });
        let actions = [
            event("keyDown", key::SHIFT),
            event("keyDown", key::TAB),
            event("keyUp", key::TAB),
            event("keyUp", key::SHIFT),
        ];
        let source = json!({ "type": "key", "id": "keys", "actions": actions });
        self.seek(id, || {
            drop(self.call("actions", &json!({ "actions": [source] })));
        });
    }

    fn seek(&self, id: &str, step: impl Fn()) {
        for _ in 0..80 {
            if self.value("document.activeElement.id") == id {
                return;
            }
            step();
        }
        panic!("no way by Tab to {id}");
    }

    /// Presses, moves in steps and lifts; `kind` is `mouse` or `touch`.
    fn stroke(&self, kind: &str, from: [i32; 2], by: [i32; 2]) {
        let to =
            |[x, y]: [i32; 2]| json!({ "type": "pointerMove", "x": x, "y": y, "duration": 30 });
        let mut actions = vec![to(from), json!({ "type": "pointerDown", "button": 0 })];
        for step in 1..=4 {
            actions.push(to([from[0] + by[0] * step / 4, from[1] + by[1] * step / 4]));
        }
        actions.push(json!({ "type": "pointerUp", "button": 0 }));
        self.call(
            "actions",
            &json!({ "actions": [{
                "type": "pointer", "id": kind, "parameters": { "pointerType": kind },
                "actions": actions,
            }] }),
        );
    }

    /// Presses with two fingers at once, which stay down until [`release`](Self::release).
    pub fn press_two(&self, first: [i32; 2], second: [i32; 2]) {
        let finger = |id: &str, [x, y]: [i32; 2]| {
            json!({
                "type": "pointer", "id": id, "parameters": { "pointerType": "touch" },
                "actions": [
                    { "type": "pointerMove", "x": x, "y": y, "duration": 0 },
                    { "type": "pointerDown", "button": 0 },
                ],
            })
        };
        let fingers = [finger("one", first), finger("two", second)];
        self.call("actions", &json!({ "actions": fingers }));
    }

    /// Lifts all that is pressed.
    pub fn release(&self) {
        let path = format!("/session/{}/actions", self.session().id);
        self.session().send("DELETE", &path, &json!({}));
    }

    /// Drags with the mouse, in steps.
    pub fn drag(&self, from: [i32; 2], by: [i32; 2]) {
        self.stroke("mouse", from, by);
    }

    /// Drags with a finger, in steps.
    pub fn swipe(&self, from: [i32; 2], by: [i32; 2]) {
        self.stroke("touch", from, by);
    }

    /// The middle of an element, which is scrolled into view.
    pub fn middle(&self, selector: &str) -> [i32; 2] {
        let place = self.value(&format!(
            "(() => {{ const e = document.querySelector({selector:?}); e.scrollIntoView({{ block: 'nearest' }}); \
             const b = e.getBoundingClientRect(); \
             return [b.left + b.width / 2, b.top + b.height / 2].map(Math.round); }})()"
        ));
        serde_json::from_value(place).expect("a place")
    }

    /// Taps an element with a finger.
    pub fn touch(&self, selector: &str) {
        self.tap(self.middle(selector));
    }

    /// Taps with a finger.
    pub fn tap(&self, at: [i32; 2]) {
        self.call(
            "actions",
            &json!({ "actions": [{
                "type": "pointer", "id": "finger", "parameters": { "pointerType": "touch" },
                "actions": [
                    { "type": "pointerMove", "x": at[0], "y": at[1], "duration": 0 },
                    { "type": "pointerDown", "button": 0 },
                    { "type": "pointerUp", "button": 0 },
                ],
            }] }),
        );
    }

    /// Turns the wheel.
    pub fn wheel(&self, at: [i32; 2], by: i32) {
        self.call(
            "actions",
            &json!({ "actions": [{ "type": "wheel", "id": "wheel", "actions": [
                { "type": "scroll", "x": at[0], "y": at[1], "deltaX": 0, "deltaY": by },
            ] }] }),
        );
    }

    /// The errors in the page's console; of Firefox, those of scripts.
    pub fn errors(&self) -> Vec<String> {
        if self.session().engine == Engine::Firefox {
            return logged_errors(&self.session().folder.path().join("log"));
        }
        let log = self.call("se/log", &json!({ "type": "browser" }));
        let entries = log.as_array().expect("a list").iter();
        entries
            .filter(|entry| entry["level"] == "SEVERE")
            .map(|entry| entry["message"].as_str().unwrap_or_default().to_owned())
            .collect()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // What a test left in the middle is of no use to others; of Firefox, one at a time knows its log.
        if std::thread::panicking() || self.session().engine == Engine::Firefox {
            *self.0 = None;
        }
    }
}
