"""The extras of pyproject.toml are those that the package tells its users to install."""

import ast
import importlib
import re
import subprocess
import sys
import tomllib
from importlib import metadata

import pytest
from conftest import PROJECT
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import vantage as vt
from vantage._extras import advice

# Packages whose modules have other names.
PACKAGES = {"skimage": "scikit-image"}
# What `require` is asked for with a name that is not written there: OpenVDB's module, which no extra has.
UNNAMED = {("fields.py", "_openvdb")}


def extras():
    project = tomllib.loads((PROJECT / "pyproject.toml").read_text())["project"]
    return {name: [Requirement(line) for line in lines] for name, lines in project["optional-dependencies"].items()}


def names_of(extra):
    """The packages that an extra installs, with those of the extras that it names."""
    found = set()
    for requirement in extras()[extra]:
        if requirement.name == "vantage":
            found = found.union(*(names_of(other) for other in requirement.extras))
        else:
            found.add(canonicalize_name(requirement.name))
    return found


def pins():
    lines = (PROJECT / "python" / "requirements.txt").read_text().splitlines()
    wanted = [Requirement(line) for line in lines if line and not line.startswith("#")]
    return {canonicalize_name(one.name): next(iter(one.specifier)).version for one in wanted}


def calls():
    """File, module and extra of each call of `require`; the function in place of the module where it is no text."""
    for file in sorted((PROJECT / "python" / "vantage").rglob("*.py")):
        for function in ast.walk(ast.parse(file.read_text())):
            if not isinstance(function, (ast.FunctionDef, ast.Module)):
                continue
            inner = [node for part in function.body for node in ast.walk(part)
                     if not isinstance(function, ast.Module) or not isinstance(part, (ast.FunctionDef, ast.ClassDef))]
            for node in inner:
                if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "require":
                    module, extra = node.args
                    named = module.value if isinstance(module, ast.Constant) else None
                    yield file.name, getattr(function, "name", ""), named, ast.literal_eval(extra)


def test_each_module_is_in_the_extra_that_it_is_asked_by():
    asked = list(calls())
    assert {(file, function) for file, function, module, _ in asked if module is None} == UNNAMED
    assert {extra for *_, extra in asked} == set(extras()) - {"all"}
    for file, _, module, extra in asked:
        if module is not None:
            top = module.split(".")[0]
            assert canonicalize_name(PACKAGES.get(top, top)) in names_of(extra), (file, module, extra)


def test_nothing_is_in_an_extra_for_nothing():
    asked = {}
    for _, _, module, extra in calls():
        if module is not None:
            top = module.split(".")[0]
            asked.setdefault(extra, set()).add(canonicalize_name(PACKAGES.get(top, top)))
    asked["batch"] |= asked["geo"]
    for extra, packages in asked.items():
        assert packages == names_of(extra), extra


def test_all_is_all_of_them():
    assert names_of("all") == set().union(*(names_of(extra) for extra in extras() if extra != "all"))


def test_what_is_tested_is_allowed():
    tested = pins()
    for extra, requirements in extras().items():
        for requirement in requirements:
            if requirement.name != "vantage":
                version = tested[canonicalize_name(requirement.name)]
                assert requirement.specifier.contains(version), (extra, str(requirement), version)
                assert [one.operator for one in requirement.specifier] == [">="], "a lowest version, and no highest"


def test_documents_name_extras_that_exist():
    for file in [PROJECT / "README.md", *sorted((PROJECT / "docs").rglob("*.md"))]:
        for named in re.findall(r"vantage\[([\w,-]+)\]", file.read_text()):
            assert set(named.split(",")) <= set(extras()), (file.name, named)


@pytest.mark.parametrize("module, call", [
    ("pyvista", "volume.to_pyvista()"),
    ("trimesh", "volume.to_trimesh()"),
    ("trimesh", "scene.to_trimesh()"),
])
def test_missing_extra_is_named(module, call):
    extra = {"pyvista": "plot", "trimesh": "geo"}[module]
    code = (f"import sys; sys.modules['{module}'] = None\n"
            "import vantage as vt\n"
            "scene = vt.Scene.from_arrays([[0, 0, 0], [9, 0, 0], [0, 9, 0]], [[0, 1, 2]])\n"
            "volume = vt.Volume.from_arrays([[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9]],"
            " [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])\n"
            f"try: {call}\n"
            "except vt.Error as error: print(error.code, error.fix)")
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False,
                          env={"PYTHONPATH": ":".join(sys.path)})
    assert told.stdout.strip() == f"component-missing {advice(extra)}", told.stderr


def test_advice_names_the_index_only_where_this_package_is_installed(monkeypatch):
    """The index has another project of that name."""
    def none(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "version", none)
    assert "'vantage[geo]'" not in advice("geo") and "'geo'" in advice("geo")
    monkeypatch.setattr(metadata, "version", lambda name: "0.3.0a5")
    assert "'vantage[geo]'" not in advice("geo")
    monkeypatch.setattr(metadata, "version", lambda name: vt.__version__)
    assert advice("geo") == "pip install 'vantage[geo]'"


def test_what_is_required_is_the_module_itself():
    extras_of_package = importlib.import_module("vantage._extras")
    assert extras_of_package.require("json", "plot") is importlib.import_module("json")
    with pytest.raises(vt.Error, match="nothing-of-that-name"):
        extras_of_package.require("nothing-of-that-name", "plot")
