# The commands of this repository. `just` lists them.

default:
    @just --list

# Start the daemon on its embedded tables.
serve *args:
    cargo run --release -- serve {{args}}

# All tests of the whole workspace.
test:
    cargo test

# What continuous integration runs.
ci:
    .ci/run

# Format and lint.
lint:
    cargo fmt --all
    cargo clippy --workspace --all-targets -- -D warnings

# How fast a box is filled, beside the published row scanner and a plain fill.
bench:
    cargo bench -p strew-core --bench kernel

# The library without the standard library.
no-std:
    cargo build -p strew-core --no-default-features

# Make the shipped tables again, bit for bit.
tables:
    for alpha in "(5-sqrt(3))/2" "sqrt(3)" "(1+sqrt(5))/2"; do \
        cargo run --release -- forge --profile blue --alpha "$alpha" --out-dir tables --force || exit 1; \
    done
