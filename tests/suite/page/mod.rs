//! The page at `/` in headless Chromium: what it shows and how it moves (view), what can be set
//! (controls), the tab How it works (works), and the requests and files it offers (export); and the page `/compare`. The
//! tests are skipped where Chromium and ChromeDriver are not installed.

mod compare;
mod controls;
mod export;
mod fields;
mod view;
mod works;
