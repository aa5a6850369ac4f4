#include "depth/face_view.h"

#include <algorithm>

namespace vantage::internal::depth {
namespace {

/// Keeps what has side(point) >= 0.
template <typename Side>
bool keep(const Side& side, std::vector<Vec3>& points, std::vector<Vec3>& next) {
  const bool all = std::all_of(points.begin(), points.end(), [&](const Vec3& p) { return side(p) >= 0; });
  if (all) return !points.empty();
  next.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& a = points[i];
    const Vec3& b = points[i + 1 == points.size() ? 0 : i + 1];
    const double at_a = side(a), at_b = side(b);
    if (at_a >= 0) next.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) next.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  points.swap(next);
  return !points.empty();
}

}  // namespace

FaceClip::FaceClip(const FaceBand& band) : band_(band), axes_(cube_faces()[band.face]) {}

bool FaceClip::may_meet(const Vec3& centre, const Vec3& half) const {
  constexpr double kRounding = 1e-9;  // metres; boxes are single precision rounded outward already
  const auto outside = [&](const Vec3& inward) {
    return inward.dot(centre) + inward.cwiseAbs().dot(half) < -kRounding * (1 + centre.cwiseAbs().maxCoeff());
  };
  const Vec3& forward = axes_.forward;
  return !outside(forward) && !outside(forward + axes_.right) && !outside(forward - axes_.right) &&
         !outside(axes_.up - band_.edge(band_.row_begin) * forward) &&
         !outside(band_.edge(band_.row_end) * forward - axes_.up);
}

std::span<const Vec3> FaceClip::clip(const ViewedPolygon& polygon) {
  points_.clear();
  for (const Vec3& p : polygon.corners) {
    points_.emplace_back(axes_.right.dot(p), axes_.up.dot(p), axes_.forward.dot(p));
  }
  const double grown = 2 * polygon.slack;
  const double nearest = std::max(kTouching, 4 * polygon.slack);
  const double low = band_.edge(band_.row_begin), high = band_.edge(band_.row_end);
  const bool any = keep([=](const Vec3& p) { return p.z() - nearest; }, points_, next_) &&
                   keep([=](const Vec3& p) { return p.x() + p.z() + grown; }, points_, next_) &&
                   keep([=](const Vec3& p) { return p.z() - p.x() + grown; }, points_, next_) &&
                   keep([=](const Vec3& p) { return p.y() - low * p.z() + grown; }, points_, next_) &&
                   keep([=](const Vec3& p) { return high * p.z() - p.y() + grown; }, points_, next_);
  if (!any) return {};
  for (Vec3& p : points_) p.z() = std::max(p.z(), nearest);  // a cut at `nearest` may round below it
  return points_;
}

}  // namespace vantage::internal::depth
