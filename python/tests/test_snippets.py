"""Every Python block of the documents is run, on the data that it names."""

import ast
import os
import re
import subprocess
import sys

import pytest
from conftest import PROJECT, SHARED

DRIVER = """
import sys
blocks = eval(sys.stdin.read())
names = {"__name__": "snippet"}
for place, text in blocks:
    line = int(place.rsplit(":", 1)[1])
    exec(compile("\\n" * line + text, place, "exec"), names)
    print()
"""


def houses(folder):
    import geopandas
    import shapely

    table = geopandas.GeoDataFrame({"height_m": [9.0, 12.0], "name": ["mill", "barn"]}, crs=4326, geometry=[
        shapely.box(11.5750, 48.1370, 11.5753, 48.1372), shapely.box(11.5756, 48.1370, 11.5759, 48.1372)])
    table.to_crs(25832).to_file(folder / "houses.gpkg", driver="GPKG")


def squares(folder):
    import geopandas
    import shapely

    places = [(-73.98465, 40.74665), (-73.98310, 40.74880)]
    table = geopandas.GeoDataFrame({"id": [1, 2]}, crs=4326,
                                   geometry=[shapely.box(x, y, x + 5e-5, y + 5e-5) for x, y in places])
    table.to_parquet(folder / "squares.parquet")


# What the blocks of a document need: modules, files of the real inputs by the name in the document, files that are made.
NEEDS = {
    "README.md": (["pyvista"], {}, None),
    "docs/flight.md": (["matplotlib"], {}, None),
    "docs/python.md": ([], {}, None),
    "docs/python-areas.md": ([], {"city.osm.pbf": "osm/manhattan-midtown.osm.pbf"}, None),
    "docs/python-batch.md": (["pyarrow", "geopandas"], {"city.osm.pbf": "osm/empire-state-600m.osm.pbf"}, squares),
    "docs/python-fields.md": (["xarray", "skimage", "netCDF4", "matplotlib"], {}, None),
    "docs/python-geo.md": (["geopandas", "shapely"], {}, houses),
    "docs/python-positions.md": (["ortools"], {}, None),
}


def blocks_of(document):
    """Place and text of each Python block."""
    lines = (PROJECT / document).read_text(encoding="utf-8").splitlines()
    found, begin = [], None
    for number, line in enumerate(lines):
        if begin is None and line.strip() == "```python":
            begin = number + 1
        elif begin is not None and line.strip() == "```":
            found.append((f"{document}:{begin}", "\n".join(lines[begin:number]) + "\n"))
            begin = None
    return found


def documents():
    files = [PROJECT / "README.md", *sorted((PROJECT / "docs").rglob("*.md"))]
    return [file.relative_to(PROJECT).as_posix() for file in files if blocks_of(file.relative_to(PROJECT).as_posix())]


def test_each_document_with_python_is_run():
    assert documents() == sorted(NEEDS, key=lambda name: (name != "README.md", name))


def checked(text):
    """The block, in which what `EXPRESSION  # "word"` says is asked; lines stay where they are."""
    lines = []
    for line in text.splitlines(keepends=True):
        told = re.fullmatch(r'(\S.*?)\s+# ("[^"]*")\n', line)
        lines.append(f"assert ({told[1]}) == {told[2]}, {told[1]}\n" if told and is_expression(told[1]) else line)
    return "".join(lines)


def is_expression(text):
    try:
        ast.parse(text, mode="eval")
    except SyntaxError:
        return False
    return True


def test_words_behind_expressions_are_asked():
    assert checked('a = 1  # "b"\n2 + 3  # "five"\n"x"  # a word\n') == (
        'a = 1  # "b"\nassert (2 + 3) == "five", 2 + 3\n"x"  # a word\n')
    with pytest.raises(AssertionError):
        exec(checked('"proved"  # "not proved"\n'))
    assert any('== "proved"' in checked(text) for _, text in blocks_of("docs/python.md"))


def said(blocks):
    """What `print(...)  # words` of the blocks say that they print, each with its place."""
    for place, text in blocks:
        for line in text.splitlines():
            printed = re.match(r"print\(.*\)\s+# (.*)$", line)
            if printed and "..." not in printed[1]:
                yield place, printed[1]


@pytest.mark.parametrize("document", sorted(NEEDS))
def test_the_blocks_of(document, tmp_path):
    modules, real, make = NEEDS[document]
    for module in modules:
        pytest.importorskip(module)
    for name, source in real.items():
        if not (SHARED / "data" / source).exists():
            pytest.skip(f"{document} needs {source} of the real inputs: set VANTAGE_SHARED to the folder that holds data/")
        (tmp_path / name).symlink_to(SHARED / "data" / source)
    if make is not None:
        make(tmp_path)
    (tmp_path / "examples").symlink_to(PROJECT / "examples")
    blocks = [(place, checked(text)) for place, text in blocks_of(document)]
    environment = {**os.environ, "PYTHONPATH": ":".join(sys.path), "MPLBACKEND": "Agg", "PYVISTA_OFF_SCREEN": "true"}
    driver = tmp_path / "driver.py"
    driver.write_text(DRIVER + "\n" if document != "docs/python-batch.md" else script_of(blocks))
    ran = subprocess.run([sys.executable, driver], input=repr(blocks), capture_output=True, text=True, cwd=tmp_path,
                         env=environment, timeout=600)
    assert ran.returncode == 0, ran.stderr[-3000:]
    for place, words in said(blocks):
        assert words in ran.stdout, f"{place}: '{words}' is not in\n{ran.stdout}"


def script_of(blocks):
    """For what starts processes, which import the script: with the guard that multiprocessing asks for."""
    body = "".join(text for _, text in blocks)
    return "if __name__ == '__main__':\n" + "".join(f"    {line}\n" for line in body.splitlines())


