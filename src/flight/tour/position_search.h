// The search for few positions that see all targets: what is known of candidates, and which targets have none in
// common.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress_reporter.h"
#include "core/stopwatch.h"
#include "flight/solid_depth.h"
#include "flight/tour/covering.h"
#include "vantage/geometry.h"
#include "vantage/solid.h"
#include "vantage/tour.h"

namespace vantage::internal::flight::tour {

/// A position and all that it sees: as deep as the margin, allowed, asked again.
struct HoverCandidate {
  Vec3 point = Vec3::Zero();
  Group sees;
};

/// From above: groups of targets, each with a position. Numbers of targets are those of the request.
class PositionSearch {
 public:
  /// Keeps references. Throws as fewest_positions for its targets.
  PositionSearch(const FewestRequest& request, const core::ProgressReporter& progress);

  std::size_t count() const { return regions_.size(); }
  bool is_over() const { return watch_.seconds() > time_limit_s_; }
  /// For work that is no part of the search.
  void allow_more(double seconds) { time_limit_s_ += seconds; }
  CoveringLimits limits() const;

  /// The first candidates: random points, and one of its own for each target that they miss.
  void sample();
  /// Targets without a candidate. After sample().
  const Group& unseen() const { return unseen_; }

  /// Whether a candidate is known that sees all of a group, or one is found now. "No" is no proof.
  bool has_common(const Group& group);
  bool is_seen_together(std::size_t a, std::size_t b) const { return together_[a][b]; }

  /// From each target on: groups that have a common position get more targets, one by one.
  void grow();
  /// The fewest candidates that see all targets but the unseen ones.
  std::vector<Group> cover() const;
  /// Makes `best` fewer groups, until there are no fewer than `least`, or none are found; after Error(cancelled), too,
  /// it is the best so far. `conflicts`: groups that have no position; `apart`: of each two of these targets that is
  /// known.
  void improve(std::vector<Group>& best, std::size_t least, const std::vector<Group>& conflicts, const Group& apart);

  /// Positions for the groups: those that are known, or as deep as it finds them.
  std::vector<HoverPosition> positions_of(const std::vector<Group>& groups, bool is_deep) const;

 private:
  struct Region {
    Region(const FewestTarget& of, const Mesh& mesh) : target(&of), depth(mesh), exact(mesh) {}

    const FewestTarget* target;
    SolidDepth depth;
    SolidIndex exact;
  };

  std::vector<Vec3> random_points() const;
  std::vector<Group> seen_by_depth(const std::vector<Vec3>& points) const;
  bool is_allowed(const Vec3& point) const;
  Group seen_from(const Vec3& point) const;
  void add(HoverCandidate candidate);
  double depth_m(std::size_t target, const Vec3& point) const;
  std::optional<Vec3> find_common(const Group& group, double share) const;
  const HoverCandidate* known(const Group& group) const;
  void learn_conflict(const Group& group);

  const FewestRequest& request_;
  const core::ProgressReporter& progress_;
  core::Stopwatch watch_;
  double time_limit_s_;
  std::vector<std::unique_ptr<const Region>> regions_;
  std::vector<Vec3> anchors_;  ///< points of the volumes, as deep as the margin
  std::vector<HoverCandidate> candidates_;
  std::vector<Group> conflicts_;  ///< no position of them was found
  std::vector<std::vector<bool>> together_;
  Group unseen_;
};

}  // namespace vantage::internal::flight::tour
