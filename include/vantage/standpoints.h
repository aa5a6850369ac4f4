// Standpoints: the best places of a volume to hover at and look at its target.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/view_description.h"
#include "vantage/volume.h"

namespace vantage {

/// What a standpoint is the best at.
enum class StandpointKind {
  deepest,         ///< farthest from the volume's boundary: `value` is that distance, metres
  nearest,         ///< nearest to the target's centre: that distance, metres
  finest_pixel,    ///< the largest pixel on the target is the smallest: its size, metres
  best_incidence,  ///< most face-on: the largest angle between a normal and the line of sight is the smallest: degrees
  farthest,        ///< farthest from obstacles: that distance, metres
};

/// "deepest", "nearest", "finest_pixel", "best_incidence", "farthest".
VANTAGE_API const char* name_of(StandpointKind kind);

struct Standpoint {
  StandpointKind kind = StandpointKind::deepest;
  ViewDescription view;
  double margin_m = 0;  ///< how far it is from the volume's boundary: at least this, less by rounding alone
  double value = 0;     ///< of what it is the best at: see StandpointKind
  /// No position of the volume that keeps the margin, and StandpointOptions::tolerance_m more, has a better value.
  double bound = 0;
};

struct StandpointOptions {
  /// How deep inside the volume they are at least; >= 0. NaN: 1 m, but in a volume that is nowhere 4 m deep a quarter
  /// of its greatest depth.
  double margin_m = std::numeric_limits<double>::quiet_NaN();
  /// How far values may be from the best, and how far positions from where the margin ends; > 0. NaN: 0.1 m, but no
  /// more than a thousandth of the volume's extent and half of the margin. Pixels are right to 0.5 %, angles to
  /// 0.1 degrees.
  double tolerance_m = std::numeric_limits<double>::quiet_NaN();
  std::size_t most_boxes = 200000;  ///< of a search; one that comes to it ends with a looser `bound`
  int threads = 0;                  ///< 0: as many as the machine has. The result does not depend on it
};

struct Standpoints {
  std::vector<Standpoint> found;   ///< at most one of each kind, in their order
  double margin_m = 0;             ///< that they keep
  std::string reason;              ///< why there are none; else empty
  std::vector<std::string> notes;  ///< of kinds that have no answer, and of searches that were cut short
};

/// The standpoints in the volume of a mission, which has one volume (see one_volume). `volume`: what run_mission makes
/// of it. Every standpoint is inside the volume's mesh, as deep as it says, and inside by the exact ViewsQuery too.
///
/// Each is the best of all positions, to the stated tolerance, by branch and bound over boxes: the depth and the
/// distances are 1-Lipschitz functions, so a box around a position holds nothing better than its value and half of the
/// box's diagonal. Volumes in several pieces are one. Where several positions are equally good, the same one is found
/// every time.
///
/// Without a camera of known pixels there is no finest pixel, in an empty scene no farthest one, and without a front
/// no incidence: `notes` say so.
///
/// Throws Error(input) for options out of range, a mission of several volumes, and a mesh that is not closed;
/// Error(cancelled). Cost: 0.1 to 2 s, more where many positions are nearly as good, as in long prisms.
VANTAGE_API Standpoints find_standpoints(const Mission& mission, const Volume& volume, const PreparedScene& scene,
                                         const ViewDescriber& describer, const StandpointOptions& options = {},
                                         const Progress& progress = {});

/// Standpoints of one target for json_text.
struct NamedStandpoints {
  std::string target;
  Standpoints standpoints;
};

/// {"targets": [{"target", "margin_m", "reason", "notes", "standpoints": [...]}]}. What is not known is null.
VANTAGE_API std::string json_text(const std::vector<NamedStandpoints>& targets);

}  // namespace vantage
