#include "flight/target_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "vantage/sensor.h"

namespace vantage::internal::flight {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<Vec3> corners_of(const TargetFrame& part) {
  std::vector<Vec3> corners;
  for (const Eigen::Vector2d& corner : part.polygon) corners.push_back(part.to_scene({corner.x(), corner.y(), 0}));
  return corners;
}

TargetView::TargetView(const Mission& mission) {
  Box box;
  std::size_t part_count = 0;
  const auto parts_of = [&](const Target& target) {
    Parts parts;
    for (std::size_t i = 0; i < target.parts.size(); ++i) {
      const TargetFrame frame = make_target_frame(target, i);
      Part part{corners_of(frame), frame.origin, frame.normal, frame.all_sides};
      for (const Vec3& corner : part.corners) box.extend(corner);
      centre_ = frame.origin;
      ++part_count;
      parts.push_back(std::move(part));
    }
    return parts;
  };
  if (mission.views.empty()) views_.push_back({parts_of(mission.target)});
  for (const std::vector<Target>& view : mission.views) {
    std::vector<Parts>& any = views_.emplace_back();
    for (const Target& target : view) any.push_back(parts_of(target));
  }
  if (part_count > 1) centre_ = (box.min + box.max) / 2;
  if (mission.sensor.camera) focal_px_ = mission.sensor.camera->focal_px;
  if (mission.sensor.pixel) kind_ = mission.sensor.pixel->kind;
}

template <typename Measure>
double TargetView::worst(const Measure& of_part) const {
  double worst_view = -kNotKnown;
  for (const std::vector<Parts>& view : views_) {
    double best_target = kNotKnown;
    for (const Parts& target : view) {
      double worst_part = -kNotKnown;
      for (const Part& part : target) worst_part = std::max(worst_part, of_part(part));
      best_target = std::min(best_target, worst_part);
    }
    worst_view = std::max(worst_view, best_target);
  }
  return worst_view;
}

double TargetView::distance_m(const Vec3& position, double reach_m) const {
  return std::max(0.0, (position - centre_).norm() - reach_m);
}

double TargetView::pixel_m(const Vec3& position, double reach_m) const {
  return worst([&](const Part& part) {
    double distance = 0;
    for (const Vec3& corner : part.corners) distance = std::max(distance, (position - corner).norm() - reach_m);
    if (kind_ == PixelLimit::Kind::perpendicular || part.all_sides) return distance / *focal_px_;
    const double height = part.normal.dot(position - part.origin) + reach_m;
    return height > 0 ? distance * distance / (*focal_px_ * height) : kNotKnown;
  });
}

bool TargetView::has_incidence() const { return std::isfinite(incidence_deg(centre_ + Vec3::Ones())); }

double TargetView::incidence_deg(const Vec3& position, double reach_m) const {
  return worst([&](const Part& part) {
    if (part.all_sides) return -kNotKnown;
    const double height = part.normal.dot(position - part.origin);
    const Vec3 foot = position - height * part.normal;
    double aside = 0;
    for (const Vec3& corner : part.corners) aside = std::max(aside, (foot - corner).norm() - reach_m);
    return std::atan2(aside, height + reach_m) * 180 / std::numbers::pi;
  });
}

}  // namespace vantage::internal::flight
