#include "query/limits.h"

#include <algorithm>
#include <cmath>

namespace vantage::internal::query {
namespace {

/// The part of the line from one cut to the next.
struct Part {
  double begin, end;
  double distance_from(double at) const { return std::max({begin - at, at - end, 0.0}); }
};

}  // namespace

Limits::Limits(const Navigation& navigation, const PreparedTarget& target) {
  GroundPool grounds;
  each_limit(navigation, [&](auto limit, const auto& value) {
    limits_.push_back(point_limit<decltype(limit)::value>(value, grounds));
  });
  const auto view =
      std::make_shared<const sensor::SensorView>(sensor::SensorView{target.sensor(), sensor::viewed_of(target)});
  each_limit(view->sensor, [&](auto limit, const auto& value) {
    limits_.push_back(point_limit<decltype(limit)::value>(value, view));
  });
}

/// The line within reach, cut wherever it passes a limit: between neighbours all of it is allowed or none.
std::vector<double> Limits::cut_line(const ViewRay& line) const {
  std::vector<double> cuts;
  for (const auto& limit : limits_) limit->add_crossings(line, cuts);
  std::erase_if(cuts, [&](double cut) { return !(cut > 0 && cut < line.reach); });
  cuts.push_back(0);
  cuts.push_back(line.reach);
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

double Limits::signed_margin(const ViewRay& line, double at, bool is_inside) const {
  if (!(line.reach > 0)) return -INFINITY;
  const std::vector<double> cuts = cut_line(line);
  std::vector<Part> parts;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i] < cuts[i + 1]) parts.push_back({cuts[i], cuts[i + 1]});
  }
  const auto is_allowed = [&](const Part& part) { return broken(line.at((part.begin + part.end) / 2)).empty(); };
  // Nearest first: outside, the first part that is allowed ends the search; inside, the first that is not, or the
  // reach.
  std::stable_sort(parts.begin(), parts.end(),
                   [&](const Part& a, const Part& b) { return a.distance_from(at) < b.distance_from(at); });
  for (const Part& part : parts) {
    const double distance = part.distance_from(at);
    if (is_inside && distance >= line.reach - at) break;
    if (is_allowed(part) != is_inside) return is_inside ? distance : 0.0 - distance;
  }
  return is_inside ? std::max(line.reach - at, 0.0) : -INFINITY;
}

std::vector<std::string> Limits::broken(const Vec3& point) const {
  std::vector<std::string> broken;
  for (const auto& limit : limits_) limit->add_broken(point, broken);
  return broken;
}

}  // namespace vantage::internal::query
