#!/usr/bin/env python3
"""How soon the page at / shows points, and how evenly it moves, in headless Chromium.

    python3 benches/page.py [--program target/release/strew] [--rounds 3]

Starts a daemon of its own, and for each network and each round a browser with an empty cache, driven by chromedriver.
Prints, as medians of the rounds, the first paint, the first points, how many requests and bytes came before the page
was at rest; then the times between frames of a drag over 100,000 points. Needs chromium and chromedriver; a machine
without a graphics processor paints with the processor, which is the slower way.
"""

import argparse
import contextlib
import json
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request

# Name, round trip in ms, bits per second (0 for no limit), slowdown of the processor, width and height.
NETWORKS = [
    ("local", 0, 0, 1, 1440, 900),
    ("100 ms, 10 Mbit/s", 100, 10e6, 1, 1440, 900),
    ("phone: 150 ms, 1.6 Mbit/s, processor / 4", 150, 1.6e6, 4, 390, 844),
]
READY = "document.documentElement.dataset.state === 'ready' && document.documentElement.dataset.count"
LOADED = """(() => {
  const at = (name) => performance.getEntriesByName(name)[0]?.startTime;
  const all = performance.getEntriesByType('resource');
  const before = all.filter((one) => one.responseEnd <= at('points'));
  const sum = (list) => list.reduce((bytes, one) => bytes + one.transferSize, 0);
  return [at('first-contentful-paint'), at('points'), before.length + 1, all.length + 1, sum(all)];
})()"""
FRAMES = """new Promise((resolve) => {
  const gaps = [];
  let last = 0, n = 0;
  const step = (now) => {
    if (last) gaps.push(now - last);
    last = now;
    n += 1;
    const turn = (n * 2 * Math.PI) / 240;
    strew.plane.drag(9 * Math.cos(turn), 6 * Math.sin(turn));
    if (n < 900) requestAnimationFrame(step); else resolve(gaps);
  };
  requestAnimationFrame(step);
})"""


@contextlib.contextmanager
def process(command, pattern, stream):
    """A process, once it has printed a port."""
    streams = {stream: subprocess.PIPE, "stdout" if stream == "stderr" else "stderr": subprocess.DEVNULL}
    child = subprocess.Popen(command, text=True, **streams)
    try:
        for line in getattr(child, stream):
            if found := re.search(pattern, line):
                yield int(found[1])
                return
        sys.exit(f"{command[0]} does not start")
    finally:
        child.kill()
        child.wait()


class Browser:
    """A browser by the WebDriver protocol."""

    def __init__(self, port, profile):
        self.root = f"http://127.0.0.1:{port}/session"
        options = {
            "binary": shutil.which("chromium"),
            "args": ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}"],
        }
        wanted = {"capabilities": {"alwaysMatch": {"goog:chromeOptions": options}}}
        self.root += "/" + self.call("", wanted)["sessionId"]
        self.call("/timeouts", {"script": 120_000})

    def call(self, path, body):
        request = urllib.request.Request(self.root + path, json.dumps(body).encode(), {"content-type": "application/json"})
        with urllib.request.urlopen(request, timeout=180) as answer:
            return json.load(answer)["value"]

    def cdp(self, name, **parameters):
        return self.call("/goog/cdp/execute", {"cmd": name, "params": parameters})

    def value(self, expression):
        script = f"return (async () => ({expression}))()"
        return self.call("/execute/sync", {"script": script, "args": []})

    def until(self, expression):
        end = time.monotonic() + 120
        while not self.value(expression):
            if time.monotonic() > end:
                sys.exit(f"waited in vain for {expression}")
            time.sleep(0.05)

    def close(self):
        request = urllib.request.Request(self.root, method="DELETE")
        urllib.request.urlopen(request, timeout=60).close()


@contextlib.contextmanager
def browsing(driver):
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(driver, profile)
        try:
            yield browser
        finally:
            browser.close()


def loaded(driver, page, latency, bits, slowdown, width, height):
    """What a first load takes: first paint, first points, requests before them, all requests, bytes."""
    with browsing(driver) as browser:
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        browser.cdp("Emulation.setDeviceMetricsOverride", **size)
        browser.cdp("Emulation.setCPUThrottlingRate", rate=slowdown)
        browser.cdp("Network.enable")
        speed = bits / 8 or -1
        conditions = {"offline": False, "latency": latency, "downloadThroughput": speed, "uploadThroughput": speed}
        browser.cdp("Network.emulateNetworkConditions", **conditions)
        browser.call("/url", {"url": page})
        browser.until(READY)
        return browser.value(LOADED)


def frames(driver, page):
    """The times between frames of a drag over 100,000 points, in order."""
    with browsing(driver) as browser:
        size = {"width": 1280, "height": 800, "deviceScaleFactor": 1, "mobile": False}
        browser.cdp("Emulation.setDeviceMetricsOverride", **size)
        browser.call("/url", {"url": page + "#at=0,0&span=293"})
        browser.until(READY)
        return sorted(browser.value(FRAMES))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="target/release/strew")
    parser.add_argument("--rounds", type=int, default=3)
    chosen = parser.parse_args()
    if not (shutil.which("chromium") and shutil.which("chromedriver")):
        sys.exit("chromium and chromedriver are needed")
    serve = [chosen.program, "serve", "--listen", "127.0.0.1:0"]
    with process(serve, r"listening on http://127\.0\.0\.1:(\d+)", "stdout") as port, \
            process(["chromedriver", "--port=0"], r"successfully on port (\d+)", "stdout") as driver:
        page = f"http://127.0.0.1:{port}/"
        print("| network | first paint | first points | requests before them | requests | kB |")
        print("|---|---|---|---|---|---|")
        for name, *how in NETWORKS:
            rounds = [loaded(driver, page, *how) for _ in range(chosen.rounds)]
            paint, points, before, requests, size = map(statistics.median, zip(*rounds))
            print(f"| {name} | {paint:.0f} ms | {points:.0f} ms | {before:.0f} | {requests:.0f} | {size / 1e3:.0f} |", flush=True)
        gaps = frames(driver, page)
        at = lambda share: gaps[round(share * (len(gaps) - 1))]
        over = sum(gap > 100 for gap in gaps)
        print(f"\nframes of a drag over 100,000 points: {at(0.5):.1f} ms apart (median), {at(0.95):.1f} (95 %), "
              f"{at(0.99):.1f} (99 %), {at(1):.1f} (most); {over} of {len(gaps)} over 100 ms")


if __name__ == "__main__":
    main()
