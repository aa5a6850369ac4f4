#include "prove/prism.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vantage::internal::prove {
namespace {

using Plan = Eigen::Vector2d;

double distance_in_plan(const Plan& point, const Plan& from, const Plan& to) {
  const Plan along = to - from;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((point - from).dot(along) / length, 0.0, 1.0) : 0.0;
  return (point - from - share * along).norm();
}

/// The distance of two segments that do not cross: from an end of one to the other.
double distance_of_sides(const Plan& a, const Plan& b, const Plan& c, const Plan& d) {
  return std::min(
      {distance_in_plan(a, c, d), distance_in_plan(b, c, d), distance_in_plan(c, a, b), distance_in_plan(d, a, b)});
}

bool are_apart_in_plan(const Box& a, const Box& b, double by) {
  return a.min.x() > b.max.x() + by || b.min.x() > a.max.x() + by || a.min.y() > b.max.y() + by ||
         b.min.y() > a.max.y() + by;
}

Box box_in_plan(const Plan& from, const Plan& to) {
  Box box;
  box.extend(Vec3(from.x(), from.y(), 0));
  box.extend(Vec3(to.x(), to.y(), 0));
  return box;
}

HalfSpace upright(const Plan& outward, const Plan& through) {
  return {Vec3(outward.x(), outward.y(), 0), outward.dot(through)};
}

}  // namespace

Prism::Prism(const Zone& zone, const Vec3& origin) : low_(zone.min_z_m - origin.z()), high_(zone.max_z_m - origin.z()) {
  add_ring(zone.outer, origin);
  for (const Zone::Ring& hole : zone.holes) add_ring(hole, origin);
  if (zone.above_ground && !zone.above_ground->ground.surface) {
    const double ground = zone.above_ground->ground.plane_z_m - origin.z();
    low_ = std::max(low_, ground + zone.above_ground->min_m);
    high_ = std::min(high_, ground + zone.above_ground->max_m);
  }
  finish();
}

void Prism::add_ring(const Zone::Ring& ring, const Vec3& origin) {
  std::vector<Side>& sides = rings_.emplace_back();
  const Plan shift = origin.head<2>();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    sides.push_back({ring[i] - shift, ring[(i + 1) % ring.size()] - shift});
  }
}

void Prism::finish() {
  for (const Side& side : rings_.front()) {
    box_.extend(Vec3(side.from.x(), side.from.y(), low_));
    // Differences, products with a normal and sums lose less than 8 roundings of the largest of the numbers in them.
    const double largest = side.from.cwiseAbs().maxCoeff();
    rounding_m_ = std::max(rounding_m_, 8 * std::numeric_limits<double>::epsilon() * largest);
  }
  box_.extend(Vec3(box_.min.x(), box_.min.y(), high_));
}

bool Prism::holds_in_plan(const Vec3& point) const {
  bool is_inside = false;  // a ray along x crosses the sides an odd number of times
  for (const std::vector<Side>& sides : rings_) {
    for (const auto& [a, b] : sides) {
      if ((a.y() > point.y()) == (b.y() > point.y())) continue;
      const double turn = (b.x() - a.x()) * (point.y() - a.y()) - (b.y() - a.y()) * (point.x() - a.x());
      if ((turn > 0) == (b.y() > a.y())) is_inside = !is_inside;
    }
  }
  return is_inside;
}

double Prism::depth_in_plan(const Vec3& point) const {
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<Side>& sides : rings_) {
    for (const auto& [a, b] : sides) least = std::min(least, distance_in_plan(point.head<2>(), a, b));
  }
  return holds_in_plan(point) ? least : -least;
}

double Prism::depth(const Vec3& point) const {
  const double in_plan = depth_in_plan(point), in_height = std::min(point.z() - low_, high_ - point.z());
  if (in_plan >= 0 && in_height >= 0) return std::min(in_plan, in_height);
  return -std::hypot(std::min(in_plan, 0.0), std::min(in_height, 0.0));
}

std::vector<HalfSpace> Prism::plate_about(const Side& side, double half_width) const {
  const Plan along = (side.to - side.from).normalized(), across(-along.y(), along.x());
  return {upright(across, side.from + half_width * across), upright(-across, side.from - half_width * across),
          upright(along, side.to + half_width * along), upright(-along, side.from - half_width * along)};
}

Prism::Parts Prism::divide(const ConvexPolygon& polygon, double grown, double plate) const {
  Parts parts;
  ConvexPolygon between = polygon;
  for (const HalfSpace& side : {HalfSpace{Vec3::UnitZ(), high_ + grown}, HalfSpace{-Vec3::UnitZ(), grown - low_}}) {
    if (!std::isfinite(side.offset) || between.empty()) continue;
    CutPolygon halves = cut(between, side);
    if (!halves.outside.empty()) parts.outside.push_back(std::move(halves.outside));
    between = std::move(halves.inside);
  }
  if (between.empty()) return parts;
  const Box box = box_of(between);
  if (are_apart_in_plan(box, box_, 0)) {
    parts.outside.push_back(std::move(between));
    return parts;
  }
  std::vector<ConvexPolygon> pieces = {std::move(between)};
  for (const std::vector<Side>& sides : rings_) {
    for (const Side& side : sides) {
      if (are_apart_in_plan(box, box_in_plan(side.from, side.to), plate)) continue;
      if (side.from == side.to) continue;
      const std::vector<HalfSpace> region = plate_about(side, plate);
      std::vector<ConvexPolygon> left;
      for (const ConvexPolygon& piece : pieces) subtract(piece, region, left);
      pieces = std::move(left);
    }
  }
  // No side meets a piece, so it is inside as a whole or not at all.
  for (ConvexPolygon& piece : pieces) {
    (holds_in_plan(middle_of(piece)) ? parts.inside : parts.outside).push_back(std::move(piece));
  }
  return parts;
}

bool Prism::is_one_piece(double depth_m) const {
  struct Entry {
    Side side;
    std::size_t ring, index;
  };
  std::vector<Entry> all;
  for (std::size_t r = 0; r < rings_.size(); ++r) {
    for (std::size_t i = 0; i < rings_[r].size(); ++i) all.push_back({rings_[r][i], r, i});
  }
  const auto least_x = [](const Entry& entry) { return std::min(entry.side.from.x(), entry.side.to.x()); };
  std::sort(all.begin(), all.end(), [&](const Entry& a, const Entry& b) { return least_x(a) < least_x(b); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double reach = std::max(all[i].side.from.x(), all[i].side.to.x()) + 2 * depth_m;
    for (std::size_t j = i + 1; j < all.size() && least_x(all[j]) <= reach; ++j) {
      const Entry &a = all[i], &b = all[j];
      const std::size_t count = rings_[a.ring].size();
      const bool are_neighbours =
          a.ring == b.ring && ((a.index + 1) % count == b.index || (b.index + 1) % count == a.index);
      if (are_neighbours) continue;
      if (distance_of_sides(a.side.from, a.side.to, b.side.from, b.side.to) <= 2 * depth_m) return false;
    }
  }
  return true;
}

std::optional<Vec3> Prism::deep_point() const {
  constexpr std::size_t kMostLines = 64;
  std::vector<double> levels;
  for (const std::vector<Side>& sides : rings_) {
    for (const Side& side : sides) levels.push_back(side.from.y());
  }
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  const double z = std::isfinite(low_) && std::isfinite(high_) ? (low_ + high_) / 2
                   : std::isfinite(low_)                       ? low_ + 1
                   : std::isfinite(high_)                      ? high_ - 1
                                                               : 0;
  std::optional<Vec3> best;
  double most = 0;
  const std::size_t step = 1 + levels.size() / kMostLines;
  for (std::size_t i = 0; i + 1 < levels.size(); i += step) {
    const double y = (levels[i] + levels[i + 1]) / 2;
    std::vector<double> crossings;
    for (const std::vector<Side>& sides : rings_) {
      for (const auto& [a, b] : sides) {
        if ((a.y() > y) != (b.y() > y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
      }
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      const Vec3 point((crossings[k] + crossings[k + 1]) / 2, y, z);
      const double deep = depth_in_plan(point);
      if (deep <= most) continue;
      most = deep;
      best = point;
    }
  }
  return best;
}

}  // namespace vantage::internal::prove
