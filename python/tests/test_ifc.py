"""Building models; the files are written here."""

import numpy as np
import pytest

import vantage as vt
from conftest import refused
from vantage import _ifc

pytest.importorskip("ifcopenshell", reason="the extra `ifc` is not installed")

HEAD = """ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('','',(''),(''),'','','');
FILE_SCHEMA(('IFC4'));
ENDSEC;
DATA;
#1=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);
#2=IFCUNITASSIGNMENT((#1));
#3=IFCCARTESIANPOINT((0.,0.,0.));
#4=IFCAXIS2PLACEMENT3D(#3,$,$);
#5=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,#4,$);
#6=IFCPROJECT('0000000000000000000001',$,'model',$,$,$,$,(#5),#2);
#9=IFCDIRECTION((0.,0.,1.));
"""
TOWER = """#10=IFCCARTESIANPOINT((1000.,2000.,3000.));
#11=IFCAXIS2PLACEMENT3D(#10,$,$);
#12=IFCLOCALPLACEMENT($,#11);
#13=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,4000.,6000.);
#15=IFCEXTRUDEDAREASOLID(#13,#4,#9,5000.);
#16=IFCSHAPEREPRESENTATION(#5,'Body','SweptSolid',(#15));
#17=IFCPRODUCTDEFINITIONSHAPE($,$,(#16));
#18=IFCBUILDINGELEMENTPROXY('0000000000000000000002',$,'tower',$,$,#12,#17,$,$);
"""
COLUMN = """#23=IFCCIRCLEPROFILEDEF(.AREA.,$,$,500.);
#25=IFCEXTRUDEDAREASOLID(#23,#4,#9,3000.);
#26=IFCSHAPEREPRESENTATION(#5,'Body','SweptSolid',(#25));
#27=IFCPRODUCTDEFINITIONSHAPE($,$,(#26));
#28=IFCCOLUMN('0000000000000000000003',$,'column',$,$,$,#27,$,$);
"""
ROOM = """#29=IFCSPACE('0000000000000000000004',$,'room',$,$,#12,#17,$,.ELEMENT.,$,$);
"""
BROKEN = """#33=IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(1.,0.,0.)));
#35=IFCTRIANGULATEDFACESET(#33,$,.F.,((1,2,9)),$);
#36=IFCSHAPEREPRESENTATION(#5,'Body','Tessellation',(#35));
#37=IFCPRODUCTDEFINITIONSHAPE($,$,(#36));
#38=IFCWALL('0000000000000000000005',$,'broken wall',$,$,$,#37,$,$);
"""
CORNERS = """#400=IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(1000.,0.,0.),(1000.,1000.,0.),(0.,1000.,0.),
(0.,0.,1000.),(1000.,0.,1000.),(1000.,1000.,1000.),(0.,1000.,1000.)));
"""
CUBE = [(1, 4, 3, 2), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8)]
FEET = """#70=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);
#71=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);
#72=IFCMEASUREWITHUNIT(IFCRATIOMEASURE({metres}),#71);
#73=IFCCONVERSIONBASEDUNIT(#70,.LENGTHUNIT.,'feet',#72);
"""
US_FOOT_M = 1200 / 3937
MAP = "#7=IFCPROJECTEDCRS('{crs}',$,$,'DHHN2016',$,$,{unit});\n#8=IFCMAPCONVERSION(#5,#7,{east},{north},250.,{x},{y},{scale});\n"


def written(folder, *parts):
    file = folder / "model.ifc"
    file.write_text("".join([HEAD, *parts, "ENDSEC;\nEND-ISO-10303-21;\n"]))
    return file


def placed(crs="EPSG:32632", scale="0.001", x="0.", y="1.", east="500000.", north="5000000.", unit="$"):
    return MAP.format(crs=crs, scale=scale, x=x, y=y, east=east, north=north, unit=unit)


def proxy(name, items):
    """A product whose body has these items."""
    return (f"#936=IFCSHAPEREPRESENTATION(#5,'Body','Tessellation',({items}));\n#937=IFCPRODUCTDEFINITIONSHAPE($,$,(#936));\n"
            f"#938=IFCBUILDINGELEMENTPROXY('0000000000000000000006',$,'{name}',$,$,$,#937,$,$);\n")


def face_set(name, faces):
    """A product of faces on CORNERS."""
    rows = "".join(f"#{500 + i}=IFCINDEXEDPOLYGONALFACE(({','.join(map(str, face))}));\n" for i, face in enumerate(faces))
    numbers = ",".join(f"#{500 + i}" for i in range(len(faces)))
    return f"{CORNERS}{rows}#499=IFCPOLYGONALFACESET(#400,.F.,({numbers}),$);\n" + proxy(name, "#499")


def test_products_are_objects_in_metres(tmp_path):
    scene = vt.Scene.from_ifc(written(tmp_path, TOWER, COLUMN, ROOM))
    assert [(one.name, one.source_id, one.kind) for one in scene.objects] == [
        ("tower", "0000000000000000000002", "building"), ("column", "0000000000000000000003", "building"),
        ("column", "0000000000000000000003", "stand-in")]  # and no room
    tower = scene.vertices[np.unique(scene.faces[scene.object_of == 0])]
    assert np.allclose([tower.min(axis=0), tower.max(axis=0)], [[-1, -1, 3], [3, 5, 8]], atol=1e-9)
    assert (scene.object_of == 0).sum() == 12 and scene.georeference is None


def test_curved_surfaces_keep_to_the_deflection(tmp_path):
    for deflection_m in (0.1, 0.01, 0.001):
        scene = vt.Scene.from_ifc(written(tmp_path, COLUMN), deflection_m=deflection_m, missing="warn")
        corners = scene.vertices[scene.faces]
        sides = corners[np.ptp(corners[..., 2], axis=1) > 1]  # and not the caps
        middles = (sides + np.roll(sides, 1, axis=1)) / 2
        chords = middles[np.isclose(middles[..., 2], 0) | np.isclose(middles[..., 2], 3)]
        rim = np.concatenate([np.hypot(*chords[:, :2].T), np.hypot(*scene.vertices[:, :2].T)])
        assert len(chords) >= 6 and 0.5 - deflection_m <= rim.min() and rim.max() <= 0.5 + deflection_m


def test_what_stands_in_holds_curved_surfaces(tmp_path):
    """Each point of the true cylinder lies in one of the boxes, and these reach little beyond it."""
    for deflection_m in (0.1, 0.01, 0.001):
        scene = vt.Scene.from_ifc(written(tmp_path, COLUMN), deflection_m=deflection_m)
        boxes = scene.vertices[np.unique(scene.faces[scene.object_of == 1])].reshape(-1, 8, 3)
        angle, z = np.random.default_rng(1).uniform(0, [[2 * np.pi], [3]], (2, 2000))
        points = np.column_stack([0.5 * np.cos(angle), 0.5 * np.sin(angle), z])
        sides = boxes[:, [1, 2, 4]] - boxes[:, :1]
        share = np.einsum("pbi,bki->pbk", points[:, None] - boxes[None, :, 0], sides) / (sides ** 2).sum(axis=2)
        assert ((share > -1e-9) & (share < 1 + 1e-9)).all(axis=2).any(axis=1).all()
        assert np.hypot(*boxes.reshape(-1, 3)[:, :2].T).max() < 0.5 + 3 * deflection_m
        row, = scene._core.ledger_rows
        assert row[1] == "curved surfaces" and row[5] == 1


def test_what_has_no_body_is_in_the_ledger(tmp_path):
    axis = ("#50=IFCPOLYLINE((#3,#10));\n#56=IFCSHAPEREPRESENTATION(#5,'Axis','Curve3D',(#50));\n"
            "#57=IFCPRODUCTDEFINITIONSHAPE($,$,(#56));\n#58=IFCBEAM('0000000000000000000009',$,'beam',$,$,$,#57,$,$);\n")
    scene = vt.Scene.from_ifc(written(tmp_path, TOWER, axis, BROKEN), allow_missing=True)
    rows = scene._core.ledger_rows
    assert [row[0][0] for row in rows[:2]] == ["beam", "broken wall"] and all(row[5] is None for row in rows)
    assert refused(lambda: vt.Scene.from_ifc(written(tmp_path, TOWER, axis), missing="refuse")).code == "scene-incomplete"


def test_a_map_conversion_places_the_scene(tmp_path):
    scene = vt.Scene.from_ifc(written(tmp_path, placed(), TOWER))
    place = scene.georeference
    assert (place.source_crs, place.vertical) == ("EPSG:32632", "DHHN2016")
    # x of the model is north, y is west: its middle (1, 2) is 2 m west and 1 m north of the conversion's origin.
    east, north = scene_to_utm(scene)
    assert np.allclose([east.min(), east.max()], [500000 - 5, 500000 + 1], atol=1e-5)
    assert np.allclose([north.min(), north.max()], [5000000 - 1, 5000000 + 3], atol=1e-5)
    assert np.allclose(scene.bounds[:, 2], [253, 258], atol=1e-9)
    assert abs(scene.bounds[:, :2].mean(axis=0)).max() < 0.01  # the origin is the middle of the model


def scene_to_utm(scene, crs=32632):
    pyproj = pytest.importorskip("pyproj")
    return pyproj.Transformer.from_crs(scene.crs, crs, always_xy=True).transform(*scene.vertices[:, :2].T)


@pytest.mark.parametrize("unit", ["$", "#73"])
def test_maps_in_feet_keep_the_size_of_the_model(tmp_path, unit):
    """New York's plane: its coordinates are in US survey feet, and the file need not say so."""
    of_map = placed(crs="EPSG:2263", scale=repr(0.001 / US_FOOT_M), x="1.", y="0.", east="985000.", north="210000.", unit=unit)
    scene = vt.Scene.from_ifc(written(tmp_path, FEET.format(metres="0.3048006096"), of_map, TOWER))
    assert np.allclose(np.ptp(scene.vertices, axis=0), [4, 6, 5], rtol=1e-3)
    east, north = scene_to_utm(scene, 2263)
    assert np.allclose([east.min(), east.max()], [985000 - 1 / US_FOOT_M, 985000 + 3 / US_FOOT_M], atol=1e-4)
    assert np.allclose([north.min(), north.max()], [210000 - 1 / US_FOOT_M, 210000 + 5 / US_FOOT_M], atol=1e-4)
    assert np.allclose(scene.bounds[:, 2], [3 + 250 * US_FOOT_M, 8 + 250 * US_FOOT_M], atol=1e-6)


def test_a_scale_in_metres_does_not_shrink_what_lies_on_a_map_in_feet(tmp_path):
    of_map = {scale: placed(crs="EPSG:2263", scale=scale, east="985000.", north="210000.") for scale in ("0.001", "$")}
    assert refused(lambda: vt.Scene.from_ifc(written(tmp_path, of_map["0.001"], TOWER))).code == "value-out-of-range"
    unsaid = vt.Scene.from_ifc(written(tmp_path, of_map["$"], TOWER))
    assert np.allclose(np.ptp(unsaid.vertices, axis=0), [6, 4, 5], atol=0.01)


@pytest.mark.parametrize("crs, metres, code", [
    ("EPSG:2263", "0.3048", "value-out-of-range"),  # the international foot
    ("EPSG:2263", "1.", "value-out-of-range"),
    ("EPSG:32632", "0.3048006096", "value-out-of-range"),
    ("EPSG:2263+5703", "0.3048006096", "height-unknown"),  # heights in metres
    ("EPSG:4326", "1.", "value-unsupported"),
    ("EPSG:4978", "1.", "value-unsupported")])
def test_units_that_the_map_has_not_are_refused(tmp_path, crs, metres, code):
    of_map = placed(crs=crs, scale=repr(0.001 / float(metres)), unit="#73")
    file = written(tmp_path, FEET.format(metres=metres), of_map, TOWER)
    assert refused(lambda: vt.Scene.from_ifc(file)).code == code
    assert vt.Scene.from_ifc(file, georeference=False).georeference is None


def test_the_place_can_be_left_out_or_named(tmp_path):
    file = written(tmp_path, placed(crs="our grid"), TOWER)
    assert refused(lambda: vt.Scene.from_ifc(file)).code.startswith("crs-")
    assert vt.Scene.from_ifc(file, georeference=False).georeference is None
    assert vt.Scene.from_ifc(file, crs="EPSG:32632").georeference.source_crs == "EPSG:32632"


def test_wrong_scales_are_refused(tmp_path):
    assert refused(lambda: vt.Scene.from_ifc(written(tmp_path, placed(scale="1."), TOWER))).code == "value-out-of-range"
    unsaid = vt.Scene.from_ifc(written(tmp_path, placed(scale="$"), TOWER))
    assert np.allclose(np.ptp(unsaid.vertices, axis=0), [6, 4, 5], atol=0.01)


def test_products_without_triangles_are_not_lost_in_silence(tmp_path):
    file = written(tmp_path, TOWER, BROKEN)
    error = refused(lambda: vt.Scene.from_ifc(file))
    assert error.code == "mesh-unsupported" and "0000000000000000000005" in error.problem
    assert len(vt.Scene.from_ifc(file, allow_missing=True).objects) == 1


BROKEN_ITEM = BROKEN.split("#36=")[0]
LOSSES = {
    "an item of a body": TOWER + BROKEN_ITEM + proxy("half", "#15,#35"),
    "an item without thickness": TOWER + "#39=IFCEXTRUDEDAREASOLID(#13,#4,#9,0.);\n" + proxy("half", "#15,#39"),
    "a face that crosses itself": face_set("bowtie", CUBE[:-1] + [(4, 5, 1, 8)]),
    "an operand": TOWER + BROKEN_ITEM + "#92=IFCBOOLEANRESULT(.UNION.,#15,#35);\n" + proxy("half", "#92"),
    "a product of an unknown class": TOWER + "#900=IFCNOTHING(1);\n",
    "a number that is used twice": TOWER + TOWER,
    "attributes": TOWER + "#900=IFCWALL('0000000000000000000009',$,'wall');\n",
}


@pytest.mark.parametrize("what", LOSSES)
def test_parts_of_products_are_not_lost_in_silence(tmp_path, what):
    file = written(tmp_path, LOSSES[what])
    assert refused(lambda: vt.Scene.from_ifc(file)).code == "mesh-unsupported"
    assert len(vt.Scene.from_ifc(file, allow_missing=True).faces) > 0


@pytest.mark.parametrize("more", [[], [CUBE[0]], [CUBE[0], CUBE[0]], [(1, 1, 2)], [(1, 2, 1), (1, 1, 2)]])
def test_faces_without_area_and_those_there_twice_are_no_loss(tmp_path, more):
    scene = vt.Scene.from_ifc(written(tmp_path, face_set("cube", CUBE + more)))
    a, b, c = np.moveaxis(scene.vertices[scene.faces], 1, 0)
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 > 6 - 1e-9  # m2


def test_entries_of_the_log_that_tell_of_losses():
    def lost(*entries):
        return len(_ifc._lost("".join(f"[warning] [{code}] [2026-01-01 00:00:00] {{guid}} {text}\n#1=IfcWall()\n"
                                      for code, text in entries)))

    counted = ("GEO169", "2 duplicate faces removed, 1 degenerate loops eliminated and 0 non-manifold edges")
    one_face = (("GEO159", "Face boundary loop not included"), ("GEO162", "Face with no boundaries"),
                ("GEO198", "Failed to convert face:"))
    assert [lost(counted, *one_face * count) for count in (0, 3, 4, 6)] == [0, 0, 1, 3]
    assert lost(*one_face) == 1 and lost(one_face[2]) == 1
    assert lost(("GEO185", "Mesher generated a degenerate triangle, ignoring"), ("GEO031", "No material")) == 0


def test_what_was_logged_before_is_not_taken_for_the_files(tmp_path):
    refused(lambda: vt.Scene.from_ifc(written(tmp_path, LOSSES["a face that crosses itself"])))
    assert len(vt.Scene.from_ifc(written(tmp_path, TOWER)).faces) == 12


def test_files_that_cannot_be_read_are_refused(tmp_path):
    assert refused(lambda: vt.Scene.from_ifc(tmp_path / "none.ifc")).code == "file-not-found"
    other = tmp_path / "other.ifc"
    other.write_text("solid")
    assert refused(lambda: vt.Scene.from_ifc(other)).code == "mesh-syntax"
    assert refused(lambda: vt.Scene.from_ifc(written(tmp_path))).code == "mesh-empty"
    for deflection_m in (0, -1, 2):
        assert refused(lambda: vt.Scene.from_ifc(other, deflection_m=deflection_m)).code == "value-out-of-range"


def test_it_hides(tmp_path):
    scene = vt.Scene.from_ifc(written(tmp_path, TOWER))
    behind = vt.Mission.of(scene, [[10, 1, 6], [10, 3, 6], [10, 3, 4], [10, 1, 4]], max_range=60).query([[-10, 2, 5]])
    assert behind.blocked_by == [["0000000000000000000002 tower"]]
