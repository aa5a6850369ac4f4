#include "flight/plans/ground_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vantage::internal::flight::plans {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

GroundProfile::GroundProfile(const Ground& ground) : plane_z_m_(ground.plane_z_m), surface_(ground.surface.get()) {
  if (surface_ && !surface_->triangles.empty()) tree_.emplace(*surface_);
}

/// The line clipped by the triangle's three sides in plan, moved out by a tenth of a micrometre so that rounding leaves
/// no gaps between neighbours, with the triangle's z at both ends.
std::optional<GroundProfile::Piece> GroundProfile::piece(std::uint32_t triangle, const Eigen::Vector2d& from,
                                                         const Eigen::Vector2d& along) const {
  Vec3 corners[3];
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] = surface_->vertices[surface_->triangles[triangle][i]] - Vec3(from.x(), from.y(), 0);
  const Eigen::Vector2d u = (corners[1] - corners[0]).head<2>(), v = (corners[2] - corners[0]).head<2>();
  const double area = cross(u, v);
  if (area == 0) return std::nullopt;  // upright
  double begin = 0, end = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector2d a = corners[i].head<2>(), side = (corners[(i + 1) % 3] - corners[i]).head<2>();
    // Inside where it is not negative: value + slope * share.
    constexpr double kGrownM = 1e-7;
    const double value = -cross(side, a) * (area > 0 ? 1 : -1) + kGrownM * side.norm();
    const double slope = cross(side, along) * (area > 0 ? 1 : -1);
    if (slope == 0) {
      if (value < 0) return std::nullopt;
      continue;
    }
    const double share = -value / slope;
    (slope > 0 ? begin : end) = slope > 0 ? std::max(begin, share) : std::min(end, share);
  }
  if (!(begin <= end)) return std::nullopt;
  const double dz_u = corners[1].z() - corners[0].z(), dz_v = corners[2].z() - corners[0].z();
  const auto z_at = [&](double share) {
    const Eigen::Vector2d p = share * along - corners[0].head<2>();
    const double z = corners[0].z() + (cross(p, v) * dz_u + cross(u, p) * dz_v) / area;
    // A sliver's plane may leave its corners by rounding.
    const auto [low, high] = std::minmax({corners[0].z(), corners[1].z(), corners[2].z()});
    return std::clamp(z, low, high);
  };
  return Piece{begin, end, z_at(begin), z_at(end)};
}

/// Where pieces begin and end, each once: from 0 to 1, farther apart than the gap.
std::vector<double> GroundProfile::corners_of(const std::vector<Piece>& pieces, double gap) {
  std::vector<double> all;
  for (const Piece& piece : pieces) all.insert(all.end(), {piece.begin, piece.end});
  std::sort(all.begin(), all.end());
  std::vector<double> corners{0};
  for (const double share : all) {
    if (share - corners.back() > gap && 1 - share > gap) corners.push_back(share);
  }
  corners.push_back(1);
  return corners;
}

std::vector<ProfilePoint> GroundProfile::along(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  if (!surface_) return {{0, plane_z_m_}, {1, plane_z_m_}};
  if (!tree_) return {};
  const Eigen::Vector2d way = to - from;
  const double length = way.norm();
  std::vector<Piece> pieces;
  // In portions, since the box of a slanted line holds much beside it; a triangle that is met twice is harmless.
  const int portions = static_cast<int>(std::clamp(length / 50, 1.0, 1000.0));
  constexpr double kAny = 1e30, kMarginM = 1e-6;
  for (int i = 0; i < portions; ++i) {
    Box box;
    for (const int end : {i, i + 1}) {
      const Eigen::Vector2d p = from + way * end / portions;
      box.extend(Vec3(p.x(), p.y(), -kAny));
      box.extend(Vec3(p.x(), p.y(), kAny));
    }
    tree_->for_each_near(box, kMarginM, [&](std::uint32_t triangle) {
      if (const auto found = piece(triangle, from, way)) pieces.push_back(*found);
    });
  }
  const double gap = length > 0 ? 1e-6 / length : 1;  // rounding leaves gaps and overlaps between neighbours
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.begin < b.begin; });
  const std::vector<double> shares = corners_of(pieces, gap);

  std::vector<ProfilePoint> profile;
  std::vector<const Piece*> over;
  std::size_t next = 0;
  for (std::size_t i = 0; i + 1 < shares.size(); ++i) {
    const double begin = shares[i], end = shares[i + 1];
    for (; next < pieces.size() && pieces[next].begin <= begin + gap; ++next) over.push_back(&pieces[next]);
    over.erase(std::remove_if(over.begin(), over.end(), [&](const Piece* piece) { return piece->end < end - gap; }),
               over.end());
    if (over.empty()) return {};
    double z_begin = -std::numeric_limits<double>::infinity(), z_end = z_begin;
    for (const Piece* piece : over) {
      z_begin = std::max(z_begin, piece->z_at(begin));
      z_end = std::max(z_end, piece->z_at(end));
    }
    const bool goes_on = !profile.empty() && profile.back().share == begin && profile.back().z_m == z_begin;
    if (!goes_on) profile.push_back({begin, z_begin});
    profile.push_back({end, z_end});
  }
  return profile;
}

std::vector<ProfilePoint> thinned(const std::vector<ProfilePoint>& points, double error_m) {
  if (points.size() < 3) return points;
  std::vector<bool> is_kept(points.size(), false);
  is_kept.front() = is_kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const ProfilePoint &a = points[first], &b = points[last];
    double worst = error_m;
    std::size_t split = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double share = b.share > a.share ? (points[i].share - a.share) / (b.share - a.share) : 0;
      const double low = b.share > a.share ? a.z_m + (b.z_m - a.z_m) * share : std::min(a.z_m, b.z_m);
      const double high = b.share > a.share ? low : std::max(a.z_m, b.z_m);
      const double off = std::max({low - points[i].z_m, points[i].z_m - high, 0.0});
      if (off > worst) {
        worst = off;
        split = i;
      }
    }
    if (split == first) continue;
    is_kept[split] = true;
    open.push_back({first, split});
    open.push_back({split, last});
  }
  std::vector<ProfilePoint> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_kept[i]) kept.push_back(points[i]);
  }
  return kept;
}

}  // namespace vantage::internal::flight::plans
