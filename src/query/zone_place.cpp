#include "query/zone_place.h"

#include <algorithm>

namespace vantage::internal::query {

Box box_of(const Zone& zone) {
  Box box;
  for (const Eigen::Vector2d& p : zone.outer) box.extend(Vec3(p.x(), p.y(), 0));
  box.min.z() = zone.min_z_m;
  box.max.z() = zone.max_z_m;
  return box;
}

ZonePlace place_in(const Zone& zone, const Eigen::Vector2d& p) {
  bool is_inside = false, is_on_side = false;
  for_each_side(zone, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    if (std::max(a.y(), b.y()) < p.y() || std::min(a.y(), b.y()) > p.y() || std::max(a.x(), b.x()) < p.x()) return;
    const double area = (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());  // > 0: p lies left
    if (area == 0 && std::min(a.x(), b.x()) <= p.x()) is_on_side = true;
    if ((a.y() > p.y()) != (b.y() > p.y()) && (area > 0) == (b.y() > a.y())) is_inside = !is_inside;
  });
  return is_on_side ? ZonePlace::border : is_inside ? ZonePlace::inside : ZonePlace::outside;
}

}  // namespace vantage::internal::query
