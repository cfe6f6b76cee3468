"""The native part of the package, which makes points in this process. The client of daemons lacks it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import _strew


def native() -> Any:
    """The native part. Raises ``ImportError`` where only the client is installed."""
    try:
        from . import _strew
    except ImportError as error:
        if is_there():
            raise
        message = (
            "this is strew-client, which makes no points by itself: call a daemon by strew.connect(url), "
            "or install strew in its place"
        )
        raise ImportError(message, name="strew._strew") from error
    return _strew


def is_there() -> bool:
    """Whether the native part is installed."""
    import importlib.util

    return importlib.util.find_spec("strew._strew") is not None
