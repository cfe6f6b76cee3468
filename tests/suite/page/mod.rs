//! Page.
mod controls;
mod export;
mod view;
