// Whether meshes pass through each other, decided exactly and slowly: sums of products of doubles without rounding.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::testing {

/// A number as a sum of doubles, without any rounding.
class ExactSum {
 public:
  /// Knuth's sum, term by term: what is left over becomes another part.
  void add(double term) {
    std::vector<double> parts;
    for (const double part : parts_) {
      const double sum = term + part, moved = sum - term;
      const double rest = (term - (sum - moved)) + (part - moved);
      if (rest != 0) parts.push_back(rest);
      term = sum;
    }
    if (term != 0) parts.push_back(term);
    parts_ = parts;
  }
  ExactSum times(double by) const {
    ExactSum result;
    for (const double part : parts_) {
      const double product = part * by;
      result.add(std::fma(part, by, -product));
      result.add(product);
    }
    return result;
  }
  void add(const ExactSum& other, double sign) {
    for (const double part : other.parts_) add(sign * part);
  }
  int sign() const { return parts_.empty() ? 0 : parts_.back() > 0 ? 1 : -1; }

 private:
  std::vector<double> parts_;  // from the smallest; they do not overlap, so the last one has the sign
};

/// 1 where d lies on the side of the plane abc from which a, b, c run clockwise, -1 on the other, 0 in it. From the
/// determinants of the coordinates themselves, not of differences.
inline int exact_side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double rough = (b - a).cross(c - a).dot(a - d);
  const double size =
      std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff(), d.cwiseAbs().maxCoeff()});
  if (std::abs(rough) > 1e-13 * size * size * size) return rough > 0 ? 1 : -1;
  ExactSum sum;
  const auto add = [&](const Vec3& p, const Vec3& q, const Vec3& r, double sign) {
    for (int x = 0; x < 3; ++x) {
      const int y = (x + 1) % 3, z = (x + 2) % 3;
      ExactSum first, second;
      first.add(p[x]);
      second.add(p[x]);
      sum.add(first.times(q[y]).times(r[z]), sign);
      sum.add(second.times(q[z]).times(r[y]), -sign);
    }
  };
  // det(a, b, c) - det(b, c, d) + det(c, d, a) - det(d, a, b): six times the volume.
  add(a, b, c, 1);
  add(b, c, d, -1);
  add(c, d, a, 1);
  add(d, a, b, -1);
  return sum.sign();
}

/// How many edges of one mesh pass through the inside of a triangle of the other, both closed: those of `edges` through
/// `faces`.
inline std::size_t edges_through(const Mesh& edges, const Mesh& faces) {
  std::size_t count = 0;
  std::vector<Box> boxes;
  for (const Triangle& t : faces.triangles) {
    Box& box = boxes.emplace_back();
    for (const std::uint32_t v : t) box.extend(faces.vertices[v]);
  }
  for (const Triangle& edge_of : edges.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &s = edges.vertices[edge_of[k]], &e = edges.vertices[edge_of[(k + 1) % 3]];
      if (std::lexicographical_compare(e.data(), e.data() + 3, s.data(), s.data() + 3)) continue;  // of the other facet
      Box box;
      box.extend(s);
      box.extend(e);
      for (std::size_t f = 0; f < boxes.size(); ++f) {
        if ((box.min.array() > boxes[f].max.array()).any() || (box.max.array() < boxes[f].min.array()).any()) continue;
        const auto& [i, j, l] = faces.triangles[f];
        const Vec3 &a = faces.vertices[i], &b = faces.vertices[j], &c = faces.vertices[l];
        if (exact_side(a, b, c, s) * exact_side(a, b, c, e) >= 0) continue;
        const int turn = exact_side(s, e, a, b);
        if (turn != 0 && exact_side(s, e, b, c) == turn && exact_side(s, e, c, a) == turn) ++count;
      }
    }
  }
  return count;
}

}  // namespace vantage::testing
