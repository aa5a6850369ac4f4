"""What vantage uses and does not install by itself."""

from __future__ import annotations

import importlib
from importlib import metadata
from typing import Any

from ._core import version
from ._errors import input_error


def require(module: str, extra: str) -> Any:
    """The module, which belongs to that extra of the package.

    Raises:
        Error: it is not installed, or broken; it says what to install.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        if _was_interrupted(error):  # extension modules make an ImportError of it
            raise KeyboardInterrupt from None
        name = module.split(".")[0]
        is_missing = isinstance(error, ModuleNotFoundError)
        raise input_error("component-missing", f"{name} is not installed" if is_missing else f"{name} is broken: {error}",
                          name, advice(extra)) from None


def advice(extra: str) -> str:
    """How to install the packages of an extra. The package index has another project of the name vantage, which pip takes
    where this package is not installed, but found by PYTHONPATH."""
    try:
        is_installed = metadata.version("vantage") == version
    except metadata.PackageNotFoundError:
        is_installed = False
    if is_installed:
        return f"pip install 'vantage[{extra}]'"
    return f"install what pyproject.toml lists for the extra '{extra}', or a wheel of vantage: pip install 'WHEEL[{extra}]'"


def _was_interrupted(error: BaseException | None) -> bool:
    while error is not None:
        if isinstance(error, KeyboardInterrupt):
            return True
        error = error.__cause__ or error.__context__
    return False
