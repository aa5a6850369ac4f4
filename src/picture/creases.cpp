#include "picture/creases.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/parallel.h"

namespace vantage::internal::picture {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kFlat = 3 * kDegree;    // facets that meet at less are one face: the range sphere's are such
constexpr double kSharp = 25 * kDegree;  // from here on an edge is drawn in full
constexpr double kFaintest = 0.35;       // of a crease that is drawn at all
constexpr double kThin = 1e-3;           // height over longest side, below which a facet's normal says little

struct Side {
  std::uint32_t low, high, triangle;
};

struct Facet {
  Vec3 normal;
  bool is_thin;
};

Facet facet_of(const Mesh& mesh, const Triangle& t) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const Vec3 cross = (b - a).cross(c - a);
  const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  const double size = cross.norm();
  return {size > 0 ? Vec3(cross / size) : Vec3(Vec3::Zero()), size <= kThin * longest2};
}

std::vector<Side> sorted_sides(const Mesh& mesh, const core::ProgressReporter& progress) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t});
    }
  }
  const auto less = [](const Side& a, const Side& b) {
    return a.low != b.low ? a.low < b.low : (a.high != b.high ? a.high < b.high : a.triangle < b.triangle);
  };
  parallel::sort(sides, less, progress);
  return sides;
}

/// A thin facet takes the normal of its neighbour across its longest side: so the face that it lies in goes on, and a
/// crease that a strip of thin facets follows stays on one side of it.
void mend_thin(const Mesh& mesh, const std::vector<Side>& sides, std::vector<Facet>& facets) {
  constexpr int kRounds = 4;  // thin facets beside thin ones
  std::vector<std::uint32_t> beside(facets.size(), std::numeric_limits<std::uint32_t>::max());
  std::vector<double> longest(facets.size(), -1);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].low != sides[i - 1].low || sides[i].high != sides[i - 1].high) continue;
    const double length = (mesh.vertices[sides[i].low] - mesh.vertices[sides[i].high]).squaredNorm();
    for (const auto& [one, other] : {std::pair(i, i - 1), std::pair(i - 1, i)}) {
      const std::uint32_t facet = sides[one].triangle;
      if (length <= longest[facet]) continue;
      longest[facet] = length;
      beside[facet] = sides[other].triangle;
    }
  }
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t t = 0; t < facets.size(); ++t) {
      if (!facets[t].is_thin || beside[t] >= facets.size() || facets[beside[t]].is_thin) continue;
      facets[t] = facets[beside[t]];
    }
  }
}

}  // namespace

std::vector<Crease> find_creases(const Mesh& mesh, std::span<const std::uint8_t> kind_of, const Vec3& eye,
                                 const Vec3& back, bool perspective, const core::ProgressReporter& progress) {
  std::vector<Facet> facets;
  facets.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) facets.push_back(facet_of(mesh, t));

  const std::vector<Side> sides = sorted_sides(mesh, progress);
  mend_thin(mesh, sides, facets);
  progress.check();

  const auto faces_viewer = [&](std::uint32_t t, const Vec3& point) {
    return facets[t].normal.dot(perspective ? Vec3(eye - point) : back) > 0;
  };
  const auto are_of_two_kinds = [&](std::uint32_t one, std::uint32_t other) {
    return !kind_of.empty() && kind_of[one] != kind_of[other];
  };
  const auto strength = [&](std::uint32_t one, std::uint32_t other, const Vec3& point) {
    if (are_of_two_kinds(one, other)) return 1.0;
    if (facets[one].is_thin || facets[other].is_thin) return 0.0;
    const double angle = std::acos(std::clamp(facets[one].normal.dot(facets[other].normal), -1.0, 1.0));
    const double sharpness = std::clamp((angle - kFlat) / (kSharp - kFlat), 0.0, 1.0);
    const bool is_contour = faces_viewer(one, point) != faces_viewer(other, point);
    if (sharpness <= 0) return is_contour ? kFaintest : 0.0;
    return std::max(kFaintest + (1 - kFaintest) * sharpness, is_contour ? 0.8 : 0.0);
  };

  std::vector<Crease> creases;
  for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
    while (next < sides.size() && sides[next].low == sides[i].low && sides[next].high == sides[i].high) ++next;
    const Vec3 &a = mesh.vertices[sides[i].low], &b = mesh.vertices[sides[i].high];
    bool is_border = next - i == 1;  // a hole has a rim
    double most = is_border ? 1 : 0;
    for (std::size_t k = i + 1; k < next; ++k) {
      const std::uint32_t one = sides[i].triangle, other = sides[k].triangle;
      is_border = is_border || are_of_two_kinds(one, other);
      most = std::max(most, strength(one, other, 0.5 * (a + b)));
    }
    if (most > 0) creases.push_back({a, b, most, is_border});
    progress.tick();
  }
  return creases;
}

}  // namespace vantage::internal::picture
