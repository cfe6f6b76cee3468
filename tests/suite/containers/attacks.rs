//! The attacks of `benches/attacks.py` on a container of little memory, which the kernel does not kill.

use std::process::Command;

use super::docker::{self, IMAGE};

#[test]
fn attacks_do_not_exhaust_a_small_container() {
    if !docker::has(IMAGE) {
        return;
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/attacks.py");
    let attacked = Command::new("python3")
        .env(
            "DOCKER_HOST",
            std::env::var("STREW_TEST_DOCKER").expect("an engine"),
        )
        .args([script, "--container", "256m", IMAGE])
        .status()
        .expect("Python runs");
    // It ends with an error if the container was killed or started again.
    assert!(attacked.success(), "{attacked}");
}
