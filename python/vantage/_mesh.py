"""What scenes, volumes and results have in common: triangles in the scene's frame, with a place on the earth."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._extras import require
from ._objects import KINDS
from ._place import FrameMap, Georeference, crs_of
from ._slice import Slice

if TYPE_CHECKING:
    import trimesh


class Cause(NamedTuple):
    """One reason for part of a volume's boundary."""

    kind: str
    """"scene", "range", "target_plane", "navigation" or "sensor"."""
    name: str
    area_m2: float
    object: int | None = None
    """index into `Scene.objects`, where it is an object"""
    source_id: str = ""
    object_kind: str = "other"


class Note(NamedTuple):
    """What to know before relying on a result."""

    code: str
    text: str


def poly_data(vertices: _arrays.Points, faces: _arrays.Faces, **arrays: Any) -> Any:
    """A pyvista mesh of triangles, with an array of values for each facet."""
    cells = np.column_stack([np.full(len(faces), 3, np.int64), faces.astype(np.int64)])
    mesh = require("pyvista", "plot").PolyData(np.array(vertices), cells)
    for name, values in arrays.items():
        if len(values) == len(faces):
            mesh.cell_data[name] = np.array(values)
    return mesh


class Triangles:
    """Of a scene or a volume."""

    @property
    def _triangles(self) -> Union[_core.Scene, _core.Volume]:
        raise NotImplementedError

    @property
    def vertices(self) -> _arrays.Points:
        """(n, 3) float64, metres; a read-only view."""
        return self._triangles.vertices

    @property
    def faces(self) -> _arrays.Faces:
        """(m, 3) uint32, indices into `vertices`; of a volume counter-clockwise seen from outside. A read-only view."""
        return self._triangles.faces

    @property
    def georeference(self) -> Georeference | None:
        """Where the frame lies on the earth, if it is known."""
        place = self._triangles.place
        return None if place is None else Georeference(*place)

    @property
    def crs(self) -> str | None:
        """The frame's x and y as a coordinate reference system, in PROJ's words; None where its place is not known. The frame of
        a scene of 3D Tiles is no map: then this is the map about its origin, which differs by some centimetres."""
        return crs_of(self._map)

    @property
    def _map(self) -> FrameMap | None:
        place, text = self.georeference, self._triangles.projection
        return None if place is None or text is None else FrameMap(text, place)


class Solid(Triangles):
    """What can be seen of a volume, also in the result that holds it. Points on the boundary belong to it."""

    @property
    def _solid(self) -> _core.Volume:
        raise NotImplementedError

    @property
    def _triangles(self) -> Union[_core.Scene, _core.Volume]:
        return self._solid

    @property
    def cause_of(self) -> npt.NDArray[np.uint32]:
        """(m,) uint32, the cause of each facet, an index into `causes`; a read-only view."""
        return self._solid.cause_of

    @property
    def causes(self) -> list[Cause]:
        """What bounds the view: objects of the scene, the range, limits."""
        return [Cause(*row[:5], KINDS[row[5]]) for row in self._solid.causes]

    @property
    def empty(self) -> bool:
        """Whether there is no position at all; `reason` says why."""
        return len(self.faces) == 0

    @property
    def outcome(self) -> str:
        """"computed", or why there is no volume: "out_of_range", "blocked_at_once", "outside_limits", "no_common_view"."""
        return self._solid.outcome

    @property
    def reason(self) -> str:
        """Why it is empty, a sentence."""
        return self._solid.reason

    @property
    def notes(self) -> list[Note]:
        """What to know before relying on it."""
        return [Note(*row) for row in self._solid.notes]

    @property
    def measures(self) -> dict[str, Any]:
        """vertices, facets, pieces, euler, closed, oriented, volume_m3, area_m2, bounds."""
        known: dict[str, Any] | None = self.__dict__.get("_measures")
        if known is None:
            known = self.__dict__["_measures"] = self._solid.measures()
        return known

    @property
    def volume_m3(self) -> float:
        """Cubic metres."""
        return self.measures["volume_m3"]

    @property
    def area_m2(self) -> float:
        """Of the surface, square metres."""
        return self.measures["area_m2"]

    @property
    def bounds(self) -> npt.NDArray[np.float64] | None:
        """(2, 3): the lowest and the highest coordinates, metres; None where it is empty."""
        bounds = self.measures["bounds"]
        return None if bounds is None else np.array(bounds)

    def slice(self, z: float) -> Slice:
        """The positions at one height: polygons with holes.

        Exact but for the rounding of corners, which goes either way: each lies within 2^-50 of the mesh's largest coordinate
        (0.001 nm for 1 km) of where the surface is at that height, and on the safe side of it or not. `contains` rounds
        nothing: ask it about positions that are so near to the outline.

        Corners of the mesh at exactly that height count as below it: a volume from 0 to 10 m has its whole base at 0, and
        nothing at 10.

        Args:
            z: metres, in the scene's frame.

        Returns:
            the slice; empty where the volume has nothing at that height.

        Raises:
            Error: the mesh is not closed, or the height is not finite.
        """
        height = _arrays.number(z, "z")
        return Slice(_core.slice_volume(self._solid, height), height, self.georeference, self.crs)

    def footprint(self) -> Slice:
        """The ground that lies under the volume, or over it: its outline seen from above, with holes; `z_m` is None.

        Outlines are rounded, inward or outward, to 2^-28 of half the volume's longer side: a micrometre for 600 m. That a
        place is in the footprint says that some height above it is in the volume, and not which.
        """
        return Slice(_core.footprint_of_volume(self._solid), None, self.georeference, self.crs)

    def _row(self) -> dict[str, Any]:
        bounds = self.bounds
        from_z, to_z = (float("nan"), float("nan")) if bounds is None else bounds[:, 2]
        provenance = self._solid.provenance
        return {"target": provenance["target"] if provenance else None, "outcome": self.outcome,
                "volume_m3": self.volume_m3, "surface_m2": self.area_m2, "min_z_m": from_z, "max_z_m": to_z}

    def to_geodataframe(self) -> Any:
        """One row for geopandas: the footprint, in the frame's CRS where its place is known, and target, outcome, volume_m3,
        surface_m2, footprint_m2, min_z_m, max_z_m."""
        footprint = self.footprint()
        row = {**self._row(), "footprint_m2": footprint.area_m2}
        return require("geopandas", "geo").GeoDataFrame([row], geometry=[footprint._on_map().to_shapely()], crs=self.crs)

    def to_trimesh(self) -> trimesh.Trimesh:
        """For trimesh, with the facets' causes as face_attributes["cause"]."""
        attributes = {"cause": np.array(self.cause_of)} if len(self.cause_of) else None
        return require("trimesh", "geo").Trimesh(np.array(self.vertices), np.array(self.faces, np.int64), process=False,
                                                 face_attributes=attributes)

    def to_pyvista(self) -> Any:
        """For pyvista, with an array "cause"."""
        return poly_data(self.vertices, self.faces, cause=self.cause_of)

    def to_manifold(self) -> Any:
        """For manifold3d."""
        manifold3d = require("manifold3d", "geo")
        return manifold3d.Manifold(manifold3d.Mesh64(np.array(self.vertices), np.array(self.faces, np.uint64)))

