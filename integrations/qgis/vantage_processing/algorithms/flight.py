"""A flight that sees the targets of a mission, or a plan that there is already, as layers."""

import numpy as np
from qgis.core import (QgsGeometry, QgsLineString, QgsPoint, QgsProcessing, QgsProcessingException,
                       QgsProcessingOutputNumber, QgsProcessingParameterBoolean, QgsProcessingParameterEnum,
                       QgsProcessingParameterFeatureSink, QgsProcessingParameterFile,
                       QgsProcessingParameterFileDestination, QgsProcessingParameterNumber,
                       QgsProcessingParameterPoint, QgsProcessingParameterString, QgsWkbTypes)

from ..engine import Progress, stop_if_canceled, tell_notes, vt
from ..places import Frame
from .base import VantageAlgorithm, fields_of, is_given
from .request import place_of
from .volume import add_crs, tell_scene

LEGS = {"leg": int, "begin_m": float, "end_m": float, "speed_m_s": float, "hold_s": float, "sees": str}
WAYPOINTS = {"number": int, "at_m": float, "z_m": float, "hold_s": float, "sees": str}
STRETCHES = {"target": str, "state": str, "what": str, "begin_m": float, "end_m": float, "begin_s": float, "end_s": float}
_HEIGHTS = ("", "sea", "ellipsoid", "ground", "home", "scene")
_NUMBERS = {
    "PLAN_HEIGHT": ("height_m", "Height of a plan without heights (m)", "Metres, of all positions that have none."),
    "HOME_Z": ("home_z_m", "Height of the home (m)", "Metres above the zero of the scene's heights. Empty: the ground there."),
    "UNDULATION": ("undulation_m", "Sea level above the ellipsoid there (m)",
                   "Metres, for plans with heights above the ellipsoid or the sea where the scene has others, and for a plan that "
                   "is written as GeoJSON."),
    "RETURN_HEIGHT": ("return_height_m", "Height of the way back (m)", "Metres above the home, where the plan leaves it open."),
    "LOITER_RADIUS": ("loiter_radius_m", "Radius of circles (m)", "Metres, where the plan leaves it to the vehicle."),
}


class FlightAlgorithm(VantageAlgorithm):
    NAME = "flight"
    TITLE = "Flight that sees the targets"
    SUMMARY = "The shortest flight that is found through all volumes of a mission, or a plan that is judged, as lines with z"
    HELP = ("Without a plan: the shortest flight that is found that sees every target of the mission, by what it says under "
            "tour. With a plan of a ground station: that one, read into the scene. Either way it is checked exactly when each "
            "target is seen whole.")

    def initAlgorithm(self, configuration=None):  # noqa: N802
        self.add(QgsProcessingParameterFile("MISSION", "Mission file", extension="yaml"),
                 "A mission file of vantage (.yaml) with the scene, the targets, the limits and, for a new flight, tour.")
        self.add(QgsProcessingParameterFile("PLAN", "Plan of a ground station", optional=True),
                 "A flight to read: .plan of QGroundControl, .waypoints, KML, KMZ, GPX, GeoJSON or CSV. Empty: a new flight is "
                 "searched for.")
        self.add(QgsProcessingParameterBoolean("BOUND", "Bound the length of a new flight", defaultValue=False),
                 "Also finds a length that no flight which sees all targets is below. It takes longer than the flight.")
        self._add_plan_options()
        add_crs(self)
        lines, points = QgsProcessing.TypeVectorLine, QgsProcessing.TypeVectorPoint
        self.add(QgsProcessingParameterFeatureSink("LEGS", "Legs of the flight", lines),
                 "LineStringZ, one for each leg, in order: leg, begin_m and end_m along the flight, speed_m_s (empty where it is "
                 "not stated), hold_s at its end, and sees: targets that are seen whole on all of it. z is metres above the zero "
                 "of the scene's heights.")
        self.add(QgsProcessingParameterFeatureSink("WAYPOINTS", "Waypoints", points, optional=True),
                 "PointZ, where legs meet: number, at_m along the flight, z_m, hold_s, and sees: targets that are seen whole "
                 "from there.")
        self.add(QgsProcessingParameterFeatureSink("STRETCHES", "When each target is seen", lines, optional=True,
                                                   createByDefault=False),
                 "LineStringZ: target, state (seen, hidden, out_of_range, behind, limit, outside), what hides it, begin_m and "
                 "end_m along the flight, begin_s and end_s after its begin. Stretches without a length are not in it.")
        self.add(QgsProcessingParameterFileDestination(
            "PLAN_OUT", "New plan", "QGroundControl (*.plan);;Mission Planner (*.waypoints);;KML (*.kml);;DJI (*.kmz);;"
            "GPX (*.gpx);;GeoJSON (*.geojson);;CSV (*.csv)", optional=True, createByDefault=False),
                 "A new flight as a plan for ground stations.")
        self.addOutput(QgsProcessingOutputNumber("LENGTH_M", "Length (m)"))
        self.addOutput(QgsProcessingOutputNumber("BOUND_M", "No flight is shorter than (m)"))
        self.addOutput(QgsProcessingOutputNumber("SEEN_COUNT", "Number of targets that are seen"))

    def _add_plan_options(self):
        self.add(QgsProcessingParameterString("TRACK", "Track of the plan", optional=True),
                 "Of several tracks, lines or routes the name or the number of the one that is meant.", advanced=True)
        self.add(QgsProcessingParameterEnum("PLAN_HEIGHTS", "Heights of the plan are above",
                                            ["what the plan says", "sea level", "the ellipsoid", "the ground", "the home",
                                             "the zero of the scene"], defaultValue=0),
                 "What heights of an unknown level are measured from.", advanced=True)
        self.add(QgsProcessingParameterPoint("HOME", "Place of takeoff", optional=True),
                 "Where the plan does not say it. Without a CRS: longitude, latitude in degrees.", advanced=True)
        for name, (_, title, text) in _NUMBERS.items():
            self.add(QgsProcessingParameterNumber(name, title, QgsProcessingParameterNumber.Double, optional=True), text,
                     advanced=True)

    def run_in_vantage(self, parameters, context, feedback):
        progress = Progress(feedback)
        mission = vt.Mission.read(self.parameterAsString(parameters, "MISSION", context), progress)
        frame = Frame(mission.scene)
        crs = frame.chosen(self.parameterAsCrs(parameters, "CRS", context))
        tour = None
        if is_given(parameters, "PLAN"):
            flight = self._read(parameters, context, mission, progress)
            check = vt.check(mission, flight, progress=progress)
        else:
            tour = vt.tour(mission, bound=self.parameterAsBool(parameters, "BOUND", context), progress=progress)
            flight, check = tour.flight, tour.check(progress=progress)
        stop_if_canceled(feedback)
        tell_scene(feedback, mission.scene, crs)
        _tell(feedback, flight, tour, check)
        layers = [(name, (fields_of(columns), kind, crs), list(rows_of(flight, check, frame, crs)))
                  for name, columns, kind, rows_of in (("LEGS", LEGS, QgsWkbTypes.LineStringZ, _legs),
                                                       ("WAYPOINTS", WAYPOINTS, QgsWkbTypes.PointZ, _waypoints),
                                                       ("STRETCHES", STRETCHES, QgsWkbTypes.LineStringZ, _stretches))]
        out = {}
        for name, layer, rows in layers:
            out |= self.write(parameters, name, context, layer, rows)
        out |= self._write_plan(parameters, context, feedback, tour)
        bound = None if tour is None or tour.bound is None else tour.bound.length_m
        return out | {"LENGTH_M": flight.length_m, "BOUND_M": bound,
                      "SEEN_COUNT": sum(bool(target.seen) for target in check.targets)}

    def _read(self, parameters, context, mission, progress):
        if is_given(parameters, "PLAN_OUT"):
            raise QgsProcessingException("Both PLAN and PLAN_OUT are given: only new flights are written as a plan.\n  what to "
                                         "do: leave one of them empty")
        options = {key: self.number(parameters, name, context) for name, (key, _, _) in _NUMBERS.items()}
        heights = _HEIGHTS[self.parameterAsEnum(parameters, "PLAN_HEIGHTS", context)]
        return vt.Flight.read(mission, self.parameterAsString(parameters, "PLAN", context),
                              track=self.parameterAsString(parameters, "TRACK", context), heights=heights or None,
                              home=place_of(self, parameters, "HOME", context), progress=progress, **options)

    def _write_plan(self, parameters, context, feedback, tour):
        if tour is None or not is_given(parameters, "PLAN_OUT"):
            return {}
        file = self.parameterAsFileOutput(parameters, "PLAN_OUT", context)
        tell_notes(feedback, tour.write(file, undulation_m=self.number(parameters, "UNDULATION", context)))
        return {"PLAN_OUT": file}


def _tell(feedback, flight, tour, check):
    tell_notes(feedback, flight.notes)
    if tour is None:
        tell_notes(feedback, check.failures)
    else:
        tell_notes(feedback, tour.notes)
        for one in tour.left_out:
            why = "no position of its volume may be flown to" if one.kind == "no_place" else "no way to it was found"
            feedback.pushWarning(f"{one.name} is left out: {why}" + (f"; {one.obstacle}" if one.obstacle else ""))
        if tour.bound is not None:
            feedback.pushInfo(f"{tour.length_m:.1f} m; no flight that sees all is shorter than {tour.bound.length_m:.1f} m")
    tell_notes(feedback, check.notes)


def _seen_on(check, begin_m, end_m):
    """Targets that are seen whole on all of a stretch; the spans of `check` are its own, in metres along the flight."""
    return "; ".join(target.name for target in check.targets
                     if any(span.begin_m <= begin_m and end_m <= span.end_m for span in target.seen))


def _positions(flight, frame, crs):
    """(n, 3): in a CRS, heights as they are."""
    return np.column_stack([frame.out_of(flight.positions[:, :2], crs, "the flight"), flight.positions[:, 2]])


def _line(positions):
    return QgsGeometry(QgsLineString(*positions.T.tolist()))


def _legs(flight, check, frame, crs):
    places, along, speeds, holds = _positions(flight, frame, crs), check.at_m.tolist(), flight.speed_m_s, flight.hold_s
    for i in range(len(flight) - 1):
        speed = float(speeds[i + 1])
        yield _line(places[i:i + 2]), [i, along[i], along[i + 1], None if np.isnan(speed) else speed, float(holds[i + 1]),
                                       _seen_on(check, along[i], along[i + 1])]


def _waypoints(flight, check, frame, crs):
    for i, (place, at, hold) in enumerate(zip(_positions(flight, frame, crs).tolist(), check.at_m.tolist(),
                                              flight.hold_s.tolist())):
        yield QgsGeometry(QgsPoint(*place)), [i, at, place[2], hold, _seen_on(check, at, at)]


def _stretches(flight, check, frame, crs):
    rows = []
    for target in check.targets:
        rows += [(target.name, "seen", "", span) for span in target.seen]
        rows += [(target.name, reason.kind, reason.name, span) for reason in target.not_seen for span in reason.spans]
    for name, state, what, span in rows:
        places = flight.between(span.begin_m, span.end_m)
        if len(places) < 2:
            continue
        places = np.column_stack([frame.out_of(places[:, :2], crs, "the flight"), places[:, 2]])
        times = [None if not np.isfinite(time) else float(time) for time in (span.begin_s, span.end_s)]
        yield _line(places), [name, state, what, span.begin_m, span.end_m, *times]
