"""Building models; the files are written here."""

import numpy as np
import pytest

import vantage as vt
from conftest import refused

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
#29=IFCSPACE('0000000000000000000004',$,'room',$,$,#12,#17,$,.ELEMENT.,$,$);
"""
BROKEN = """#33=IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(1.,0.,0.)));
#35=IFCTRIANGULATEDFACESET(#33,$,.F.,((1,2,9)),$);
#36=IFCSHAPEREPRESENTATION(#5,'Body','Tessellation',(#35));
#37=IFCPRODUCTDEFINITIONSHAPE($,$,(#36));
#38=IFCWALL('0000000000000000000005',$,'broken wall',$,$,$,#37,$,$);
"""
MAP = "#7=IFCPROJECTEDCRS('{crs}',$,$,'DHHN2016',$,$,$);\n#8=IFCMAPCONVERSION(#5,#7,{east},{north},250.,{x},{y},{scale});\n"


def written(folder, *parts):
    file = folder / "model.ifc"
    file.write_text("".join([HEAD, *parts, "ENDSEC;\nEND-ISO-10303-21;\n"]))
    return file


def placed(crs="EPSG:32632", scale="0.001", x="0.", y="1.", east="500000.", north="5000000."):
    return MAP.format(crs=crs, scale=scale, x=x, y=y, east=east, north=north)


def test_products_are_objects_in_metres(tmp_path):
    scene = vt.Scene.from_ifc(written(tmp_path, TOWER, COLUMN))
    assert [(one.name, one.source_id, one.kind) for one in scene.objects] == [
        ("tower", "0000000000000000000002", "building"), ("column", "0000000000000000000003", "building")]  # and no room
    tower = scene.vertices[np.unique(scene.faces[scene.object_of == 0])]
    assert np.allclose([tower.min(axis=0), tower.max(axis=0)], [[-1, -1, 3], [3, 5, 8]], atol=1e-9)
    assert (scene.object_of == 0).sum() == 12 and scene.georeference is None


def test_curved_surfaces_keep_to_the_deflection(tmp_path):
    for deflection_m in (0.1, 0.01, 0.001):
        scene = vt.Scene.from_ifc(written(tmp_path, COLUMN), deflection_m=deflection_m)
        corners = scene.vertices[scene.faces]
        sides = corners[np.ptp(corners[..., 2], axis=1) > 1]  # and not the caps
        middles = (sides + np.roll(sides, 1, axis=1)) / 2
        chords = middles[np.isclose(middles[..., 2], 0) | np.isclose(middles[..., 2], 3)]
        rim = np.concatenate([np.hypot(*chords[:, :2].T), np.hypot(*scene.vertices[:, :2].T)])
        assert len(chords) >= 6 and 0.5 - deflection_m <= rim.min() and rim.max() <= 0.5 + deflection_m


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


def scene_to_utm(scene):
    pyproj = pytest.importorskip("pyproj")
    return pyproj.Transformer.from_crs(scene.crs, 32632, always_xy=True).transform(*scene.vertices[:, :2].T)


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
