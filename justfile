# The commands of this repository. `just` lists them.

default:
    @just --list

# Start the daemon on its embedded tables.
serve *args:
    cargo run --release -- serve {{args}}

# All tests of the whole workspace.
test:
    cargo test --workspace

# What continuous integration runs.
ci:
    .ci/run

# Format and lint.
lint:
    cargo fmt --all
    cargo clippy --workspace --all-targets -- -D warnings

# The lines of each part, beside the most that it may have.
lines:
    cargo test --workspace -q --test tidy -- --nocapture no_part_outgrows_its_ceiling

# The benches of the library: filling boxes, beside the published row scanner and a plain fill; regions; lookups.
bench:
    cargo bench -p strew-core

# The benches still run; how fast they are is not looked at.
bench-check:
    cargo test --workspace --bench '*' --locked --quiet -- --quick | grep --line-buffered ^==

# What requests cost a daemon as images have it: instructions and allocations of each, beside those that are kept (needs
# valgrind).
instructions *args:
    cargo build --locked --profile profiling --features jemalloc
    cargo build --locked --profile profiling -p strew-core --example counted
    benches/instructions.py target/profiling/strew {{args}}

# The unsafe code of the kernel under AddressSanitizer, with every instruction set of this machine, and
# under valgrind, which supports AVX2. (Miri needs a nightly toolchain and lacks most vector instructions.)
sanitize:
    RUSTC_BOOTSTRAP=1 RUSTFLAGS=-Zsanitizer=address CARGO_TARGET_DIR=target/sanitize \
        cargo test -p strew-core --lib --target x86_64-unknown-linux-gnu
    CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUNNER="valgrind -q --error-exitcode=9" \
        cargo test -p strew-core --lib kernel::

# Mixed queries over REST and gRPC with injected faults, every answer checked: `just soak 1800`.
soak seconds="300" *args:
    cargo test --release --test soak -- --seconds {{seconds}} {{args}}

# Fuzz one subject of fuzz/subjects for some seconds (needs `cargo install cargo-fuzz` and a C++
# compiler; the switch lets a stable toolchain instrument). What it finds is in fuzz/artifacts: make
# it smaller with `cargo fuzz tmin`, and keep it in fuzz/regressions, where the tests run it. Keep
# repetition as text, in a file named `….repeat`, which tests/fuzz/main.rs describes and expands.
fuzz subject seconds="3600":
    mkdir -p fuzz/corpus/{{subject}}
    cd fuzz && RUSTC_BOOTSTRAP=1 cargo fuzz run -O {{subject}} corpus/{{subject}} seeds/{{subject}} \
        -- -max_total_time={{seconds}} -timeout=20 -max_len=2048

# The plugin for Bevy, which is a workspace of its own.
bevy:
    .ci/bevy

# The npm package: its WebAssembly, beside the real daemon in Node and in Chromium, its types, and packed, in bundlers.
js:
    .ci/js

# The npm package as it was built last, in new projects of bundlers (vite, webpack, next, esbuild; by default all).
bundlers *names:
    node bindings/js/test/bundlers.mjs {{names}}

# The types of the pages' modules, by TypeScript.
types:
    .ci/page

# The tests of the pages in Firefox instead of Chromium: Debian's firefox-esr, and `cargo install geckodriver`. Half an hour on
# two busy cores.
firefox:
    STREW_TEST_BROWSER=firefox cargo test --locked --test suite -- page:: --test-threads 1

# The pictures that previews of links and the cards of the first page show, drawn in Chromium.
pictures:
    STREW_TEST_PICTURES=1 cargo test --locked --test suite -- page::walk::pictures page::start::pictures

# The extension for Blender and its sample; Blender's module of 370 MB comes from PyPI for one version of Python.
blender:
    python3 -m venv target/blender
    target/blender/bin/pip install -q bpy
    STREW_TEST_BLENDER=target/blender/bin/python cargo test --locked --test suite -- docs::samples

# The contract with its fuzzer at length: 25 examples, and every edge of every schema (about ten minutes).
contract:
    STREW_TEST_WHOLE_CONTRACT=1 cargo test --locked --test suite -- docs::api_contract --nocapture

# The tests of exported spans, which need the feature that images are built with.
otlp:
    cargo clippy --locked --features jemalloc,otlp -- -D warnings
    cargo test --locked --features otlp --test suite -- ops::spans

# The library without the standard library.
no-std:
    cargo build -p strew-core --no-default-features

# The library on arm64 (under qemu) and WebAssembly (in Node), as far as these are installed.
targets:
    .ci/targets

# Everything that a release has, made and used in empty environments; publishes nothing. See docs/releasing.md.
release folder="dist":
    deploy/release {{folder}}

# A rehearsal of `just release`: all parts of it that are not made of these sources yet, or some: `just release-check npm c`.
release-check *parts:
    deploy/release target/release-check {{parts}}

# The walks of 1,000 players through a world, with a cache and without: `just caches target/release/strew [--cache varnish]`.
caches program *args:
    benches/caches.py {{program}} {{args}}

# The data source of Spark on a cluster of two workers, one of which is killed.
spark *args:
    .ci/spark {{args}}

# The data source of Ray on two workers, of which some are killed, and the example of Dask.
ray *args:
    .ci/ray {{args}}

# The files of `deploy/` by helm, kubeconform, promtool, HAProxy, nginx and Varnish.
deploy-check:
    .ci/deploy

# Images, the compose file and a stack of replicas in an engine of its own (Debian's docker.io, as root on Linux), killed,
# replaced, attacked and cut off: `just containers [FOLDER of deploy/static] [TEST]`. About half an hour.
containers *args:
    .ci/containers {{args}}

# Licenses, bans and sources of all dependencies; the advisories need a network.
deny:
    cargo deny --locked --offline check licenses bans sources
    cargo deny --locked check advisories || echo "the advisories could not be checked"

# Measure the shipped tables again: all figures and pictures of docs/quality.md.
quality:
    cargo build --release
    docs/quality/measure

# Make the shipped tables again, bit for bit.
tables:
    cargo build --release
    for job in \
        "blue (5-sqrt(3))/2 49" "blue sqrt(3) 49" "blue (1+sqrt(5))/2 49" \
        "blue (5-sqrt(3))/2 100" "blue (5-sqrt(3))/2 200" \
        "spaced (5-sqrt(3))/2 49" "spaced sqrt(3) 49" "spaced (1+sqrt(5))/2 49" \
        "spaced (5-sqrt(3))/2 100" "spaced (5-sqrt(3))/2 200" \
        "sharp (5-sqrt(3))/2 49" "step (5-sqrt(3))/2 49" "green (5-sqrt(3))/2 49" "pink (5-sqrt(3))/2 49" "single-peak (5-sqrt(3))/2 49" \
        "lloyd (5-sqrt(3))/2 49" "pattern (5-sqrt(3))/2 49"; do \
        set -- $job; \
        target/release/strew forge --profile "$1" --alpha "$2" --radius "$3" \
            --out-dir crates/catalog/tables --force || exit 1; \
    done
    mv crates/catalog/tables/blue-5-sqrt3-over-2-m.strew crates/core/tables/
