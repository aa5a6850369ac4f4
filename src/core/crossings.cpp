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
  if (among.empty()) return {};
  // They are few beside the others, so that the hierarchy is theirs.
  Mesh few{mesh.vertices, {}};
  for (const std::uint32_t t : among) few.triangles.push_back(mesh.triangles[t]);
  const TriangleTree tree(few);
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
  using Pair = std::pair<std::uint32_t, std::uint32_t>;  // the first one by its place in `among`
  constexpr std::size_t kGrain = 1024;
  std::vector<std::vector<Pair>> found(mesh.triangles.size() / kGrain + 1);
  parallel::for_ranges(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin * kGrain; t < std::min(mesh.triangles.size(), end * kGrain); ++t) {
      const auto other = static_cast<std::uint32_t>(t);
      const std::array<Vec3, 3> of_other = corners(other);
      tree.for_each_along(of_other, [&](std::uint32_t i) {
        if (among[i] == other) return;
        const int common = shared(among[i], other);
        if (common < 2 && contact_of(corners(among[i]), of_other, common, distance) == Contact::crossing) {
          found[t / kGrain].emplace_back(i, other);
        }
      });
    }
  });
  std::vector<Pair> pairs;
  for (const std::vector<Pair>& some : found) pairs.insert(pairs.end(), some.begin(), some.end());
  std::sort(pairs.begin(), pairs.end());
  for (Pair& pair : pairs) pair.first = among[pair.first];
  return pairs;
}

}  // namespace vantage::internal::core
