//! Images in an engine: `.ci/containers` starts one, makes the images and names its socket in `STREW_TEST_DOCKER`.
//! Without it the tests are skipped with a message.
//!
//! `image` needs the daemon's image alone; the other tests need those of HAProxy and Prometheus, or the Compose plugin,
//! and skip what is missing.

mod attacks;
mod compose;
mod docker;
mod image;
mod load;
mod networks;
mod stack;
