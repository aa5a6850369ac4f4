#include "exact/contact_test.h"

#include <cmath>

#include "exact/octahedral_map.h"
#include "exact/segment_cover.h"

namespace vantage::internal::exact {
namespace {

// Planes of two blockers that differ by less than this fraction may be one plane, computed twice.
constexpr double kParallel = 1e-6;

}  // namespace

bool ContactTest::hidden(std::uint32_t blocker, std::uint32_t index) {
  const Plane& plane = blockers_.planes[index];
  const double margin = touch_margin(plane, reach_);
  Vec3 middle = Vec3::Zero();
  touched_.clear();
  for (const Vec3& corner : blockers_.corners_of(blocker)) {
    if (std::abs(plane.dot(corner) - 1) <= margin) {
      touched_.push_back(corner);
      middle += corner;
    }
  }
  if (touched_.empty() || middle.z() <= 0) return false;
  for (const std::uint32_t competitor : tree_.leaf_at(to_octahedral(middle)).blockers) {
    const bool is_of_same = blockers_.cover[competitor] == blockers_.cover[blocker];
    if (competitor != blocker && is_of_same && hides(competitor, plane, competitor < blocker)) return true;
  }
  return false;
}

bool ContactTest::hides(std::uint32_t competitor, const Plane& own, bool owns_ties) const {
  for (const Plane& plane : blockers_.planes_of(competitor)) {
    const double margin = tie_margin(plane, reach_);
    for (const Vec3& corner : touched_)
      if (plane.dot(corner) - 1 < -margin) return false;
    // One plane, computed twice: it decides nothing but who owns it. Where the two are apart at the far end of the
    // range, whichever is in front there has a facet: the corners, which are near, do not say.
    const double apart = (plane - own).norm();
    if (apart <= kParallel * own.norm() && (!owns_ties || apart * reach_ > margin)) return false;
  }
  return true;
}

}  // namespace vantage::internal::exact
