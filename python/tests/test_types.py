"""The types that the package tells: of the extension, of its own sources, and to those who use it."""

import importlib.util
import pathlib
import subprocess
import sys

import pytest

import vantage as vt
from conftest import PROJECT

PACKAGE = PROJECT / "python" / "vantage"


def mypy(*arguments):
    ran = subprocess.run([sys.executable, "-m", "mypy", "--config-file", PROJECT / "python" / "mypy.ini", *arguments],
                         capture_output=True, text=True, cwd=PROJECT / "python")
    return ran.returncode, ran.stdout + ran.stderr


needs_mypy = pytest.mark.skipif(not importlib.util.find_spec("mypy"), reason="mypy is not installed")


def test_the_stub_is_that_of_the_extension(tmp_path):
    pytest.importorskip("nanobind")
    made = tmp_path / "_core.pyi"
    ran = subprocess.run([sys.executable, "-m", "nanobind.stubgen", "-m", "vantage._core", "-o", made],
                         capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert made.read_text() == (PACKAGE / "_core.pyi").read_text(), (
        "make it again: python -m nanobind.stubgen -m vantage._core -o python/vantage/_core.pyi")


@needs_mypy
def test_the_sources_keep_their_types():
    code, text = mypy(PACKAGE)
    assert code == 0, text


@needs_mypy
def test_users_hear_of_wrong_types(tmp_path):
    script = tmp_path / "user.py"
    script.write_text("""import vantage as vt
scene = vt.Scene.from_mesh("city.obj", up="y")
result = vt.compute(scene, vt.Target(point=(0, 0, 1)), max_range=300)
volume: float = result.volume_m3
""")
    code, text = mypy(script)
    assert code == 0, text
    script.write_text(script.read_text() + """wrong: str = result.volume_m3
vt.compute(scene, max_range=300)
scene.faces = None
""")
    code, text = mypy(script)
    assert code == 1
    assert {line.split(":")[1] for line in text.splitlines() if ": error:" in line} == {"5", "6", "7"}, text


def test_the_types_are_in_the_package():
    assert (pathlib.Path(vt.__file__).parent / "py.typed").exists()
