#include "solid/surface_turn.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "core/weld.h"

namespace vantage::internal::solid {
namespace {

/// Whether all corners are in a plane, so far that no part of the polygon has another normal.
bool is_flat(const std::vector<Vec3>& polygon, const Vec3& doubled_area) {
  constexpr double kFlat = 1e-6;
  const double area = doubled_area.norm();
  double longest = 0, highest = 0;
  for (const Vec3& corner : polygon) {
    longest = std::max(longest, (corner - polygon[0]).norm());
    highest = std::max(highest, std::abs(doubled_area.dot(corner - polygon[0])) / area);
  }
  return polygon.size() == 3 || highest * longest <= kFlat * area;
}

class Surface {
 public:
  Surface(std::span<const std::vector<Vec3>> polygons, const std::vector<bool>& is_known);

  double sine(std::uint32_t polygon) const;

 private:
  /// An edge of a polygon, from its corner of that number.
  struct Side {
    std::uint32_t polygon, corner;
  };
  static constexpr std::uint32_t kTwice = ~0u;

  std::uint32_t vertex(const Side& side) const { return vertices_[first_[side.polygon] + side.corner]; }
  std::uint32_t count(std::uint32_t polygon) const { return first_[polygon + 1] - first_[polygon]; }
  Side next(Side side) const { return {side.polygon, (side.corner + 1) % count(side.polygon)}; }
  Side previous(Side side) const {
    return {side.polygon, (side.corner + count(side.polygon) - 1) % count(side.polygon)};
  }
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }
  /// Of the other polygon at an edge.
  std::optional<Side> other(const Side& side) const;

  std::vector<std::uint32_t> first_;     // per polygon: of its corners
  std::vector<std::uint32_t> vertices_;  // per corner
  std::vector<Vec3> normals_;
  std::vector<bool> is_known_;                     // whether the normal is
  std::unordered_map<std::uint64_t, Side> sides_;  // by their vertices
};

Surface::Surface(std::span<const std::vector<Vec3>> polygons, const std::vector<bool>& is_known) {
  std::vector<Vec3> corners;
  for (const std::vector<Vec3>& polygon : polygons) {
    first_.push_back(static_cast<std::uint32_t>(corners.size()));
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      normal += (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]);
    }
    is_known_.push_back(is_known[is_known_.size()] && is_flat(polygon, normal));
    normals_.push_back(normal.normalized());
  }
  first_.push_back(static_cast<std::uint32_t>(corners.size()));
  vertices_ = core::first_at_position(corners);
  for (std::uint32_t i = 0; i < polygons.size(); ++i) {
    for (std::uint32_t k = 0; k < count(i); ++k) {
      const Side side{i, k};
      const auto [at, is_new] = sides_.try_emplace(key(vertex(side), vertex(next(side))), side);
      if (!is_new || !is_known_[i]) at->second.corner = kTwice;
    }
  }
}

std::optional<Surface::Side> Surface::other(const Side& side) const {
  const auto found = sides_.find(key(vertex(next(side)), vertex(side)));
  const auto own = sides_.find(key(vertex(side), vertex(next(side))));
  if (found == sides_.end() || found->second.corner == kTwice || own->second.corner == kTwice) return std::nullopt;
  return found->second;
}

double Surface::sine(std::uint32_t polygon) const {
  if (!is_known_[polygon]) return 1;
  constexpr int kMost = 64;        // polygons about a corner
  constexpr double kLeast = 0.71;  // a cosine
  double least = 1;
  for (std::uint32_t k = 0; k < count(polygon); ++k) {
    Side side{polygon, k};
    int seen = 0;
    do {
      const std::optional<Side> beside = other(previous(side));
      if (!beside || ++seen > kMost) return 1;
      side = *beside;  // it begins where the one before it ended, in the same corner
      const double cosine = normals_[polygon].dot(normals_[side.polygon]);
      if (!(cosine > kLeast)) return 1;
      least = std::min(least, cosine);
    } while (side.polygon != polygon);
  }
  return std::sqrt(1 - least * least);
}

}  // namespace

std::vector<double> sines_of_turns(std::span<const std::vector<Vec3>> polygons, const std::vector<bool>& is_known) {
  const Surface surface(polygons, is_known);
  std::vector<double> sines;
  for (std::uint32_t i = 0; i < polygons.size(); ++i) sines.push_back(surface.sine(i));
  return sines;
}

}  // namespace vantage::internal::solid
