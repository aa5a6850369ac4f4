"""What vantage uses and does not install by itself."""

from __future__ import annotations

import importlib
from typing import Any

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
                          name, f"pip install 'vantage[{extra}]'") from None


def _was_interrupted(error: BaseException | None) -> bool:
    while error is not None:
        if isinstance(error, KeyboardInterrupt):
            return True
        error = error.__cause__ or error.__context__
    return False
