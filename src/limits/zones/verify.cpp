#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "verify/ground_probe.h"
#include "verify/limit_probe.h"

namespace vantage::internal::verify {
namespace {

bool within(const Box& box, const Vec3& point) {
  return (point.array() >= box.min.array()).all() && (point.array() <= box.max.array()).all();
}

bool strictly_within(const Box& box, const Vec3& point) {
  return (point.array() > box.min.array()).all() && (point.array() < box.max.array()).all();
}

using Plan = Eigen::Vector2d;

/// How often the ring goes round the point, by the angles under which its sides are seen; nothing on a side.
std::optional<int> turns_round(const Zone::Ring& ring, const Plan& point) {
  constexpr double kFullTurn = 2 * std::numbers::pi;
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Plan a = ring[i] - point, b = ring[(i + 1) % ring.size()] - point;
    const double across = a.x() * b.y() - a.y() * b.x(), along = a.dot(b);
    if (across == 0 && along <= 0) return std::nullopt;
    sum += std::atan2(across, along);
  }
  return static_cast<int>(std::lround(sum / kFullTurn));
}

/// The box of a zone, without bounds where the zone has none.
Box bounds_of(const Zone& zone) {
  Box box;
  for (const Plan& corner : zone.outer) {
    box.extend(Vec3(corner.x(), corner.y(), zone.min_z_m));
    box.extend(Vec3(corner.x(), corner.y(), zone.max_z_m));
  }
  return box;
}

/// `on_border`: what to say of points on a side.
bool contains(const Zone& zone, const Box& bounds, const Vec3& point, bool on_border) {
  if (!(on_border ? within(bounds, point) : strictly_within(bounds, point))) return false;
  if (zone.is_box) return true;  // it may reach so far that products are not numbers
  const Plan plan = point.head<2>();
  const std::optional<int> outer = turns_round(zone.outer, plan);
  if (!outer) return on_border;
  if (*outer == 0) return false;
  for (const Zone::Ring& hole : zone.holes) {
    const std::optional<int> turns = turns_round(hole, plan);
    if (!turns) return on_border;
    if (*turns != 0) return false;
  }
  return true;
}

struct JudgedZone {
  explicit JudgedZone(const Zone& given) : zone(given), bounds(bounds_of(given)) {
    if (zone.above_ground) heights.emplace(*zone.above_ground);
  }

  Zone zone;
  Box bounds;
  std::optional<GroundProbe> heights;
};

std::vector<JudgedZone> judged(const std::vector<Zone>& zones) { return {zones.begin(), zones.end()}; }

class KeepInProbe : public LimitProbe {
 public:
  explicit KeepInProbe(const std::vector<Zone>& zones) : zones_(judged(zones)) {}

  std::optional<std::string> broken_by(const JudgedPoint& point) const override {
    const bool is_kept = std::any_of(zones_.begin(), zones_.end(), [&](const JudgedZone& one) {
      return contains(one.zone, one.bounds, point.scene, true) && !(one.heights && one.heights->broken_by(point.scene));
    });
    if (!is_kept) return "keep_in";
    return std::nullopt;
  }
  bool may_leave_out(const JudgedPoint& /*point*/) const override { return false; }

 private:
  std::vector<JudgedZone> zones_;
};

class KeepOutProbe : public LimitProbe {
 public:
  explicit KeepOutProbe(const std::vector<Zone>& zones) : zones_(judged(zones)) {
    for (std::size_t i = 0; i < zones.size(); ++i) names_.push_back(zone_name(zones, i));
  }

  std::optional<std::string> broken_by(const JudgedPoint& point) const override {
    for (std::size_t i = 0; i < zones_.size(); ++i) {
      const auto& [zone, bounds, heights] = zones_[i];
      if (contains(zone, bounds, point.scene, false) && !(heights && heights->is_outside_band(point.scene))) {
        return "keep_out " + names_[i];
      }
    }
    return std::nullopt;
  }
  bool may_leave_out(const JudgedPoint& /*point*/) const override { return false; }

 private:
  std::vector<JudgedZone> zones_;
  std::vector<std::string> names_;
};

}  // namespace

template <>
std::unique_ptr<const LimitProbe> probe_of<Limit::keep_in>(const std::vector<Zone>& zones, const Vec3& /*origin*/) {
  return std::make_unique<KeepInProbe>(zones);
}

template <>
std::unique_ptr<const LimitProbe> probe_of<Limit::keep_out>(const std::vector<Zone>& zones, const Vec3& /*origin*/) {
  return std::make_unique<KeepOutProbe>(zones);
}

}  // namespace vantage::internal::verify
