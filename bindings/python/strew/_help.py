"""Signatures and docstrings of the functions that take a query: every keyword with its meaning, unit and default."""

from __future__ import annotations

import functools
import inspect
import re
import textwrap
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from ._parameters import ABOUT
from ._query import ABOUT_MORE, ABOUT_SPACE, Query, SpaceQuery

if TYPE_CHECKING:
    from typing import Any

Function = TypeVar("Function", bound="Callable[..., Any]")


def documented(query: type) -> Callable[[Function], Function]:
    """Documents the keywords of a query at a method that takes them."""
    texts = ABOUT_SPACE if query is SpaceQuery else {**ABOUT, **ABOUT_MORE}
    kinds = {name: str(getattr(kind, "__forward_arg__", kind)) for name, kind in query.__annotations__.items()}
    # As readers know them: each may be of numpy, and None.
    plain = {r"\bNumber\b": "float", r"\bInteger\b": "int", r" \| None$": ""}
    names = {
        name: functools.reduce(lambda text, old: re.sub(old, plain[old], text), plain, kind) for name, kind in kinds.items()
    }

    def document(function: Function) -> Function:
        keyword = inspect.Parameter.KEYWORD_ONLY
        own = inspect.Parameter("self", inspect.Parameter.POSITIONAL_OR_KEYWORD)
        taken = [inspect.Parameter(name, keyword, default=None, annotation=kind) for name, kind in names.items()]
        returned = inspect.signature(function).return_annotation
        function.__signature__ = inspect.Signature([own, *taken], return_annotation=returned)  # type: ignore[attr-defined]
        lines = []
        for name, kind in names.items():
            about = texts.get(name) or ABOUT[name]
            lines.append(f"{name} : {kind}")
            lines.append(textwrap.fill(about.strip(), 96, initial_indent="    ", subsequent_indent="    "))
        doc = inspect.cleandoc(function.__doc__ or "")
        function.__doc__ = "\n".join([doc, "", "Keywords (all optional, ``None`` leaves one out)", "-" * 48, *lines])
        return function

    return document
