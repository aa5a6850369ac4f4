// Which way the surface is folded where Delaunay leaves it open: four posts of a raster all but lie on a circle, and
// which of them gets the diagonal is decided by rounding and by the map projection. Here the heights decide it. Each
// flip lifts the surface, so it ends; among points on one circle with the upper side of their convex hull, whatever it
// began with (flips between regular triangulations: Edelsbrunner and Shah, "Incremental topological flipping works for
// regular triangulations", 1996).
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numeric>
#include <vector>

#include "maps/terrain/tin.h"

namespace vantage::internal::terrain {
namespace {

/// By how much the opposite angles of a quadrilateral may miss a half turn when its corners count as on one circle. In
/// a local frame cells in degrees miss it by less than 1e-4 (a tile of SRTM, 80 x 111 km, from an origin 37 km from its
/// middle), cells in a conformal projection by less (1e-7 in Delft). Cells in an equal-area one are sheared, in
/// EPSG:3035 by up to 0.06 between Iceland and Crete, and shall be folded in the same way.
constexpr double kOnCircle_rad = 0.1;
/// The least sine of a corner's angle: thinner ones are not large against kOnCircle_rad.
constexpr double kThinnest = 2 * kOnCircle_rad;
/// Well above rounding (a few 1e-12 m of heights below 10 km), and nothing to see: what a fold must gain, and by how
/// much candidates may exceed their error.
constexpr double kNothing_m = 1e-6;

/// The angle at a corner, from one side to the next, counter-clockwise: argument of a number.
std::complex<double> angle(const Vec3& from, const Vec3& corner, const Vec3& to) {
  const std::complex<double> a(from.x() - corner.x(), from.y() - corner.y()),
      b(to.x() - corner.x(), to.y() - corner.y());
  return b * std::conj(a);
}

/// Whether a quadrilateral, counter-clockwise, is convex and its corners all but lie on a circle.
bool on_circle(const std::array<Vec3, 4>& quad) {
  std::array<std::complex<double>, 4> angles;
  for (std::size_t i = 0; i < 4; ++i) {
    angles[i] = angle(quad[(i + 1) % 4], quad[i], quad[(i + 3) % 4]);
    if (!(angles[i].imag() >= kThinnest * std::abs(angles[i]))) return false;
  }
  return std::abs(std::arg(-angles[0] * angles[2])) <= kOnCircle_rad;
}

/// How much higher the diagonal from corner 0 is than that from corner 1, where they cross.
double gain(const std::array<Vec3, 4>& quad) {
  const auto height = [&](const Vec3& from, const Vec3& to, const Vec3& right, const Vec3& left) {
    const double before = angle(left, right, from).imag(), behind = angle(to, right, left).imag();  // >= 0
    return from.z() + (to.z() - from.z()) * before / (before + behind);
  };
  return height(quad[0], quad[2], quad[1], quad[3]) - height(quad[1], quad[3], quad[2], quad[0]);
}

}  // namespace

/// Lifts the surface over the quadrilateral about a facet's side, if it can.
bool Tin::fold(std::uint32_t facet, std::size_t side, double max_error) {
  Facet &f = facets_[facet], &g = facets_[f.neighbour[side]];
  const std::uint32_t beyond = f.neighbour[side];
  std::size_t back = 0;
  while (g.neighbour[back] != facet) ++back;
  // Counter-clockwise; the common side runs from the second to the fourth.
  const std::array<std::uint32_t, 4> corner = {f.corner[side], f.corner[(side + 1) % 3], g.corner[back],
                                               f.corner[(side + 2) % 3]};
  const std::array<Vec3, 4> quad = {points_[corner[0]], points_[corner[1]], points_[corner[2]], points_[corner[3]]};
  if (!on_circle(quad) || !(gain(quad) > kNothing_m)) return false;

  const std::array<std::array<std::uint32_t, 3>, 2> halves = {
      {{corner[0], corner[1], corner[2]}, {corner[0], corner[2], corner[3]}}};
  const auto half_under = [&](std::uint32_t candidate) -> std::size_t {
    return angle(quad[2], quad[0], points_[candidate]).imag() > 0 ? 1 : 0;
  };
  const std::array<std::uint32_t, 2> chains = {f.candidates, g.candidates}, places = {facet, beyond};
  for (const std::uint32_t chain : chains) {
    for (std::uint32_t c = chain; c != kNone; c = next_[c]) {
      if (error_over(c, halves[half_under(c)]) > max_error + kNothing_m) return false;
    }
  }

  const std::array<std::uint32_t, 4> outside = {f.neighbour[(side + 2) % 3], g.neighbour[(back + 1) % 3],
                                                g.neighbour[(back + 2) % 3], f.neighbour[(side + 1) % 3]};
  f = Facet{halves[0], {outside[1], beyond, outside[0]}, kNone, kNone, -1};
  g = Facet{halves[1], {outside[2], outside[3], facet}, kNone, kNone, -1};
  replace_neighbour(outside[1], beyond, facet);
  replace_neighbour(outside[3], facet, beyond);
  for (std::uint32_t c : chains) {
    while (c != kNone) {
      const std::uint32_t after = next_[c], over = places[half_under(c)];
      give(c, over, error_over(c, facets_[over].corner));
      c = after;
    }
  }
  return true;
}

void Tin::replace_neighbour(std::uint32_t facet, std::uint32_t old, std::uint32_t now) {
  if (facet == kNone) return;
  for (std::uint32_t& neighbour : facets_[facet].neighbour) {
    if (neighbour == old) neighbour = now;
  }
}

void Tin::fold_up(double max_error, const core::ProgressReporter& progress) {
  std::vector<std::uint32_t> open(facets_.size());
  std::iota(open.begin(), open.end(), 0);
  while (!open.empty()) {
    progress.tick();
    const std::uint32_t facet = open.back();
    open.pop_back();
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t beyond = facets_[facet].neighbour[side];
      if (beyond == kNone || !fold(facet, side, max_error)) continue;
      open.insert(open.end(), {facet, beyond});  // their other sides are of other quadrilaterals now
      break;
    }
  }
}

}  // namespace vantage::internal::terrain
