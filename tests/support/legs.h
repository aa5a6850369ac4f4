// Legs for tests, and scenes at several scales.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/random.h"
#include "support/scenes.h"
#include "vantage/query.h"

namespace vantage::testing {

/// Micrometres to kilometres, and at map coordinates.
struct LegWorld {
  double scale = 1;
  Vec3 shift = Vec3::Zero();

  Vec3 at(const Vec3& place) const { return shift + scale * place; }
  Scene scene(Scene scene) const {
    for (Vec3& vertex : scene.mesh.vertices) vertex = at(vertex);
    return scene;
  }
  Target target(Target target) const {
    for (auto& part : target.parts) {
      for (Vec3& vertex : part) vertex = at(vertex);
    }
    return target;
  }
  /// What rounding of the coordinates may move.
  double rounding() const { return 1e-15 * (shift.norm() + 1000 * scale); }
};
inline const std::vector<LegWorld> kLegWorlds = {
    {1, Vec3(0, 0, 0)}, {1e-3, Vec3(0, 0, 0)}, {1e3, Vec3(0, 0, 0)}, {1, Vec3(5e5, 5e6, 500)}};

inline Vec3 place_on(const Leg& leg, double share) { return leg.from + share * (leg.to - leg.from); }

inline bool holds(const std::vector<LegInterval>& intervals, double share) {
  return std::any_of(intervals.begin(), intervals.end(),
                     [&](const LegInterval& part) { return part.begin <= share && share <= part.end; });
}

inline bool hides(const LegView& view, const std::string& name, double share) {
  return std::any_of(view.hidden_by.begin(), view.hidden_by.end(), [&](const LegBlocker& blocker) {
    return blocker.name == name && holds(blocker.intervals, share);
  });
}

/// Points in a ball: its middle, then on its border.
inline std::vector<Vec3> ball_points(Random& random, const Vec3& centre, double radius, int count) {
  std::vector<Vec3> points{centre};
  for (int i = 0; i < count; ++i) points.push_back(centre + radius * random.direction());
  return points;
}

inline bool is_sorted_and_disjoint(const std::vector<LegInterval>& intervals) {
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const auto& [begin, end] = intervals[i];
    if (!(0 <= begin && begin <= end && end <= 1)) return false;
    if (i > 0 && !(intervals[i - 1].end < begin)) return false;
  }
  return true;
}

}  // namespace vantage::testing
