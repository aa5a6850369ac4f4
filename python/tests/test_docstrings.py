"""Examples in docstrings give what they say, and whatever can be called has one."""

import doctest
import importlib
import inspect
import pkgutil

import pytest

import vantage as vt

MODULES = ["vantage", *(f"vantage.{one.name}" for one in pkgutil.iter_modules(vt.__path__)
                        if one.name not in ("_core", "__main__"))]


@pytest.mark.parametrize("name", MODULES)
def test_examples(name):
    module = importlib.import_module(name)
    result = doctest.testmod(module, extraglobs={"vt": vt}, optionflags=doctest.ELLIPSIS)
    assert result.failed == 0


def test_all_that_can_be_called_is_explained():
    returned = ("Positions", "Area", "Face", "Tile", "Tiles", "FlightCheck", "Tour", "View", "Standpoint", "Standpoints", "Orbit",
                "Orbits", "Found", "PositionView")
    for name in vt.__all__:
        what = getattr(vt, name)
        if not callable(what):
            continue
        text = inspect.getdoc(what) or ""
        assert text, name
        is_returned = inspect.isclass(what) and (issubclass(what, (tuple, Exception)) or name in returned)
        assert is_returned or ">>>" in text, f"{name} has no example"


def test_members_are_explained():
    for of in (vt.Scene, vt.Volume, vt.Mission, vt.Result, vt.Flight, vt.FlightCheck, vt.Tour):
        for name, member in inspect.getmembers(of):
            if not name.startswith("_") and (callable(member) or isinstance(member, property)):
                assert inspect.getdoc(member), f"{of.__name__}.{name}"
