//! The pages in headless Chromium: what `/` shows and how it moves (view), the first screen (start), what can be set
//! (controls, fields, paint), what is wrong and how it is said (faults, links), the card of a point (card), the tab How it
//! works (works), the requests and files it offers (export), and that everybody can use it (everyone); and the pages
//! `/compare`, `/docs` and `/walk`. The tests are skipped where Chromium and ChromeDriver are not installed.

mod card;
mod compare;
mod controls;
mod docs;
mod everyone;
mod export;
mod faults;
mod fields;
mod links;
mod paint;
mod start;
mod tile;
mod view;
mod walk;
mod works;
