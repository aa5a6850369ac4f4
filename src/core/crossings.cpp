#include "core/crossings.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "core/triangle_contact.h"
#include "core/triangle_tree.h"

namespace vantage::internal::core {

std::vector<std::pair<std::uint32_t, std::uint32_t>> find_crossings(const Mesh& mesh,
                                                                    std::span<const std::uint32_t> among,
                                                                    double distance) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> result;
  if (among.empty()) return result;
  const TriangleTree tree(mesh);
  const auto corners = [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return std::array<Vec3, 3>{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
  };
  const auto shared = [&](std::uint32_t a, std::uint32_t b) {
    int count = 0;
    for (const std::uint32_t v : mesh.triangles[a]) {
      count += static_cast<int>(std::count(mesh.triangles[b].begin(), mesh.triangles[b].end(), v));
    }
    return count;
  };
  std::vector<std::vector<std::uint32_t>> crossed(among.size());
  constexpr std::size_t kGrain = 64;
  parallel::for_ranges(among.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t t = among[i];
      const std::array<Vec3, 3> own = corners(t);
      tree.for_each_along(t, [&](std::uint32_t other) {
        if (other == t) return;
        const int common = shared(t, other);
        if (common < 2 && contact_of(own, corners(other), common, distance) == Contact::crossing) {
          crossed[i].push_back(other);
        }
      });
    }
  });
  for (std::size_t i = 0; i < among.size(); ++i) {
    std::sort(crossed[i].begin(), crossed[i].end());
    for (const std::uint32_t other : crossed[i]) result.emplace_back(among[i], other);
  }
  return result;
}

}  // namespace vantage::internal::core
