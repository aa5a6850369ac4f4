// The independent check of a volume: ray casting that shares no geometry code with the engine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vantage/error.h"
#include "vantage/export.h"
#include "vantage/navigation.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {

struct VerifyOptions {
  std::size_t points =
      20000;  ///< > 0; viewpoints tried: half near the boundary, half over the volume and its surroundings
  int target_samples = 64;  ///< points of the target looked at besides its vertices and edge points
  std::uint64_t seed = 1;
  double depth_tolerance = 1e-6;  ///< a point counts as claimed wrongly, or wrongly not, when it lies deeper on the
                                  ///< wrong side of the surface than this times its distance to the target's centre
  double tolerance_m = 0.01;  ///< of the volume (ExactOptions): what lies within it of the range limit may be unclaimed
  std::vector<double> lift_m = {};  ///< how far each part of the target was raised (Volume::lift_m); empty: not at all;
                                    ///< no more is believed than its surface needs (lifts_needed_m)
  double rounding_m = 0;  ///< of the volume's file (Scene::rounding_m): what lies no deeper on the wrong side than
                          ///< this, besides what the depth tolerance allows, does not count. Not more is believed than
                          ///< numbers of single precision are rounded by: 2^-22 of the largest coordinate
};

struct VerifyReport {
  std::size_t points = 0;        ///< viewpoints tried
  std::size_t inside = 0;        ///< of those, claimed by the volume
  std::size_t rays = 0;          ///< shadow rays shot
  std::size_t undecided = 0;     ///< where it stayed open whether the camera can have all of the target in one picture,
                                 ///< and nothing else is wrong: counted as neither of the next two
  std::size_t over_claimed = 0;  ///< claimed, but part of the target is hidden or out of range, or a limit is broken
  std::size_t under_claimed = 0;  ///< not claimed, though everything sampled was visible, by more than the tolerance
  /// Of a VisibleShare: not claimed, though so much is seen, but not all: what cutting the target into cells costs. Not
  /// among the under-claimed.
  std::optional<std::size_t> share_unclaimed = std::nullopt;
  double worst_over_depth_m = 0;   ///< how deep inside the worst over-claimed point lies
  double worst_under_depth_m = 0;  ///< how far outside the worst under-claimed point lies
  double over_claim_bound = 1;     ///< with 95 % confidence at most this share of the volume is over-claimed (binomial)
  std::size_t bound_points = 0;    ///< the points that this rests on: uniform over the volume, independent
  Vec3 worst_over_point = Vec3::Zero();   ///< scene frame
  Vec3 worst_under_point = Vec3::Zero();  ///< scene frame
  std::string worst_over_cause;  ///< what is wrong there: the name of an object that hides the target, "max_range",
                                 ///< "target plane", a navigation limit, or a limit of the sensor by its name as in
                                 ///< vantage/query.h; empty when nothing is
  bool closed = false;           ///< every edge has an even number of facets, with vertices in one place taken for one,
  OpenEdges open_edges;          ///< those that have not: then no points are tried
  bool oriented = false;         ///< and is run as often in one direction as in the other
  std::size_t flat_facets = 0;   ///< facets without area, or with two corners in one place: they claim nothing, but
                                 ///< readers that weld vertices find the mesh open at them
  long euler = 0;
  std::uint64_t seed = 0;
  double lift_m = 0, rounding_m = 0;  ///< what was allowed: the largest lift of a part, as far as it is believed, and
                                      ///< the file's rounding
  /// As in ProofReport: verify_volume of a mission (vantage/result.h) tells it.
  std::string scene_incomplete = {};

  bool is_solid() const { return closed && oriented; }
  bool is_right() const { return over_claimed == 0 && inside > 0 && is_solid(); }
};

/// Checks `volume` (any mesh, scene frame) against the scene by shadow rays to the target's vertices, edges and
/// interior, and to where scene geometry reaches between the viewpoint and the target. Grazing is allowed: a hit closer
/// to a triangle's border than 1e-9 of its size does not count. Hits lower than 1 mm over the target itself count as
/// the surface that it lies on. A volume is right when nothing is over-claimed of the viewpoints inside it, of which
/// there must be some, and its mesh is a closed, oriented surface; see docs/verification.md. Of a
/// mesh with holes, which has no inside, only that is reported. What is claimed must see every part of the target
/// whole, and what is not must miss some of one. Where the sensor has a VisibleShare, what is claimed must see that
/// part of the area: the shadows of the scene's triangles are cut out of it. The limits of the sensor are judged by
/// their definitions in vantage/sensor.h, with code of its own: a camera is put at the viewpoint, and its orientations
/// are searched. Depths are told by the distance to the first part's centre. The parts are looked at one after the
/// other, so that memory is that of one.
///
/// The report depends on the seed, not on the number of threads (TBB; the caller's arena). Cost: points times samples
/// shadow rays, a few tenths of a microsecond each and thread. Throws Error(input) for a mesh without triangles, with
/// an index out of range or a coordinate that is not finite, and for a target, sensor, limit or option that is wrong in
/// itself; Error(cancelled) when told to stop. For a volume read from a file, verify_options of vantage/result.h gives
/// the options that fit it.
VANTAGE_API VerifyReport verify_volume(const Scene& scene, const Target& target, const Sensor& sensor,
                                       const Navigation& navigation, const Mesh& volume,
                                       const VerifyOptions& options = {}, const Progress& progress = {});

/// The same of a volume for several targets: what is claimed must see, of each list, one target whole or more, within
/// the limits of the sensor for that target. Each list has at least one; VerifyOptions::lift_m is for the parts of all
/// targets, in their order. Depths are told by the distance to the first target's centre.
VANTAGE_API VerifyReport verify_volume(const Scene& scene, const std::vector<std::vector<Target>>& views,
                                       const Sensor& sensor, const Navigation& navigation, const Mesh& volume,
                                       const VerifyOptions& options = {}, const Progress& progress = {});

}  // namespace vantage
