"""The page with a volume, as notebooks show it; `make jupyter` looks at it in JupyterLab."""

import base64
import gzip
import html.parser
import json
import re
import struct

import numpy as np
import pytest

import vantage as vt
from conftest import SQUARE, box, refused, yard

EMPTY_PAGE = "<html><!--LIVE--><p>\u00e4</p></html>"
NASTY = "\"></iframe><script>alert('1')</script>"


@pytest.fixture
def page(tmp_path):
    """In place of what `make web` builds."""
    file = tmp_path / "report.html"
    file.write_text(EMPTY_PAGE, encoding="utf-8")
    return file


class Frames(html.parser.HTMLParser):
    """The attributes of each element of a text."""

    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))


def answer(page, call):
    """What the page holds of one call: the JSON before its arrays."""
    packed = re.search(rf'{call}:"([^"]*)"', page)[1]
    data = gzip.decompress(base64.b64decode(packed))
    return json.loads(data[4:4 + struct.unpack("<I", data[:4])[0]])["value"]


def unpacked(cell):
    """The page of a cell, as its script unpacks it."""
    (tag, frame), = Frames(cell).found
    assert tag == "iframe"
    return frame, gzip.decompress(base64.b64decode(re.search(r"atob\('([^']*)'\)", frame["srcdoc"])[1])).decode()


def test_a_cell_holds_the_whole_page(result, page):
    view = result.view(size=(640, 480), page=page)
    cell = view._repr_html_()
    frame, text = unpacked(cell)
    assert text == view.page and "\u00e4" in text and view.cell_bytes == len(cell)
    assert (frame["width"], frame["height"]) == ("640", "480")
    assert set(frame["sandbox"].split()) == {"allow-scripts", "allow-downloads"}  # no origin of the notebook
    told = answer(text, "hello")
    assert told["volume"]["volume_m3"] == result.volume_m3 and told["volume"]["facets"] == len(result.faces)
    assert told["scene"]["triangles"] == len(result.scene.faces)
    assert "prove:" not in text


def test_with_a_proof_the_page_has_its_verdict(result, page):
    assert answer(result.view(page=page, proof=True).page, "prove")["verdict"] == "proved"


def test_a_volume_of_others_is_shown_with_its_mission(scene, page):
    mission = vt.Mission.of(scene, SQUARE, max_range=60)
    tower = vt.Volume.from_arrays(*box((2, 2, 20), (4, 4, 22)))
    told = answer(mission.view(tower, page=page).page, "hello")["volume"]
    assert told["volume_m3"] == pytest.approx(8) and np.allclose(told["center"][2], 0, atol=0.01)
    open_mesh = vt.Volume.from_arrays([[0, 0, 9], [1, 0, 9], [0, 1, 9]], [[0, 1, 2]])
    assert refused(lambda: mission.view(open_mesh, page=page)).code == "mesh-not-closed"


def test_names_do_not_leave_the_frame(page):
    result = vt.compute(yard(), vt.Target(vertices=SQUARE, name=NASTY), max_range=60)
    frame, text = unpacked(result.view(page=page)._repr_html_())
    assert frame["title"] == f"vantage: {NASTY}" and text.count("<script>") == 1


def test_a_cell_that_is_too_large_says_so(result, page):
    view = result.view(page=page, most_bytes=1000)
    assert view.cell_bytes > 1000
    assert "<iframe" not in view._repr_html_() and "most_bytes" in view._repr_html_()


def test_a_view_is_saved_whole(result, page, tmp_path):
    view = result.view(page=page)
    view.save(tmp_path / "view.html")
    assert (tmp_path / "view.html").read_text(encoding="utf-8") == view.page
    with pytest.raises(vt.Error) as raised:
        view.save(tmp_path / "none" / "view.html")
    assert raised.value.code == "output-folder-missing"


def test_what_cannot_be_shown_is_refused(scene, result, page, tmp_path):
    assert refused(lambda: result.view(page=tmp_path / "none.html")).code == "page-missing"
    (tmp_path / "other.html").write_text("<html></html>")
    assert refused(lambda: result.view(page=tmp_path / "other.html")).code == "page-missing"
    for size in (5, (5,), (0, 5), ("5", 5)):
        refused(lambda: result.view(size=size, page=page))
    refused(lambda: result.view(most_bytes=0, page=page))
    each = vt.Mission.of(scene, [SQUARE, SQUARE], max_range=60, combine="each")
    assert refused(lambda: each.view(result.volume, page=page)).code == "not-applicable"
    with pytest.raises(vt.Error) as raised:
        result.view(page=page, progress=lambda *_: False)
    assert raised.value.code == "cancelled"
