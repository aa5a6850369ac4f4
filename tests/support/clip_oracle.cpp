#include "support/clip_oracle.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace vantage::testing {

ClipOracle::ClipOracle(const Mesh& scene, const std::vector<Vec3>& polygon)
    : origin_(polygon[0].cast<long double>()), normal_(Point::Zero()) {
  for (const Vec3& vertex : polygon) polygon_.push_back(vertex.cast<long double>() - origin_);
  for (std::size_t i = 1; i + 1 < polygon_.size(); ++i) normal_ += polygon_[i].cross(polygon_[i + 1]);
  normal_.normalize();
  for (const Triangle& t : scene.triangles) {
    const auto corner = [&](int k) -> Point { return scene.vertices[t[k]].cast<long double>() - origin_; };
    triangles_.push_back({corner(0), corner(1), corner(2)});
  }
}

bool ClipOracle::is_hidden_from(const Vec3& viewpoint, double margin) const {
  const Point apex = viewpoint.cast<long double>() - origin_;
  std::vector<std::pair<Point, long double>> sides{{normal_, margin}};  // inward normal, least height
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    const Point& from = polygon_[i];
    const Point inward = (from - apex).cross(polygon_[(i + 1) % polygon_.size()] - apex).normalized() * -1;
    sides.emplace_back(inward, inward.dot(apex) + margin);
  }
  std::vector<Point> part, cut;
  return std::any_of(triangles_.begin(), triangles_.end(), [&](const std::array<Point, 3>& triangle) {
    part.assign(triangle.begin(), triangle.end());
    for (const auto& [inward, least] : sides) {
      cut.clear();
      for (std::size_t k = 0; k < part.size(); ++k) {
        const Point &from = part[k], &to = part[(k + 1) % part.size()];
        const long double at_from = inward.dot(from) - least, at_to = inward.dot(to) - least;
        if (at_from > 0) cut.push_back(from);
        if ((at_from > 0) != (at_to > 0)) cut.push_back(from + at_from / (at_from - at_to) * (to - from));
      }
      part.swap(cut);
      if (part.empty()) return false;
    }
    return true;
  });
}

}  // namespace vantage::testing
