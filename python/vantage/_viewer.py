"""The page with a volume, in a cell of a notebook."""

from __future__ import annotations

import base64
import gzip
import os
import sys
from collections.abc import Sequence
from html import escape
from typing import Any

from . import _core
from ._checks import flag, path as checked_path, shown, whole
from ._errors import input_error, make
from ._folders import replace_file, write_text
from ._progress import Progress
from ._requests import Path

_PAGE = "report.html"
_MARK = "<!--LIVE-->"
"""Where the page takes what it shows."""
MOST_BYTES = 20_000_000
"""Of a cell: one to two million triangles. Notebooks are written anew, with all of their cells, each time that they are saved."""

# Unpacks the page and writes it in its own place. The frame has an origin of its own (`sandbox`): what it holds cannot
# reach the notebook.
_FRAME = """<iframe title="{title}" width="{width}" height="{height}" style="border: 1px solid #8888; max-width: 100%" \
sandbox="allow-scripts allow-downloads" srcdoc="<!doctype html><meta charset='utf-8'><script>\
new Response(new Blob([Uint8Array.from(atob('{packed}'), c => c.charCodeAt(0))]).stream()\
.pipeThrough(new DecompressionStream('gzip'))).text()\
.then(page => {{ document.open(); document.write(page); document.close(); }});</script>"></iframe>"""


class Viewer:
    """A page with the scene, the volume, its numbers and what bounds it, to turn and to cut: that of `vantage report`. It
    asks no network for anything. As the last value of a notebook's cell it is shown there, also in an exported notebook.

    Example:
        >>> import vantage as vt
        >>> ground = vt.Scene.from_arrays([[-99, -99, 0], [99, -99, 0], [99, 99, 0], [-99, 99, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> result = vt.compute(ground, [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], max_range=50)
        >>> result.view(size=(800, 500)).save("view.html")       # doctest: +SKIP
    """

    def __init__(self, page: str, name: str, size: tuple[int, int], most_bytes: int):
        self.page = page
        """the page: HTML, whole"""
        self.name = name
        """of the target"""
        self.size = size
        """pixels, width and height, of the cell"""
        self.most_bytes = most_bytes
        """that a cell may have"""
        self._cell = ""

    @property
    def cell_bytes(self) -> int:
        """What a notebook grows by for each cell that shows it."""
        return len(self._made())

    def save(self, path: Path) -> None:
        """Writes the page as a file for any browser with WebGL; whole or not at all."""
        file = checked_path(path)
        if not os.path.isdir(os.path.dirname(file)):
            raise make("output", "output-folder-missing", "the folder of the output does not exist", file, "make it first",
                       None)
        replace_file(file, lambda draft: write_text(draft, self.page))

    def _made(self) -> str:
        if not self._cell:
            width, height = self.size
            packed = base64.b64encode(gzip.compress(self.page.encode(), mtime=0)).decode()
            self._cell = _FRAME.format(title=escape(f"vantage: {self.name}"), width=width, height=height, packed=packed)
        return self._cell

    def _repr_html_(self) -> str:
        cell = self._made()
        if len(cell) > self.most_bytes:
            return (f"<p>vantage: this view has {len(cell) / 1e6:.1f} MB, more than the {self.most_bytes / 1e6:.1f} MB that a "
                    "cell may have (<code>most_bytes</code>). Write it with <code>.save('view.html')</code> and open that file, "
                    "or compute in a smaller scene.</p>")
        return cell

    def __repr__(self) -> str:
        return f"<vantage.Viewer: {self.name}, {self.size[0]} x {self.size[1]} pixels, {self.cell_bytes:,} bytes>"


def _page(given: Path | None) -> str:
    """The text of the page without a volume."""
    here = os.path.dirname(os.path.realpath(__file__))
    places = [checked_path(given, "page")] if given is not None else [
        os.path.join(os.path.dirname(os.path.abspath(__file__)), "share/web", _PAGE),  # of the wheel
        os.path.join(here, "../../web/dist", _PAGE),  # of the checkout
        *(os.path.join(prefix, "share/vantage/web", _PAGE) for prefix in (sys.prefix, "/usr/local", "/usr"))]
    for place in places:
        if os.path.isfile(place):
            with open(place, encoding="utf-8", errors="replace") as file:
                text = file.read()
            if _MARK not in text:
                raise input_error("page-missing", "this is not the page of vantage, or it is of another version", place,
                                  "build it anew with 'make web'")
            return text
    raise input_error("page-missing", "the page is not installed", os.path.normpath(places[0]),
                      "run 'make web' in the source tree, or pass page='.../report.html'")


def viewer(mission: _core.Mission, volume: _core.Volume, size: Any, proof: Any, page: Path | None, most_bytes: Any,
           progress: Progress) -> Viewer:
    """The viewer of a mission of one volume."""
    if not isinstance(size, Sequence) or len(size) != 2:
        raise input_error("wrong-type", f"size is {shown(size)}", "size", "pass width and height: (1000, 650)")
    pixels = whole(size[0], "size[0]", 1, 2**15), whole(size[1], "size[1]", 1, 2**15)
    most, proves = whole(most_bytes, "most_bytes", 1), flag(proof, "proof")
    name, fill = mission.target_name, _core.viewer_page  # builds without it say so, before the page is looked for
    filled = fill(mission, volume, _page(page), f"{name or 'mission'}.yaml", proves, progress)
    return Viewer(filled, name, pixels, most)
