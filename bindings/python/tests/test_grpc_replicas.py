"""The balancing of gRPC's own clients, as docs/operations.md shows it. Skipped without grpcio."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest
from conftest import ROOT, daemon
from test_daemon import answered

grpc = pytest.importorskip("grpc", reason="grpcio is not installed")

METHOD = "/strew.v1.PointService/ListProfiles"


def channel(urls: list[str]) -> Any:
    """The channel of the documentation, to these addresses."""
    text = (ROOT / "docs/operations.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.S)
    [code] = [block for block in blocks if "insecure_channel" in block]
    addresses = ",".join(url.removeprefix("http://") for url in urls)
    names: dict[str, Any] = {"grpc": grpc, "json": json}
    code = code.replace("dns:///strew-headless:8080", f"ipv4:{addresses}")
    # A list of addresses is no authority, which a name would be. On loopback the daemon answers for this one.
    exec(code.replace("options=[", 'options=[("grpc.default_authority", "localhost"), '), names)
    return names["channel"]


def test_calls_take_turns_and_none_fails_while_replicas_die_and_stop() -> None:
    running = [daemon() for _ in range(3)]
    try:
        take_turns(running)
    finally:
        for process, _ in running:
            process.kill()
            process.wait()


def take_turns(running: list[Any]) -> None:
    urls = [url for _, url in running]
    with channel(urls) as there:
        call = there.unary_unary(METHOD, request_serializer=None, response_deserializer=None)
        # The first that is ready answers alone until the others are.
        for _ in range(1000):
            call(b"", timeout=20, wait_for_ready=True)
            before = [answered(url, "ListProfiles") for url in urls]
            if min(before) > 0:
                break
        for _ in range(60):
            assert len(call(b"", timeout=20, wait_for_ready=True)) > 100
        counts = [answered(url, "ListProfiles") - first for url, first in zip(urls, before)]
        assert sum(counts) == 60 and min(counts) >= 5, counts
        running[0][0].kill()
        for _ in range(30):
            call(b"", timeout=20)
        # One that stops reports to be no longer healthy before it closes.
        running[1][0].terminate()
        for _ in range(30):
            call(b"", timeout=20)
