//! The pages in a browser without a window: what `/` shows and how it moves (view), the first screen (start) and the
//! path of a first visit (visit), what can be set (controls, fields, paint), what is wrong and how it is said (faults,
//! links), the card of a point (card), the tab How it works (works), the requests and files it offers (export), and
//! that everybody can use it (everyone, axe); and the pages `/compare`, `/docs`, `/how`, `/space`, `/tile` and `/walk`.
//! The browser is Chromium, or that of `STREW_TEST_BROWSER`; the tests are skipped where it or its driver is not
//! installed.

mod axe;
mod card;
mod compare;
mod controls;
mod docs;
mod everyone;
mod export;
mod faults;
mod fields;
mod how;
mod links;
mod paint;
mod space;
mod start;
mod tile;
mod view;
mod visit;
mod walk;
mod works;
