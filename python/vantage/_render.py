"""What shows values: functions by the class of the value. `_html`, `_plot` and `_profile` register themselves here.

So classes have `_repr_html_` and `plot` and import nothing that draws: what draws imports the classes.
"""

from __future__ import annotations

import functools
from typing import Any, NoReturn


def _none_for(value: Any) -> NoReturn:
    raise TypeError(f"nothing draws a {type(value).__name__}")


@functools.singledispatch
def html(value: Any) -> str:
    """The value for a notebook."""
    _none_for(value)


@functools.singledispatch
def plot(value: Any, *arguments: Any, **options: Any) -> Any:
    """The value as a picture. The arguments are those of the method `plot` of its class."""
    _none_for(value)
