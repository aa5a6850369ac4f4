#include <algorithm>
#include <cmath>

#include "query/line_crossings.h"
#include "query/point_limit.h"
#include "query/zone_place.h"

namespace vantage::internal::query {
namespace {

/// Where the line passes a side or a height, or nearly, as for meshes.
void add_zone_crossings(const Zone& zone, const ViewRay& line, std::vector<double>& out) {
  constexpr double kNear = 1e-9;  // of a side's length
  if (line.direction.z() != 0) {
    out.push_back((zone.min_z_m - line.origin.z()) / line.direction.z());
    out.push_back((zone.max_z_m - line.origin.z()) / line.direction.z());
  }
  const Eigen::Vector2d origin = line.origin.head<2>(), direction = line.direction.head<2>();
  for_each_side(zone, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d side = b - a, from = a - origin;
    const double slope = direction.x() * side.y() - direction.y() * side.x();
    if (slope == 0) return;
    const double along = (from.x() * direction.y() - from.y() * direction.x()) / slope;
    if (along < -kNear || along > 1 + kNear) return;
    out.push_back((from.x() * side.y() - from.y() * side.x()) / slope);
  });
}

class ZoneOfPoint {
 public:
  ZoneOfPoint(const Zone& zone, GroundPool& grounds) : zone_(zone), box_(box_of(zone)) {
    if (zone.above_ground) ground_ = grounds.of(zone.above_ground->ground);
  }

  /// As a zone to stay in.
  bool holds(const Vec3& p) const {
    const bool is_in = (p.array() >= box_.min.array()).all() && (p.array() <= box_.max.array()).all() &&
                       (zone_.is_box || place_in(zone_, p.head<2>()) != ZonePlace::outside);
    if (!is_in || !zone_.above_ground) return is_in;
    const auto ground = ground_->at(p.x(), p.y());
    return ground && p.z() >= ground->highest_m + zone_.above_ground->min_m &&
           p.z() <= ground->lowest_m + zone_.above_ground->max_m;
  }
  /// As a zone to stay out of.
  bool forbids(const Vec3& p) const {
    const bool is_in = (p.array() > box_.min.array()).all() && (p.array() < box_.max.array()).all() &&
                       (zone_.is_box || place_in(zone_, p.head<2>()) == ZonePlace::inside);
    if (!is_in || !zone_.above_ground) return is_in;
    const auto ground = ground_->at(p.x(), p.y());
    return !(ground && (p.z() <= ground->lowest_m + zone_.above_ground->min_m ||
                        p.z() >= ground->highest_m + zone_.above_ground->max_m));
  }
  /// `within_reach`: of the line.
  void add_crossings(const ViewRay& line, const Box& within_reach, std::vector<double>& cuts) const {
    if (zone_.is_box) return add_box_crossings(box_, line, cuts);
    if (!boxes_meet(box_, within_reach)) return;
    add_zone_crossings(zone_, line, cuts);
    if (zone_.above_ground) add_band_crossings(*zone_.above_ground, *ground_, line, cuts);
  }

 private:
  Zone zone_;
  Box box_;
  std::shared_ptr<const GroundHeights> ground_;  ///< of heights above it
};

class ZonesOfPoint : public PointLimit {
 public:
  ZonesOfPoint(const std::vector<Zone>& zones, GroundPool& grounds) {
    for (const Zone& zone : zones) zones_.emplace_back(zone, grounds);
  }

  void add_crossings(const ViewRay& line, std::vector<double>& cuts) const override {
    Box within_reach;
    within_reach.extend(line.origin);
    within_reach.extend(line.at(line.reach));
    for (const ZoneOfPoint& zone : zones_) zone.add_crossings(line, within_reach, cuts);
  }

 protected:
  std::vector<ZoneOfPoint> zones_;
};

class KeepInOfPoint : public ZonesOfPoint {
 public:
  using ZonesOfPoint::ZonesOfPoint;

  void add_broken(const Vec3& point, std::vector<std::string>& broken) const override {
    const auto holds = [&](const ZoneOfPoint& zone) { return zone.holds(point); };
    if (std::none_of(zones_.begin(), zones_.end(), holds)) broken.emplace_back("keep_in");
  }
};

class KeepOutOfPoint : public ZonesOfPoint {
 public:
  KeepOutOfPoint(const std::vector<Zone>& zones, GroundPool& grounds) : ZonesOfPoint(zones, grounds) {
    for (std::size_t i = 0; i < zones.size(); ++i) names_.push_back("keep_out " + zone_name(zones, i));
  }

  void add_broken(const Vec3& point, std::vector<std::string>& broken) const override {
    for (std::size_t i = 0; i < zones_.size(); ++i) {
      if (zones_[i].forbids(point)) broken.push_back(names_[i]);
    }
  }

 private:
  std::vector<std::string> names_;
};

}  // namespace

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::keep_in>(const std::vector<Zone>& zones, GroundPool& grounds) {
  return std::make_unique<KeepInOfPoint>(zones, grounds);
}

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::keep_out>(const std::vector<Zone>& zones, GroundPool& grounds) {
  return std::make_unique<KeepOutOfPoint>(zones, grounds);
}

}  // namespace vantage::internal::query
