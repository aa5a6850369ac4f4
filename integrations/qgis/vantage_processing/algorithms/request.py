"""What is asked: a mission file, or a scene file with a layer of targets and limits. The same parameters everywhere."""

import os

import numpy as np
from qgis.core import (QgsCoordinateReferenceSystem, QgsFeatureRequest, QgsProcessing, QgsProcessingException,
                       QgsProcessingFeatureSource, QgsProcessingParameterCrs, QgsProcessingParameterEnum,
                       QgsProcessingParameterFeatureSource, QgsProcessingParameterField, QgsProcessingParameterFile,
                       QgsProcessingParameterNumber, QgsProcessingParameterPoint, QgsReferencedPointXY,
                       QgsWkbTypes)

from ..engine import vt
from ..places import Frame, degrees_of, text_of
from .base import is_given

_MAPS = (".osm", ".osm.gz", ".osm.bz2", ".pbf")
_RASTERS = (".tif", ".tiff", ".hgt", ".hgt.zip", ".asc", ".vrt", ".img")
_WITHOUT_MISSION = ("SCENE", "CENTER", "RADIUS", "SCENE_CRS", "ORIGIN", "TARGETS", "TARGET_Z", "TARGET_Z_FIELD",
                    "TARGET_NAME_FIELD", "RANGE", "LOWEST", "HIGHEST", "CLEARANCE")
COMBINE = ("all", "any", "each")
_COMBINE_TEXT = ["All targets must be seen", "One of the targets must be seen", "A volume for each target"]
_UP = (None, "y")


def _optional_number(name, text, *, least=None):
    limits = {} if least is None else {"minValue": least}
    return QgsProcessingParameterNumber(name, text, QgsProcessingParameterNumber.Double, optional=True, **limits)


def add_request(algorithm, *, combine):
    """The parameters that say what is asked. `combine`: what can be asked of several targets, the first of COMBINE."""
    add = algorithm.add
    add(QgsProcessingParameterFile("MISSION", "Mission file", extension="yaml", optional=True),
        "A mission file of vantage (.yaml), which says all of the scene, the target and the limits. Instead of the scene file "
        "and all that follows up to the clearance.")
    add(QgsProcessingParameterFile("SCENE", "Scene file", optional=True),
        "What may hide the target: an OpenStreetMap extract (.osm, .osm.gz, .osm.pbf), CityJSON, a mesh (.obj, .ply, .stl, "
        ".gltf, .glb), a raster of heights (.tif and others), or a tileset.json of 3D Tiles.")
    _add_place(add)
    add(QgsProcessingParameterFeatureSource("TARGETS", "Targets", [QgsProcessing.TypeVectorPolygon], optional=True),
        "Polygons that must be seen whole. With z they lie there (metres, in one plane each; upright ones are facades); "
        "without z, and without a height below, on the ground. A polygon need not be convex, and may have holes. Without a CRS "
        "the layer is taken to be in the scene's frame.")
    add(_optional_number("TARGET_Z", "Height of the targets (m)"),
        "Metres above the zero of the scene's heights, for all corners. Empty: their own z, or else the ground.")
    add(QgsProcessingParameterField("TARGET_Z_FIELD", "Field with the height of each target (m)", None, "TARGETS",
                                    QgsProcessingParameterField.Numeric, optional=True),
        "The same, for each target: metres above the zero of the scene's heights.", advanced=True)
    add(QgsProcessingParameterField("TARGET_NAME_FIELD", "Field with the name of each target", None, "TARGETS", optional=True),
        "For the results and for messages. Empty: the number of the feature.", advanced=True)
    if len(combine) > 1:
        add(QgsProcessingParameterEnum("COMBINE", "Several targets", _COMBINE_TEXT[:len(combine)], defaultValue=0),
            "What is asked of several targets. It does not count with a mission file, which says it itself.")
    add(_optional_number("RANGE", "Range of the sensor (m)", least=0.0),
        "Metres from the viewpoint to every point of the target, at most. Required without a mission file.")
    add(_optional_number("LOWEST", "Lowest height (m)"),
        "Metres; where the vehicle may fly. Give both heights or none.")
    add(_optional_number("HIGHEST", "Highest height (m)"), "Metres; where the vehicle may fly. Give both heights or none.")
    add(QgsProcessingParameterEnum("HEIGHTS_FROM", "Heights are measured from", ["the zero of the scene", "the ground"],
                                   defaultValue=0),
        "What the lowest and the highest height are measured from. The ground: of a map, a raster, or a mesh's object named "
        "ground.")
    add(_optional_number("CLEARANCE", "Clearance (m)", least=0.0),
        "Metres that the vehicle stays away from everything but the ground. Empty: no limit.", advanced=True)


def _add_place(add):
    add(QgsProcessingParameterPoint("CENTER", "Middle of the part that is used", optional=True),
        "Of a map, a raster or a tileset, with the radius. Without a CRS: longitude, latitude in degrees. Empty: all of the "
        "file.")
    add(_optional_number("RADIUS", "Radius of that part (m)", least=0.0),
        "Metres about the middle. Buildings outside of it hide nothing: take it larger than the range.")
    add(QgsProcessingParameterCrs("SCENE_CRS", "CRS of the scene's mesh", optional=True),
        "Of x and y of a mesh in map coordinates. Maps, rasters and CityJSON say it themselves.", advanced=True)
    add(QgsProcessingParameterPoint("ORIGIN", "Origin of the scene's mesh", optional=True),
        "Of a mesh in metres about a known place: where that is. Without a CRS: longitude, latitude in degrees.", advanced=True)
    add(QgsProcessingParameterEnum("UP", "Axis of a mesh that points up", ["as the file says, or z", "y"], defaultValue=0),
        "Of a mesh whose file does not say it, such as OBJ.", advanced=True)


def read_request(algorithm, parameters, context, progress):
    """The mission that is asked for, and the frame of its scene.

    Args:
        progress: engine.Progress.

    Returns:
        a vantage.Mission, a places.Frame.

    Raises:
        QgsProcessingException: parameters that do not go together, or that are missing. vantage.Error: all else.
    """
    if is_given(parameters, "MISSION"):
        besides = [name for name in _WITHOUT_MISSION if is_given(parameters, name)]
        if besides:
            raise QgsProcessingException(f"Both a mission file and {', '.join(besides)} are given.\n  what to do: write them in "
                                         "the mission file, or leave out the mission file")
        mission = vt.Mission.read(algorithm.parameterAsString(parameters, "MISSION", context), progress)
        return mission, Frame(mission.scene)
    missing = [name for name in ("SCENE", "TARGETS", "RANGE") if not is_given(parameters, name)]
    if missing:
        raise QgsProcessingException(f"There is no mission file, and {', '.join(missing)} is missing.\n  what to do: give a "
                                     "mission file, or a scene file, targets and a range")
    scene = _scene(algorithm, parameters, context, progress)
    frame = Frame(scene)
    targets = _targets(algorithm, parameters, context, frame)
    has_choice = algorithm.parameterDefinition("COMBINE") is not None
    combine = COMBINE[algorithm.parameterAsEnum(parameters, "COMBINE", context)] if has_choice else "all"
    mission = vt.Mission.of(scene, targets, max_range=algorithm.number(parameters, "RANGE", context),
                            navigation=_navigation(algorithm, parameters, context),
                            combine=combine if len(targets) > 1 else "all", progress=progress)
    return mission, frame


def place_of(algorithm, parameters, name, context):
    """(latitude, longitude) of a point parameter; None where it is not given."""
    if not is_given(parameters, name):
        return None
    degrees = QgsCoordinateReferenceSystem("EPSG:4326")
    point = algorithm.parameterAsPoint(parameters, name, context, degrees)
    value, crs = parameters[name], algorithm.parameterAsPointCrs(parameters, name, context)
    has_crs = isinstance(value, QgsReferencedPointXY) or isinstance(value, str) and "[" in value
    if not has_crs or not crs.isValid() or crs == degrees:
        return point.y(), point.x()
    given = algorithm.parameterAsPoint(parameters, name, context)
    return degrees_of(given.x(), given.y(), crs, (point.y(), point.x()))


def _scene(algorithm, parameters, context, progress):
    file = algorithm.parameterAsString(parameters, "SCENE", context)
    name = os.path.basename(file).lower()
    center, radius = place_of(algorithm, parameters, "CENTER", context), algorithm.number(parameters, "RADIUS", context)
    origin = place_of(algorithm, parameters, "ORIGIN", context)
    crs = algorithm.parameterAsCrs(parameters, "SCENE_CRS", context)
    given = {"center": center, "radius": radius, "origin": origin, "up": _UP[algorithm.parameterAsEnum(parameters, "UP", context)],
             "crs": text_of(crs) if crs.isValid() else None}
    if name == "tileset.json":
        read, keys = vt.Scene.from_tiles, ("center", "radius", "crs")
    elif name.endswith(_MAPS):
        read, keys = vt.Scene.from_osm, ("center", "radius")
    elif name.endswith(_RASTERS):
        read, keys = vt.Scene.from_raster, ("center", "radius", "origin")
    else:
        read, keys = vt.Scene.from_mesh, ("origin", "crs", "up")
    unused = [key for key, value in given.items() if value is not None and key not in keys]
    if unused:
        words = {"center": "CENTER", "radius": "RADIUS", "origin": "ORIGIN", "up": "UP", "crs": "SCENE_CRS"}
        raise QgsProcessingException(f"{file}: {', '.join(words[key] for key in unused)} cannot be given for such a scene.\n"
                                     "  what to do: leave it empty")
    return read(file, **{key: given[key] for key in keys}, progress=progress)


def _navigation(algorithm, parameters, context):
    lowest, highest, clearance = (algorithm.number(parameters, name, context) for name in ("LOWEST", "HIGHEST", "CLEARANCE"))
    if (lowest is None) != (highest is None):
        raise QgsProcessingException("Only one of LOWEST and HIGHEST is given.\n  what to do: give both heights, or none")
    altitude = None
    if lowest is not None:
        level = ("z", "agl")[algorithm.parameterAsEnum(parameters, "HEIGHTS_FROM", context)]
        altitude = {level: [lowest, highest]}
    return None if altitude is None and clearance is None else vt.Navigation(altitude=altitude, clearance=clearance)


def _targets(algorithm, parameters, context, frame):
    """A vantage.Target for each feature of the layer."""
    source = algorithm.parameterAsSource(parameters, "TARGETS", context)
    if source is None:
        raise QgsProcessingException(algorithm.invalidSourceError(parameters, "TARGETS"))
    z_field = algorithm.parameterAsString(parameters, "TARGET_Z_FIELD", context)
    name_field = algorithm.parameterAsString(parameters, "TARGET_NAME_FIELD", context)
    z_of_all = algorithm.number(parameters, "TARGET_Z", context)
    if z_field and z_of_all is not None:
        raise QgsProcessingException("Both TARGET_Z and TARGET_Z_FIELD are given.\n  what to do: give one of them")
    targets = []
    # Upright polygons are not valid in plan, and may be targets: vantage judges them.
    for feature in source.getFeatures(QgsFeatureRequest(), QgsProcessingFeatureSource.FlagSkipGeometryValidityChecks):
        where = f"Targets, feature {feature.id()}"
        z = z_of_all if not z_field else _number_of(feature, z_field, where)
        name = str(feature[name_field]) if name_field and feature[name_field] else f"feature {feature.id()}"
        shape = _shape(feature.geometry(), source.sourceCrs(), frame, where)
        targets.append(vt.Target.from_shape(shape, z=z, name=name))
    if not targets:
        raise QgsProcessingException("The layer of targets has no features.\n  what to do: draw a polygon that is to be seen")
    return targets


def _number_of(feature, field, where):
    value = feature[field]
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        raise QgsProcessingException(f"{where}: the field {field} has no number.\n  what to do: fill it in, or leave the feature "
                                     "out")
    return float(value)


def _shape(geometry, crs, frame, where):
    """A polygon as GeoJSON has it, in the scene's frame; with z where it has one."""
    if geometry.isEmpty():
        raise QgsProcessingException(f"{where} has no geometry.\n  what to do: draw it, or leave it out")
    has_z = QgsWkbTypes.hasZ(geometry.wkbType())
    if QgsWkbTypes.isCurvedType(geometry.wkbType()):
        raise QgsProcessingException(f"{where} has curved sides.\n  what to do: run 'Segmentize by maximum distance' on it")
    polygons = []
    for part in geometry.constParts():
        rings = [part.exteriorRing(), *(part.interiorRing(number) for number in range(part.numInteriorRings()))]
        polygons.append([_ring(ring, has_z, crs, frame, where) for ring in rings])
    return {"type": "MultiPolygon", "coordinates": polygons}


def _ring(ring, has_z, crs, frame, where):
    corners = list(ring.vertices())
    xy = frame.into([(corner.x(), corner.y()) for corner in corners], crs, where)
    return np.column_stack([xy, [corner.z() for corner in corners]]) if has_z else xy
