//! The browsers that the pages are tested in, and the drivers that start them.

use std::{
    fs::File,
    path::{Path, PathBuf},
    process::{Child, Command},
};

use serde_json::{Value, json};
use strew_testkit::wait::until;

use super::clients;

/// The text that a driver writes before the number of its port.
const LISTENING: [&str; 2] = ["successfully on port ", "Listening on 127.0.0.1:"];

/// Firefox's window is never narrower than 450 pixels, a phone is.
const STYLE: &str =
    "*|*:root, body, #navigator-toolbox, #browser, #appcontent { min-width: 0 !important }";

/// A browser by its engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// Chromium, by ChromeDriver.
    Chromium,
    /// Firefox, by geckodriver.
    Firefox,
}

impl Engine {
    /// The one that `STREW_TEST_BROWSER` names; Chromium without it.
    pub fn chosen() -> Self {
        match std::env::var("STREW_TEST_BROWSER").as_deref() {
            Ok("firefox") => Self::Firefox,
            Ok("chromium") | Err(_) => Self::Chromium,
            Ok(other) => panic!("STREW_TEST_BROWSER is {other}: chromium or firefox is needed"),
        }
    }

    /// The driver and the browser, where both are installed.
    pub fn programs(self) -> Option<(PathBuf, PathBuf)> {
        match self {
            Self::Chromium => Some((clients::find("chromedriver")?, clients::find("chromium")?)),
            Self::Firefox => Some((clients::find("geckodriver")?, clients::find("firefox-esr")?)),
        }
    }

    /// Starts a driver, whose output and the browser's go to `log`. Returns it with its port.
    pub fn driver(self, program: &Path, log: &Path) -> (Child, u16) {
        // A driver ends if its port is taken before it listens; then another one is started.
        until("the driver listens", || self.listening(program, log))
    }

    fn listening(self, program: &Path, log: &Path) -> Option<(Child, u16)> {
        let file = File::create(log).expect("a log");
        let mut command = Command::new(program);
        command.arg("--port=0");
        if self == Self::Firefox {
            command.arg("--allow-system-access");
        }
        let mut driver = command
            .stdout(file.try_clone().expect("a log"))
            .stderr(file)
            .spawn()
            .expect("the driver runs");
        let port = until("the driver says its port or ends", || {
            let said = std::fs::read(log).expect("a log");
            let port = port_of(&String::from_utf8_lossy(&said));
            let has_ended = driver.try_wait().expect("a state").is_some();
            (port.is_some() || has_ended).then_some(port)
        });
        Some((driver, port?))
    }

    /// The capabilities of a session; `folder` is the browser's own, `downloads` is in it.
    pub fn capabilities(self, browser: &Path, folder: &Path) -> Value {
        let within = |name: &str| folder.join(name).display().to_string();
        match self {
            Self::Chromium => json!({
                "goog:chromeOptions": { "binary": browser, "args": [
                    "--headless", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--disable-quic",
                    "--no-first-run", "--disable-background-networking", "--disable-component-update",
                    "--disable-sync", format!("--user-data-dir={}", within("profile")),
                ] },
                "goog:loggingPrefs": { "browser": "ALL" },
            }),
            Self::Firefox => {
                std::fs::create_dir_all(folder.join("profile/chrome")).expect("a folder");
                std::fs::write(folder.join("profile/chrome/userChrome.css"), STYLE)
                    .expect("a style");
                json!({ "moz:firefoxOptions": {
                    "binary": browser,
                    "args": ["-headless", "--profile", within("profile")],
                    "prefs": {
                        "toolkit.legacyUserProfileCustomizations.stylesheets": true,
                        "browser.dom.window.dump.enabled": true,
                        "dom.events.testing.asyncClipboard": true,
                        "browser.download.folderList": 2,
                        "browser.download.dir": within("downloads"),
                        "browser.helperApps.neverAsk.saveToDisk": "application/json,application/octet-stream,text/csv",
                    },
                } })
            }
        }
    }
}

/// The port that a driver prints, once its line is whole.
fn port_of(said: &str) -> Option<u16> {
    let lines = said
        .split_inclusive('\n')
        .filter(|line| line.ends_with('\n'));
    lines.map(str::trim_end).find_map(|line| {
        let (_, port) = LISTENING.iter().find_map(|words| line.split_once(words))?;
        port.trim_end_matches('.').parse().ok()
    })
}

/// The errors of scripts in the pages that Firefox has logged.
pub fn logged_errors(log: &Path) -> Vec<String> {
    let said = std::fs::read(log).expect("a log");
    let said = String::from_utf8_lossy(&said);
    said.lines()
        .filter(|line| line.contains("JavaScript error: http://"))
        .map(str::to_owned)
        .collect()
}
