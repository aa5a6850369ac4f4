"""Building models, IFC, by IfcOpenShell (the extra `ifc`)."""

from __future__ import annotations

import os
import re
import threading
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core
from ._checks import flag
from ._errors import Error, input_error
from ._extras import require
from ._objects import KINDS, Missing, SceneObject
from ._place import WGS84, Georeference, crs_text

Numbers = npt.NDArray[np.float64]

NOT_BUILT = ("IfcOpeningElement", "IfcSpace", "IfcSpatialZone", "IfcVirtualElement", "IfcAnnotation", "IfcGrid")
"""What is nothing that could hide."""
_BODIES = (None, "", "Body", "Body-FallBack", "Facetation", "Tessellation", "SurveyPoints")
_NO_SURFACES = ("Point", "PointCloud", "Curve", "Curve2D", "Curve3D", "Segment", "Annotation2D", "GeometricCurveSet", "Text",
                "LightSource")
"""Types of representations in which nothing hides."""
_KINDS = {"IfcSite": "ground"}
_STAND_IN = KINDS[-1]
_SCALE_NEAR_1 = 0.01
"""How far a map's scale factor may be from 1: those of projections are within 0.1 %."""
_SAME_UNIT = 5e-7
"""Share by which a stated unit may differ from that of the CRS: feet and US survey feet differ by 2e-6."""
_LOG_ENTRY = re.compile(r"^\[(?P<level>\w+)\] (?:\[(?P<code>[A-Z]+\d+)\] )?\[[^]]*\] (?:\{(?P<product>[^}]*)\} )?(?P<text>.*)$")
"""The first line of what IfcOpenShell logs: `[warning] [GEO170] [time] {GlobalId} text`."""
_LOSSES = re.compile("self-intersect|fail|unable|could not|cannot|invalid|ignor|skip|discard|omit|not found|not enough|empty|"
                     "overwriting|non-unique", re.IGNORECASE)
"""In warnings that tell of something that is not in the triangles."""
_LOOPS_LEFT_OUT = re.compile(r"(\d+) duplicate faces removed, (\d+) degenerate loops eliminated")
_ATTRIBUTES = re.compile(r"Expected (\d+) attribute values, found (\d+) for instance")
_LOG_LOCK = threading.Lock()
"""IfcOpenShell has one log."""


class Model(NamedTuple):
    """What `Scene.from_arrays` takes."""

    vertices: Numbers
    faces: npt.NDArray[np.int64]
    object_of: npt.NDArray[np.int64]
    objects: list[SceneObject]
    place: Georeference | None
    ledger: list[Missing]


def _lost(log: str) -> list[str]:
    """What of the model is missing in its triangles, by IfcOpenShell's log. Faces that are there twice and those without
    area are no loss: as many as the log counts."""
    lost, loops, faces = [], 0, 0
    lines = log.splitlines()
    for line, following in zip(lines, [*lines[1:], ""]):
        entry = _LOG_ENTRY.match(line)
        if entry is None:  # the last entry goes on
            continue
        level, code, text = entry["level"].lower(), entry["code"], entry["text"]
        about = entry["product"] or (code if _LOG_ENTRY.match(following) else following[:80]) or level
        told = f"{text} ({about})"
        if counted := _LOOPS_LEFT_OUT.match(text):
            loops += sum(map(int, counted.groups()))
        elif code == "GEO159":  # the loop of a face
            if loops == 0:
                lost.append(told)
            loops = max(0, loops - 1)
        elif code == "GEO162":  # a face without loops, which GEO198 tells again
            faces += 1
        elif code == "GEO198" and faces > 0:
            faces -= 1
        elif code == "GEO185":  # a triangle without area
            continue
        elif counted := _ATTRIBUTES.match(text):  # more than there should be mean nothing
            lost += [told] if int(counted[2]) < int(counted[1]) else []
        elif level in ("error", "fatal") or (level == "warning" and _LOSSES.search(text)):
            lost.append(told)
    return lost


def _opened(file: str) -> Any:
    ifc = require("ifcopenshell", "ifc")
    if not os.path.isfile(file):
        raise input_error("file-not-found", "there is no such file", file, "check the name")
    try:
        return ifc.open(file)
    except Exception as error:  # its own class, OSError, and others of its parser
        raise input_error("mesh-syntax", f"IfcOpenShell cannot read the file: {str(error) or type(error).__name__}", file,
                          "export it again as IFC 2x3, 4 or 4x3, in the STEP format (.ifc)") from None


def _bodies(file: Any, without: list[Missing]) -> dict[str, Any]:
    """Products that have a body, by their GlobalIds. `without` gets those that have representations, and no body."""
    found = {}
    for product in file.by_type("IfcProduct"):
        shape = product.Representation
        if shape is None or any(product.is_a(name) for name in NOT_BUILT):
            continue
        if any(one.RepresentationIdentifier in _BODIES and one.RepresentationType not in _NO_SURFACES
               for one in shape.Representations):
            found[product.GlobalId] = product
        else:
            kinds = sorted({f"{one.RepresentationIdentifier or 'no name'} ({one.RepresentationType})"
                            for one in shape.Representations})
            without.append(Missing(_identity(product), product.is_a(), f"it has no body with surfaces, but {', '.join(kinds)}"))
    return found


def _identity(product: Any) -> SceneObject:
    return SceneObject(product.Name or product.is_a(), product.GlobalId, _KINDS.get(product.is_a(), "building"))


def _curved(vertices: Numbers, faces: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """The facets that may be of a curved surface: their plane turns towards that of a neighbour by less than a radian. (The
    mesher turns by half of that at most.) Those of flat walls that meet at such an angle are among them."""
    places, number = np.unique(np.round(vertices, 7), axis=0, return_inverse=True)
    faces = number.reshape(-1)[faces]
    normals = np.cross(places[faces[:, 1]] - places[faces[:, 0]], places[faces[:, 2]] - places[faces[:, 0]])
    lengths = np.linalg.norm(normals, axis=1)
    facets = np.flatnonzero(lengths > 0)
    normals[facets] /= lengths[facets, None]
    edges = np.sort(np.concatenate([faces[facets][:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
    of = np.tile(facets, 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, of = edges[order], of[order]
    same = np.flatnonzero((edges[1:] == edges[:-1]).all(axis=1))
    first, second = of[same], of[same + 1]
    turn = np.abs((normals[first] * normals[second]).sum(axis=1))
    bent = (turn < np.cos(1e-4)) & (turn > np.cos(1.0))
    return np.unique(np.concatenate([first[bent], second[bent]]))


def _thickened(vertices: Numbers, faces: npt.NDArray[np.int64], by_m: float) -> tuple[Numbers, npt.NDArray[np.int64]]:
    """Closed boxes, one about each facet, that hold all that is no farther than `by_m` from it. They stand on the side on
    which they are smallest; half of a rectangle has that rectangle."""
    rows, corner = np.arange(len(faces)), vertices[faces]
    sides = np.roll(corner, -1, axis=1) - corner
    tips = np.roll(corner, -2, axis=1) - corner
    lengths = np.linalg.norm(sides, axis=2)
    ends = (tips * sides).sum(axis=2) / lengths
    longest = lengths == lengths.max(axis=1, keepdims=True)
    widths = (np.maximum(lengths, ends) - np.minimum(0, ends)) / lengths * (1 + 1e-6 * longest)
    best = widths.argmin(axis=1)
    start, length, end = corner[rows, best], lengths[rows, best, None], ends[rows, best, None]
    along = sides[rows, best] / length
    across = tips[rows, best] - end * along
    height = np.linalg.norm(across, axis=1, keepdims=True)
    across = across / height
    normal = np.cross(along, across)
    low, high = np.minimum(0, end) - by_m, np.maximum(length, end) + by_m
    corners = [start + along * (high if i & 1 else low) + across * (height + by_m if i & 2 else -by_m)
               + normal * (by_m if i & 4 else -by_m) for i in range(8)]
    box = np.array([(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
                    (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)])
    return np.stack(corners, axis=1).reshape(-1, 3), (rows[:, None, None] * 8 + box).reshape(-1, 3)


def _shapes(file: Any, deflection_m: float) -> dict[str, tuple[Numbers, npt.NDArray[np.int64]]]:
    """Vertices, metres, and faces of each product, in the axes of the file."""
    geom = require("ifcopenshell.geom", "ifc")
    settings = geom.settings()
    settings.set("use-world-coords", True)
    settings.set("mesher-linear-deflection", deflection_m)
    settings.set("mesher-angular-deflection", 0.5)
    known = {declaration for declaration in NOT_BUILT if _is_known(file, declaration)}
    shapes: dict[str, tuple[Numbers, npt.NDArray[np.int64]]] = {}
    steps = geom.iterator(settings, file, 1, exclude=sorted(known))
    more = steps.initialize()
    while more:
        shape = steps.get()
        vertices = np.array(shape.geometry.verts, np.float64).reshape(-1, 3)
        faces = np.array(shape.geometry.faces, np.int64).reshape(-1, 3)
        if len(faces):
            if shape.guid in shapes:  # of several representations
                before = shapes[shape.guid]
                faces = np.concatenate([before[1], faces + len(before[0])])
                vertices = np.concatenate([before[0], vertices])
            shapes[shape.guid] = vertices, faces
        more = steps.next()
    return shapes


def _is_known(file: Any, name: str) -> bool:
    """Whether the file's version of IFC has that class."""
    try:
        file.by_type(name)
    except RuntimeError:
        return False
    return True


def _conversion(file: Any) -> Any:
    """The file's map conversion; None where it has none."""
    found = file.by_type("IfcMapConversion") if _is_known(file, "IfcMapConversion") else []
    if len(found) > 1:
        raise input_error("value-unsupported", f"the file has {len(found)} map conversions", "IfcMapConversion",
                          "pass georeference=False, or export the model with one")
    return found[0] if found else None


def _unit_m(unit: Any) -> float:
    """Metres in a unit of length."""
    prefixes = {None: 1.0, "KILO": 1e3, "CENTI": 1e-2, "MILLI": 1e-3}
    if unit.is_a("IfcSIUnit") and unit.Name == "METRE" and unit.Prefix in prefixes:
        return prefixes[unit.Prefix]
    if unit.is_a("IfcConversionBasedUnit"):
        factor = unit.ConversionFactor
        return float(factor.ValueComponent.wrappedValue) * _unit_m(factor.UnitComponent)
    raise input_error("value-unsupported", f"the unit of the map is {unit}", "IfcProjectedCRS", "pass georeference=False")


def _map_unit_m(text: str, stated: Any) -> float:
    """Metres in the unit of the map's CRS, which the file's own must be, too."""
    pyproj = require("pyproj", "ifc")
    try:
        crs = pyproj.CRS(text)
    except pyproj.exceptions.ProjError as error:
        raise _no_crs(text, error) from None
    while crs.is_bound:
        crs = crs.source_crs
    if not crs.is_projected:
        raise input_error("value-unsupported", f"the map {crs.name!r} is no projection, with eastings and northings",
                          "IfcProjectedCRS", "pass crs='EPSG:...', or georeference=False")
    units_m = [axis.unit_conversion_factor for axis in crs.axis_info]
    if not all(abs(unit_m / units_m[0] - 1) <= _SAME_UNIT for unit_m in units_m):
        raise input_error("height-unknown", f"the axes of {crs.name!r} have different units, and the file has one for all",
                          "IfcProjectedCRS", "pass crs, of one whose heights have the unit of its eastings")
    if stated is not None and not abs(_unit_m(stated) / units_m[0] - 1) <= _SAME_UNIT:
        raise input_error("value-out-of-range", f"the map's unit is stated as {_unit_m(stated):.10g} m, and that of "
                          f"{crs.name!r} is {units_m[0]:.10g} m", "IfcProjectedCRS.MapUnit",
                          "mend the unit or the name of the map, or pass georeference=False")
    return float(units_m[0])


def _on_map(vertices: Numbers, conversion: Any, project_unit_m: float, unit_m: float) -> Numbers:
    """East and north in units of the map's CRS, and heights in metres."""
    if conversion.is_a("IfcMapConversionScaled"):
        raise input_error("value-unsupported", "the file's map conversion has a factor for each axis", "IfcMapConversionScaled",
                          "pass georeference=False")
    scale = 1.0 if conversion.Scale is None else conversion.Scale / project_unit_m * unit_m
    if not abs(scale - 1) <= _SCALE_NEAR_1:
        raise input_error("value-out-of-range", f"the map conversion makes {scale:g} m of one metre of the model",
                          "IfcMapConversion.Scale", "mend the scale (the model's unit in units of the map), or pass "
                          "georeference=False")
    along = np.array([conversion.XAxisAbscissa, conversion.XAxisOrdinate], object)
    x, y = (1.0, 0.0) if None in along else along.astype(float)
    length = float(np.hypot(x, y))
    if not length > 0:
        raise input_error("direction-invalid", "the map conversion's x axis has no length", "IfcMapConversion",
                          "pass georeference=False")
    turn = np.array([[x, y], [-y, x]]) / length * scale / unit_m
    flat = vertices[:, :2] @ turn + [conversion.Eastings, conversion.Northings]
    return np.column_stack([flat, vertices[:, 2] + conversion.OrthogonalHeight * unit_m])


def _in_frame(vertices: Numbers, count: int, file: Any, conversion: Any, crs: Any) -> tuple[Numbers, Georeference]:
    """In the scene's frame, about the middle of the model: of the first `count` vertices. The others stand in."""
    unit_m = float(require("ifcopenshell.util.unit", "ifc").calculate_unit_scale(file))
    text = crs_text(crs if crs is not None else conversion.TargetCRS.Name)
    placed = _on_map(vertices, conversion, unit_m, _map_unit_m(text, conversion.TargetCRS.MapUnit))
    middle = (placed[:count, :2].min(axis=0) + placed[:count, :2].max(axis=0)) / 2
    longitude, latitude = _degrees(middle, text)
    flat = _core.plan_from_crs(Georeference(latitude, longitude), text, np.ascontiguousarray(placed[:, :2]))
    vertical = conversion.TargetCRS.VerticalDatum or ""
    return np.column_stack([flat, placed[:, 2]]), Georeference(latitude, longitude, str(vertical), text[:40])


def _degrees(point: Numbers, crs: str) -> tuple[float, float]:
    """Longitude and latitude of a point of a CRS."""
    pyproj = require("pyproj", "ifc")
    try:
        to_degrees = pyproj.Transformer.from_crs(crs, WGS84, always_xy=True)
        longitude, latitude = to_degrees.transform(point[0], point[1], errcheck=True)
    except pyproj.exceptions.ProjError as error:  # CRSError is one
        raise _no_crs(crs, error) from None
    return float(longitude), float(latitude)


def _no_crs(crs: str, problem: Exception) -> Error:
    return input_error("crs-unknown", f"PROJ cannot place the model on the map {crs!r}: {str(problem)[:200]}", "IfcProjectedCRS",
                       "pass crs='EPSG:...', or georeference=False")


def _read(file_name: str, deflection_m: float) -> tuple[Any, dict[str, tuple[Numbers, npt.NDArray[np.int64]]], list[str]]:
    """The file, the triangles of its products, and what of it is not in them."""
    ifc = require("ifcopenshell", "ifc")
    with _LOG_LOCK:
        ifc.ifcopenshell_wrapper.set_log_format_text()
        ifc.get_log()
        file = _opened(file_name)
        shapes = _shapes(file, deflection_m)
        return file, shapes, _lost(ifc.get_log())


def model_of(file_name: str, deflection_m: float, georeference: Any, crs: Any, allow_missing: Any,
             policy: Any = "block") -> Model:
    """The triangles of a building model: see `Scene.from_ifc`."""
    is_placed, is_missing_allowed = flag(georeference, "georeference"), flag(allow_missing, "allow_missing")
    if not 0 < deflection_m <= 1:
        raise input_error("value-out-of-range", f"deflection_m is {deflection_m:g}", "deflection_m", "give metres, up to 1")
    if policy not in ("block", "warn", "refuse"):
        raise input_error("unknown-choice", f"missing is {policy!r}", "missing", "choose block, warn or refuse")
    file, shapes, lost = _read(file_name, deflection_m)
    ledger: list[Missing] = []
    wanted = _bodies(file, ledger)
    missing = [guid for guid in wanted if guid not in shapes]
    if missing and not is_missing_allowed:
        named = ", ".join(f"{wanted[guid].is_a()} {wanted[guid].Name or ''} ({guid})" for guid in missing[:5])
        raise input_error("mesh-unsupported", f"IfcOpenShell made no triangles of {len(missing)} products: {named}", file_name,
                          "mend them, or pass allow_missing=True: then they hide nothing")
    if lost and not is_missing_allowed:
        raise input_error("mesh-unsupported", f"IfcOpenShell could not convert parts of the model: {'; '.join(lost[:5])[:1000]}",
                          file_name, "mend them, or pass allow_missing=True: then they hide nothing")
    if not shapes:
        raise input_error("mesh-empty", "the file has no product with a body", file_name, "export the model with its geometry")
    ledger += [Missing(_identity(wanted[guid]), wanted[guid].is_a(), "IfcOpenShell made no triangles of it")
               for guid in missing]
    ledger += [Missing(SceneObject(""), "part of the model", f"IfcOpenShell could not convert it: {one[:300]}") for one in lost]
    objects = [_identity(file.by_guid(guid)) for guid in shapes]
    count = sum(len(vertices) for vertices, _ in shapes.values())
    _thicken(shapes, objects, ledger, deflection_m, policy == "block")
    if ledger and policy == "refuse":
        first = ledger[0]
        raise input_error("scene-incomplete", f"{len(ledger)} things are not built as they stand; the first: "
                          f"{first.object.name} {first.what}: {first.reason}", file_name, "pass missing='block', or mend them")
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in shapes.values()][:-1])
    vertices = np.concatenate([vertices for vertices, _ in shapes.values()])
    faces = np.concatenate([faces + start for (_, faces), start in zip(shapes.values(), starts)])
    object_of = np.repeat(np.arange(len(shapes)), [len(faces) for _, faces in shapes.values()])
    conversion = _conversion(file) if is_placed else None
    place = None
    if conversion is not None:
        vertices, place = _in_frame(vertices, count, file, conversion, crs)
    return Model(vertices, faces, object_of, objects, place, _with_boxes(ledger, vertices[faces], object_of, objects))


def _thicken(shapes: dict[str, tuple[Numbers, npt.NDArray[np.int64]]], objects: list[SceneObject], ledger: list[Missing],
             deflection_m: float, holds: bool) -> None:
    """Adds what holds the curved surfaces of each product, as an object of its own, and says so."""
    for number, (guid, (vertices, faces)) in enumerate(list(shapes.items())):
        curved = _curved(vertices, faces)
        if not len(curved):
            continue
        ledger.append(Missing(objects[number], "curved surfaces", f"their facets lie up to {deflection_m:g} m from them",
                              None, len(objects) if holds else None,
                              f"the facets, {deflection_m:g} m thicker on each side" if holds else ""))
        if holds:
            shapes[f"{guid} thicker"] = _thickened(vertices, faces[curved], deflection_m)
            objects.append(SceneObject(objects[number].name, guid, _STAND_IN))


def _with_boxes(ledger: list[Missing], corners: Numbers, object_of: npt.NDArray[np.int64],
                objects: list[SceneObject]) -> list[Missing]:
    """Where what has triangles is."""
    result = []
    for missing in ledger:
        of = [i for i, one in enumerate(objects) if one.source_id and one.source_id == missing.object.source_id]
        if missing.stand_in is not None:
            of = [missing.stand_in]
        own = corners[np.isin(object_of, of)].reshape(-1, 3)
        result.append(missing._replace(box=[*own.min(axis=0).tolist(), *own.max(axis=0).tolist()]) if len(own) else missing)
    return result
