"""What vantage uses and does not install by itself."""

from __future__ import annotations

import importlib
from typing import Any

from ._errors import input_error


def require(module: str, extra: str) -> Any:
    """The module, which belongs to that extra of the package.

    Raises:
        Error: it is not installed; it says what to install.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        name = module.split(".")[0]
        raise input_error("component-missing", f"{name} is not installed", name,
                          f"pip install 'vantage[{extra}]'") from None
