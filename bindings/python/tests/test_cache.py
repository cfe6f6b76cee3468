"""A client behind nginx as a cache, with the settings of ``deploy/nginx``. Skipped without nginx."""

from __future__ import annotations

import re
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from conftest import ROOT
from queries import random_query
from test_daemon import answered, same

import strew

NGINX = shutil.which("nginx")
pytestmark = pytest.mark.skipif(NGINX is None, reason="nginx is not installed")


@contextmanager
def cache(folder: Path, urls: list[str]) -> Iterator[str]:
    """A cache before some daemons, and its address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    settings = (ROOT / "deploy/nginx/cache.conf").read_text()
    settings = settings.replace("/var/cache/nginx", str(folder)).replace("listen 80;", f"listen {address};")
    [server] = re.findall(r"server strew:8080[^;]*;", settings)
    servers = [server.replace("strew:8080", url.removeprefix("http://")) for url in urls]
    settings = settings.replace(server, " ".join(servers))
    names = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    paths = " ".join(f"{name}_temp_path {folder}/{name};" for name in names)
    (folder / "nginx.conf").write_text(
        f"daemon off; master_process off; pid {folder}/pid; error_log {folder}/error.log;\n"
        f"events {{ worker_connections 256; }}\nhttp {{ access_log off; {paths}\n{settings} }}\n"
    )
    assert NGINX is not None
    process = subprocess.Popen([NGINX, "-p", folder, "-c", folder / "nginx.conf"])
    try:
        host, port = address.split(":")
        for _ in range(6000):
            with socket.socket() as there:
                if there.connect_ex((host, int(port))) == 0:
                    break
            time.sleep(0.01)
        yield f"http://{address}"
    finally:
        process.kill()
        process.wait()


def test_the_points_of_queries_pass_and_what_is_requested_again_is_kept(tmp_path: Path, url: str) -> None:
    with cache(tmp_path, [url]) as address:
        there = strew.connect(address)
        # Long queries have one path, and differ by their bodies.
        compared = 0
        for seed in range(40):
            query = random_query(seed)
            here = strew.query(query)
            try:
                here.columns()
            except strew.StrewError:
                continue
            for _ in range(2):
                same(here, there.query(query))
            compared += len(here) > 0
        assert compared > 20
        # Short queries have addresses of their own, which the cache keeps.
        box = {"bbox": (0, 0, 9, 9), "spacing": 1, "seed": 77}
        before = answered(url, "/v1/points")
        for _ in range(3):
            same(strew.points(**box), there.points(**box))
        assert answered(url, "/v1/points") == before + 1
        points = [source.points(spacing=1, seed=5) for source in (strew, there)]
        before = answered(url, "/v1/nearest")
        for _ in range(3):
            one, other = [found.nearest((3, 4), k=5) for found in points]
            assert one == other
        assert answered(url, "/v1/nearest") == before + 1
