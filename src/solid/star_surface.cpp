#include "solid/star_surface.h"

#include <algorithm>
#include <vector>

#include "solid/convex_body.h"
#include "solid/halve_sides.h"

namespace vantage::internal::solid {

Mesh star_inside(const std::function<double(const Vec3&)>& reach, double share) {
  constexpr double kShortest = 0.02;  // of sides, as seen from the origin
  constexpr std::size_t kMostFacets = 60000;
  SphereMesh sphere = make_sphere_for(share);
  std::vector<Vec3>& directions = sphere.mesh.vertices;
  std::vector<Triangle>& facets = sphere.mesh.triangles;
  std::vector<double> distances;
  for (const Vec3& direction : directions) distances.push_back(reach(direction));

  const auto length = [&](std::uint32_t a, std::uint32_t b) { return (directions[a] - directions[b]).norm(); };
  const auto is_far_in = [&](std::uint32_t a, std::uint32_t b) {
    if (length(a, b) < kShortest) return false;
    const Vec3 middle = (distances[a] * directions[a] + distances[b] * directions[b]) / 2;
    const double distance = middle.norm();
    return distance < (1 - share) * reach(middle / distance);
  };
  std::size_t looked_at = 0;  // a facet without a new vertex was looked at before
  const auto wants = [&](const Triangle& t) {
    if (std::max({t[0], t[1], t[2]}) < looked_at) return false;
    return is_far_in(t[0], t[1]) || is_far_in(t[1], t[2]) || is_far_in(t[2], t[0]);
  };
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    directions.push_back((directions[a] + directions[b]).normalized());
    return static_cast<std::uint32_t>(directions.size() - 1);
  };
  std::vector<std::uint32_t> of_facet;
  for (bool is_halved = true; is_halved && facets.size() < kMostFacets;) {
    const std::size_t before = directions.size();
    is_halved = halve_sides(facets, wants, length, middle, of_facet);
    looked_at = before;
    while (distances.size() < directions.size()) distances.push_back(reach(directions[distances.size()]));
  }
  for (std::size_t i = 0; i < directions.size(); ++i) directions[i] *= distances[i];
  return std::move(sphere.mesh);
}

}  // namespace vantage::internal::solid
