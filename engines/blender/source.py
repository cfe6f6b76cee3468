"""Points as arrays, from the Python package or from a daemon. Nothing here knows Blender."""

import importlib.util
import io
import json
import urllib.error
import urllib.parse
import urllib.request

import numpy as np

#: The seconds that a daemon may pause.
TIMEOUT = 60


class Refused(Exception):
    """Why there are no points, in words for the panel."""


def has_package():
    """Whether points are made here, without a daemon."""
    return importlib.util.find_spec("strew") is not None and importlib.util.find_spec("strew._strew") is not None


def is_here(url):
    """Whether an address is of this machine."""
    return urllib.parse.urlsplit(url).hostname in ("localhost", "127.0.0.1", "::1")


def points(query, most, url=None):
    """The columns of a query, a body of `POST /v1/points:query`: name → numbers, and the names of variants."""
    return _here(query, most) if url is None else _there(query, most, url)


def _check(count, most):
    if count > most:
        raise Refused(f"{count} points are more than At Most, {most}: a wider spacing, or raise it")


def _here(query, most):
    import strew

    try:
        found = strew.query(query)
        _check(found.count(), most)
        columns = {"x": found.x, "y": found.y}
        columns.update((name, found[name]) for name in found.names if name != "variant")
        names = []
        if "variant" in found.names:
            columns["variant"], names = found.codes("variant")
    except strew.StrewError as error:
        raise Refused(str(error)) from None
    return columns, names


def _there(query, most, url):
    body = json.dumps({**query, "format": "npy"}).encode()
    headers = {"content-type": "application/json"}
    try:
        request = urllib.request.Request(f"{url.rstrip('/')}/v1/points:query", body, headers)
        with urllib.request.urlopen(request, timeout=TIMEOUT) as answer:
            _check(int(answer.headers["strew-count"]), most)
            described = json.loads(answer.headers["strew-columns"])
            rows = np.load(io.BytesIO(answer.read()))
    except urllib.error.HTTPError as error:
        raise Refused(_detail(error.read()) or f"{url} answers {error.code}: is it a Strew daemon?") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "reason", error)
        raise Refused(f"{url} does not answer ({reason}): start `strew serve`, or name another address") from None
    except (KeyError, TypeError):
        raise Refused(f"{url} is no Strew daemon") from None
    columns = {column["name"]: rows[:, i] for i, column in enumerate(described)}
    names = [column["names"] for column in described if column.get("names")]
    return columns, names[0] if names else []


def _detail(content):
    try:
        return json.loads(content)["detail"]
    except (ValueError, KeyError, TypeError):
        return None
