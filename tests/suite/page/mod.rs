//! The pages in a browser without a window: what `/` shows and how it moves (view), its first seconds and how it fits its
//! window (first), its first screen (start) and the path of a first visit (visit), what can be set (controls, kinds, fields,
//! paint), what is wrong and how it is said (faults, links, busy), the card of a point (card), the
//! requests and files it offers (export), that everybody can use it (everyone, axe), and that nothing moves away while it
//! loads (shift); and the pages `/compare`, `/docs`, `/how`, `/space` and `/walk`. The browser is Chromium,
//! or that of `STREW_TEST_BROWSER`; the tests are skipped where it or its driver is not installed.

mod axe;
mod busy;
mod card;
mod compare;
mod controls;
mod docs;
mod everyone;
mod export;
mod faults;
mod fields;
mod first;
mod how;
mod kinds;
mod links;
mod paint;
mod shift;
mod space;
mod start;
mod view;
mod visit;
mod walk;
