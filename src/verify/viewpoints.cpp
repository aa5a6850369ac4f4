#include "verify/viewpoints.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vantage::internal::verify {
namespace {

constexpr int kDraws = 256;  // attempts at a point inside before one outside is taken

/// How far from the boundary, along the line to the target's centre and relative to the distance: both sides of it,
/// from just above the default depth tolerance to what a coarse volume may err by.
constexpr std::array<double, 10> kSteps = {-2e-6, 2e-6, -1e-5, 1e-5, -1e-4, 1e-4, -1e-3, 1e-3, -1e-2, 1e-2};

Vec3 in_box(const Box& box, Random& random) {
  const double x = random.uniform(box.min.x(), box.max.x());
  const double y = random.uniform(box.min.y(), box.max.y());
  const double z = random.uniform(box.min.z(), box.max.z());
  return {x, y, z};
}

}  // namespace

Viewpoints::Viewpoints(const ClosedMesh& volume, const TargetView& view, double max_range, std::size_t count)
    : volume_(volume), view_(view), max_range_(max_range), count_(count) {
  double sum = 0;
  for (const FlatTriangle& facet : volume.triangles()) area_.push_back(sum += facet.normal_length / 2);
}

Viewpoint Viewpoints::draw(std::size_t number, Random& random) const {
  switch (number % 8) {
    case 0:
    case 1:
      return inside(random);
    case 2:
      return around(random);
    case 3:
      return in_range(random);
    default:
      return near_boundary(number / 8 * 4 + number % 8 - 4, random);
  }
}

Viewpoint Viewpoints::inside(Random& random) const {
  // The first of independent uniform points that falls inside is uniform over the inside.
  for (int attempt = 0; attempt < kDraws; ++attempt) {
    const Vec3 position = in_box(volume_.bounds(), random);
    if (volume_.contains(position) == true) return {position, true};
  }
  return around(random);
}

Viewpoint Viewpoints::around(Random& random) const {
  Box box = volume_.bounds();
  const Vec3 margin = 0.05 * (box.max - box.min);
  box.min -= margin;
  box.max += margin;
  return {in_box(box, random), true};
}

Viewpoint Viewpoints::in_range(Random& random) const {
  const double rise = random.uniform(view_.all_sides() ? -1 : 0, 1), turn = random.uniform(0, 2 * std::numbers::pi);
  const double radius = max_range_ * random.uniform();  // denser near the target, where most of a city's volume is cut
  const Vec3 axis_u = view_.normal().unitOrthogonal(), axis_v = view_.normal().cross(axis_u);
  const double flat = std::sqrt(1 - rise * rise);
  const Vec3 direction = flat * (std::cos(turn) * axis_u + std::sin(turn) * axis_v) + rise * view_.normal();
  return {view_.centre() + radius * direction, false};
}

/// Every other round of steps goes by area, the rest from facet to facet, so that small ones get their share.
Viewpoint Viewpoints::near_boundary(std::size_t number, Random& random) const {
  const std::size_t step = number % kSteps.size(), round = number / kSteps.size();
  std::size_t facet = 0;
  if (round % 2 == 0) {
    const auto found = std::upper_bound(area_.begin(), area_.end() - 1, random.uniform() * area_.back());
    facet = static_cast<std::size_t>(found - area_.begin());
  } else {
    const std::size_t place = round / 2 * kSteps.size() + step;
    const double share =
        (static_cast<double>(place) + random.uniform()) / (static_cast<double>(count_) / 4 + kSteps.size());
    facet = std::min(static_cast<std::size_t>(share * static_cast<double>(area_.size())), area_.size() - 1);
  }
  const Vec3 point = on_facet(facet, random);
  return {point + kSteps[step] * (point - view_.centre()), false};
}

Vec3 Viewpoints::on_facet(std::size_t facet, Random& random) const {
  const FlatTriangle& triangle = volume_.triangles()[facet];
  const double reach = std::sqrt(random.uniform()), across = random.uniform();
  return triangle.corner + reach * ((1 - across) * triangle.edge1 + across * triangle.edge2);
}

}  // namespace vantage::internal::verify
