//! A real browser: headless Chromium, driven through ChromeDriver by the W3C WebDriver protocol,
//! which is JSON over HTTP.

use std::{
    io::{BufRead as _, BufReader},
    net::SocketAddr,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::{Mutex, MutexGuard, PoisonError},
};

use serde_json::{Value, json};
use strew_testkit::{http1, wait::until};

use super::{clients, daemon::Daemon};

/// Held while a browser runs: one at a time, because nothing else that tests start is as heavy.
static ALONE: Mutex<()> = Mutex::new(());

/// A browser with one window; closed when dropped.
pub struct Browser {
    driver: Child,
    address: SocketAddr,
    session: String,
    profile: tempfile::TempDir,
    _alone: MutexGuard<'static, ()>,
}

/// Starts a driver. Returns it with its port, or `None` if it ends at once.
fn listening(program: &Path) -> Option<(Child, u16)> {
    let mut driver = Command::new(program)
        .arg("--port=0")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("chromedriver runs");
    let output = BufReader::new(driver.stdout.take().expect("piped"));
    let port = output.lines().map_while(Result::ok).find_map(|line| {
        let (_, port) = line.split_once("successfully on port ")?;
        port.trim_end_matches('.').parse().ok()
    });
    if port.is_none() {
        let _ = driver.wait();
    }
    Some((driver, port?))
}

/// A daemon with the built-in tables, and a browser. `None`, with a message, where no browser is
/// installed.
pub fn looking(width: u32, height: u32) -> Option<(Daemon, Browser)> {
    let browser = Browser::start(width, height)?;
    Some((Daemon::built_in(), browser))
}

impl Browser {
    fn start(width: u32, height: u32) -> Option<Self> {
        let (driver, chromium) = (clients::find("chromedriver")?, clients::find("chromium")?);
        let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        // A driver ends if its port is taken before it listens; then another one is started.
        let (driver, port) = until("chromedriver listens", || listening(&driver));
        let profile = tempfile::tempdir().expect("a temporary folder");
        let mut browser = Self {
            driver,
            address: ([127, 0, 0, 1], port).into(),
            session: String::new(),
            profile,
            _alone: alone,
        };
        browser.open(&chromium, width, height);
        Some(browser)
    }

    fn open(&mut self, chromium: &Path, width: u32, height: u32) {
        let folder = |name: &str| self.profile.path().join(name).display().to_string();
        let arguments = [
            "--headless".into(),
            "--no-sandbox".into(),
            "--disable-gpu".into(),
            "--use-angle=swiftshader".into(),
            "--disable-quic".into(),
            "--no-first-run".into(),
            "--disable-background-networking".into(),
            "--disable-component-update".into(),
            "--disable-sync".into(),
            format!("--user-data-dir={}", folder("profile")),
        ];
        let options = json!({ "binary": chromium, "args": arguments });
        let wanted = json!({ "capabilities": { "alwaysMatch": {
            "goog:chromeOptions": options,
            "goog:loggingPrefs": { "browser": "ALL" },
        } } });
        let answer = self.send("POST", "/session", &wanted);
        self.session = answer["sessionId"].as_str().expect("a session").into();
        self.resize(width, height);
        self.cdp(
            "Browser.setDownloadBehavior",
            &json!({ "behavior": "allow", "downloadPath": folder("downloads") }),
        );
        std::fs::create_dir_all(folder("downloads")).expect("a folder");
    }

    /// The folder of downloads.
    pub fn downloads(&self) -> PathBuf {
        self.profile.path().join("downloads")
    }

    fn send(&self, method: &str, path: &str, body: &Value) -> Value {
        let response = match method {
            "POST" => http1::open_post(self.address, path, &[], body.to_string().as_bytes()),
            _ => http1::open(self.address, method, path, &[]),
        };
        let status = response.status;
        let bytes = response.body().expect("a whole answer");
        let mut answer: Value = serde_json::from_slice(&bytes).expect("JSON");
        let value = answer["value"].take();
        assert_eq!(status, 200, "{method} {path} {body}: {value}");
        value
    }

    fn call(&self, path: &str, body: &Value) -> Value {
        self.send("POST", &format!("/session/{}/{path}", self.session), body)
    }

    /// Sends a command of the Chrome DevTools Protocol.
    pub fn cdp(&self, name: &str, parameters: &Value) -> Value {
        self.call(
            "goog/cdp/execute",
            &json!({ "cmd": name, "params": parameters }),
        )
    }

    /// Sets the inner size of the window, in CSS pixels.
    pub fn resize(&self, width: u32, height: u32) {
        let size =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.cdp("Emulation.setDeviceMetricsOverride", &size);
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

    /// Clicks an element with the mouse.
    pub fn click(&self, selector: &str) {
        let element = self.element(selector);
        let id = element.as_object().expect("an element").values().next();
        let id = id.and_then(Value::as_str).expect("an element");
        self.call(&format!("element/{id}/click"), &json!({}));
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

    /// Drags with the mouse, in steps.
    pub fn drag(&self, from: [i32; 2], by: [i32; 2]) {
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
                "type": "pointer", "id": "mouse", "parameters": { "pointerType": "mouse" },
                "actions": actions,
            }] }),
        );
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

    /// The errors in the page's console.
    pub fn errors(&self) -> Vec<String> {
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
        if !self.session.is_empty() && !std::thread::panicking() {
            self.send("DELETE", &format!("/session/{}", self.session), &json!({}));
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}
