// The fewest positions to hover at so that each of many targets is seen whole from one of them, and how many are
// necessary.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"
#include "vantage/tour.h"

namespace vantage {

struct FewestTarget {
  std::string name;
  Mesh volume;  ///< from its inside the target is seen: closed, outward oriented, of any number of pieces; scene frame
  /// Whether a position sees the target, by an exact answer; asked of each position that lies in the volume, before it
  /// counts, by one thread at a time. Empty: the volume is believed.
  std::function<bool(const Vec3& position)> sees = {};
  /// Makes a closed mesh that holds every position from which the target is seen (outer_volume, vantage/result.h). It
  /// is called once, where more than one position is needed. Empty: no such mesh is known, and any position may see it.
  std::function<Mesh(const Progress& progress)> outer = {};
  double outer_rounding_m = 0;  ///< positions may lie so far outside of that mesh; >= 0
};

struct FewestRequest {
  std::vector<FewestTarget> targets;
  double margin_m = 1;                            ///< so deep positions lie in the volumes of their targets; > 0
  std::shared_ptr<const Airspace> airspace = {};  ///< in which they lie; nothing: everywhere
  double deviation_m = 0;    ///< all that is so near to a position must be allowed by the airspace, too; >= 0
  double time_limit_s = 60;  ///< of the search; making outer meshes comes on top. > 0
  int threads = 0;           ///< 0: as many as the machine has. The result does not depend on it, but where time ends
};

/// Where to hover. Targets go by their index in the request.
struct HoverPosition {
  Vec3 position = Vec3::Zero();       ///< scene frame, metres
  std::vector<std::size_t> sees;      ///< all targets that are seen from it, as deep in their volumes as the margin
  std::vector<std::size_t> assigned;  ///< of these, those that are viewed from it: each target once
  double depth_m = 0;                 ///< how deep it lies in the volumes of those at least
};

struct FewestPositions {
  enum class End {
    done,        ///< the search came to its end
    time_limit,  ///< the best that was found until then
    cancelled,   ///< likewise
  };
  /// Why so many positions are necessary.
  enum class Reason {
    one,     ///< there is a target
    apart,   ///< the targets in `apart` are so many
    groups,  ///< one less would have to see targets together of which it is known that no position does
  };

  std::vector<HoverPosition> positions;  ///< in the order of their first target
  std::vector<std::size_t> unseen;       ///< targets of which no position was found that the airspace allows
  /// So many positions at least see all targets but the unseen ones, wherever they are: over outer meshes alone, of the
  /// airspace and of the margin it knows nothing. 0 where all are unseen.
  std::size_t necessary = 0;
  Reason reason = Reason::one;
  std::vector<std::size_t> apart;  ///< targets whose outer meshes do not meet: no position sees two of them
  End end = End::done;

  /// Whether it is proved that no fewer do.
  bool is_proved() const { return positions.size() == necessary; }
};

/// Positions that see all targets, as few as the search finds. Each lies as deep in the volumes of its targets as the
/// margin, by SolidIndex, is allowed by the airspace, and sees its targets by their own answer. Of such positions one
/// is taken that lies within 10 % of as deep as is found.
///
/// Candidates are random points in all volumes, and points that groups of volumes have in common, which grow from each
/// target. An exact cover chooses among them. Then the targets are divided into one group less, without any group of
/// which no common point was found, and these groups are searched for one: until there is no such division.
///
/// The lower bound is that of a largest set of targets whose outer meshes do not meet in pairs ("do not meet" is
/// certain: they are farther apart than rounding), raised where larger sets of outer meshes have no common point.
///
/// The same every time, unless it ends by time or by the caller. Where the callback asks to stop, the best so far is
/// returned; Error(cancelled) only before there is an answer. Throws Error(input), with the name of the target as the
/// place: for no targets, a volume that is no closed mesh or has no point as deep as the margin, numbers out of range;
/// and what `sees` and `outer` throw. Cost: seconds for 20 targets.
VANTAGE_API FewestPositions fewest_positions(const FewestRequest& request, const Progress& progress = {});

}  // namespace vantage
