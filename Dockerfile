# syntax=docker/dockerfile:1
# The daemon in a small image: built on Rust's Debian image, run on a distroless one.
#
#   docker build -t strew --build-arg REVISION="$(git rev-parse HEAD)" \
#       --build-arg SOURCE_DATE_EPOCH="$(git log -1 --format=%ct)" .
#   docker run --rm -p 8080:8080 --read-only --cap-drop ALL strew
#
# Without the registries these come from, see deploy/Dockerfile.scratch.
# For the same bits every time, name the images by their digests (RUST_IMAGE=rust@sha256:…).
ARG RUST_IMAGE=rust:1-slim-bookworm
ARG RUN_IMAGE=gcr.io/distroless/cc-debian12:nonroot

FROM ${RUST_IMAGE} AS build
ARG REVISION=unknown
# Nothing in the program depends on when or in which folder it was built.
ARG SOURCE_DATE_EPOCH=0
ENV STREW_BUILD_REVISION=${REVISION} \
    SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH} \
    CARGO_INCREMENTAL=0 \
    RUSTFLAGS="--remap-path-prefix=/src=strew --remap-path-prefix=/usr/local/cargo=cargo"
# The allocator's build needs make.
RUN apt-get update \
    && apt-get install -y --no-install-recommends make \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /src
COPY . .
RUN --mount=type=cache,target=/usr/local/cargo/registry \
    --mount=type=cache,target=/src/target \
    cargo build --release --locked --bin strew --features jemalloc,otlp \
    && cp target/release/strew /strew

FROM ${RUN_IMAGE}
ARG VERSION=0.1.0
ARG REVISION=unknown
LABEL org.opencontainers.image.title="strew" \
      org.opencontainers.image.description="Points of any region of an unbounded plane, by REST and gRPC" \
      org.opencontainers.image.version="${VERSION}" \
      org.opencontainers.image.revision="${REVISION}" \
      org.opencontainers.image.source="https://github.com/strew/strew" \
      org.opencontainers.image.licenses="MIT OR Apache-2.0"
COPY --from=build /strew /usr/local/bin/strew
COPY LICENSE-APACHE LICENSE-MIT /usr/share/doc/strew/
# More settings come from STREW_… variables or a mounted file (`serve --config FILE`); tables from a mounted folder.
# Nothing is ever written, so the root file system may be read-only.
COPY config/container.toml /etc/strew/container.toml
ENV STREW_CONFIG=/etc/strew/container.toml
USER 65532:65532
EXPOSE 8080
STOPSIGNAL SIGTERM
# The first check comes after one interval: a daemon is known to be healthy about a second after its start.
HEALTHCHECK --interval=1s --timeout=3s --start-period=30s --retries=10 \
    CMD ["/usr/local/bin/strew", "probe", "--ready"]
ENTRYPOINT ["/usr/local/bin/strew"]
CMD ["serve"]
