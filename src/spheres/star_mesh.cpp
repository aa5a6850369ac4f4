#include "spheres/star_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "spheres/numerics.h"

namespace vantage::internal::spheres {
namespace {

constexpr std::size_t kGrain = 1 << 13;
constexpr std::uint32_t kUnused = ~0u;

/// Vertices about the viewpoint, in the axes of the mesh. What counts as in the plane of a front half is put there.
std::vector<Vec3> turned(const StarMesh& star, const Placement& placement) {
  std::vector<Vec3> vertices(star.rays.size());
  const bool is_turned = placement.to_mesh != Eigen::Matrix3d::Identity();
  parallel::for_ranges(vertices.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 v = is_turned ? Vec3(placement.to_mesh * star.rays[i]) : star.rays[i];
      if (placement.front_only && std::abs(v.z()) <= numerics::kInPlane * star.rays[i].lpNorm<Eigen::Infinity>())
        v.z() = 0;
      vertices[i] = v;
    }
  });
  return vertices;
}

std::uint32_t label_of(const StarMesh& star, const Triangle& t) {
  return star.at_range[t[0]] && star.at_range[t[1]] && star.at_range[t[2]] ? kRange : kScene;
}

/// Cuts a star-shaped mesh by the plane z = 0 through its centre, and keeps what is above.
class FrontHalf {
 public:
  FrontHalf(const StarMesh& star, std::vector<Vec3> vertices) : star_(star), vertices_(std::move(vertices)) {}

  solid::LabelledMesh cut() {
    find_crossings();
    out_.mesh.triangles.reserve(star_.triangles.size() / 2 + 4 * crossings_.size() + 1);
    out_.labels.reserve(out_.mesh.triangles.capacity());
    const auto base = static_cast<std::uint32_t>(vertices_.size());
    centre_ = base + static_cast<std::uint32_t>(crossings_.size());
    for (const Triangle& t : star_.triangles) add(t);
    compact();
    return std::move(out_);
  }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;  // lower index first

  double height(std::uint32_t v) const { return vertices_[v].z(); }

  void find_crossings() {
    for (const Triangle& t : star_.triangles) {
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        if (a < b && height(a) * height(b) < 0) crossings_.emplace_back(a, b);
      }
    }
    std::sort(crossings_.begin(), crossings_.end());
  }

  std::uint32_t crossing(std::uint32_t a, std::uint32_t b) const {
    const Edge edge = std::minmax(a, b);
    const auto at = std::lower_bound(crossings_.begin(), crossings_.end(), edge);
    return static_cast<std::uint32_t>(vertices_.size()) + static_cast<std::uint32_t>(at - crossings_.begin());
  }

  void add(const Triangle& t) {
    const int above = (height(t[0]) > 0) + (height(t[1]) > 0) + (height(t[2]) > 0);
    if (above == 0) return;
    const std::uint32_t label = label_of(star_, t);
    const int below = (height(t[0]) < 0) + (height(t[1]) < 0) + (height(t[2]) < 0);
    if (below == 0) {
      put(t, label);
      for (int i = 0; i < 3; ++i)
        if (height(t[i]) == 0 && height(t[(i + 1) % 3]) == 0) close(t[i], t[(i + 1) % 3]);
      return;
    }
    // What is above the plane is a triangle or a quadrilateral; two of its corners are on the plane, one after the
    // other.
    std::array<std::uint32_t, 4> corner{};
    std::array<bool, 4> on_plane{};
    int count = 0;
    const auto take = [&](std::uint32_t v, bool on) {
      corner[count] = v;
      on_plane[count++] = on;
    };
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (height(a) >= 0) take(a, height(a) == 0);
      if (height(a) * height(b) < 0) take(crossing(a, b), true);
    }
    put({corner[0], corner[1], corner[2]}, label);
    if (count == 4) put({corner[0], corner[2], corner[3]}, label);
    for (int i = 0; i < count; ++i) {
      const int next = (i + 1) % count;
      if (on_plane[i] && on_plane[next]) close(corner[i], corner[next]);
    }
  }

  void put(const Triangle& t, std::uint32_t label) {
    out_.mesh.triangles.push_back(t);
    out_.labels.push_back(label);
  }

  // A facet above the plane runs along it from a to b: the disc's triangle runs back.
  void close(std::uint32_t a, std::uint32_t b) { put({b, a, centre_}, kTargetPlane); }

  Vec3 position(std::uint32_t v) const {
    if (v < vertices_.size()) return vertices_[v];
    if (v == centre_) return Vec3::Zero();
    const auto [a, b] = crossings_[v - vertices_.size()];
    const double share = height(a) / (height(a) - height(b));
    Vec3 p = vertices_[a] + share * (vertices_[b] - vertices_[a]);
    p.z() = 0;
    return p;
  }

  void compact() {
    std::vector<std::uint32_t> index(centre_ + 1, kUnused);
    for (const Triangle& t : out_.mesh.triangles)
      for (const std::uint32_t v : t) index[v] = 0;
    for (std::uint32_t v = 0; v < index.size(); ++v) {
      if (index[v] == kUnused) continue;
      index[v] = static_cast<std::uint32_t>(out_.mesh.vertices.size());
      out_.mesh.vertices.push_back(position(v));
    }
    for (Triangle& t : out_.mesh.triangles)
      for (std::uint32_t& v : t) v = index[v];
  }

  const StarMesh& star_;
  std::vector<Vec3> vertices_;
  std::vector<Edge> crossings_;
  std::uint32_t centre_ = 0;
  solid::LabelledMesh out_;
};

}  // namespace

solid::LabelledMesh placed(const StarMesh& star, const Placement& placement) {
  solid::LabelledMesh result;
  std::vector<Vec3> vertices = turned(star, placement);
  if (placement.front_only) {
    result = FrontHalf(star, std::move(vertices)).cut();
  } else {
    result.mesh.vertices = std::move(vertices);
    result.mesh.triangles = star.triangles;
    result.labels.resize(star.triangles.size());
    for (std::size_t i = 0; i < star.triangles.size(); ++i) result.labels[i] = label_of(star, star.triangles[i]);
  }
  for (Vec3& v : result.mesh.vertices) v += placement.viewpoint;
  return result;
}

double reach(const StarMesh& star, const Placement& placement) {
  const Vec3 up = placement.to_mesh.row(2);
  double farthest = 0;
  for (const Vec3& ray : star.rays) farthest = std::max(farthest, placement.front_only ? up.dot(ray) : ray.norm());
  return farthest;
}

}  // namespace vantage::internal::spheres
