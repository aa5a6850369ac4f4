// The boxes of a scene's triangles, some at a time: to look at those near a place and at no others.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "app/scene_lookups.h"
#include "vantage/geometry.h"

namespace vantage::internal::app {

/// Triangles of a scene follow each other object by object, so that a run of them is in one place.
class TriangleRuns {
 public:
  explicit TriangleRuns(const Mesh& mesh) : count_(mesh.triangles.size()) {
    for (std::size_t i = 0; i < count_; ++i) {
      if (i % kLength == 0) boxes_.emplace_back();
      for (const std::uint32_t vertex : mesh.triangles[i]) boxes_.back().extend(mesh.vertices[vertex]);
    }
    for (const Box& box : boxes_) {
      bounds_.extend(box.min);
      bounds_.extend(box.max);
    }
  }

  /// Of all triangles.
  const Box& bounds() const { return bounds_; }

  /// Calls `visit(index)` for the triangles of runs whose box `is_wanted`, in order, until it returns false.
  template <typename IsWanted, typename Visit>
  void visit(const IsWanted& is_wanted, const Visit& visit) const {
    for (std::size_t run = 0; run < boxes_.size(); ++run) {
      if (!is_wanted(boxes_[run])) continue;
      const std::size_t end = std::min(count_, (run + 1) * kLength);
      for (std::size_t i = run * kLength; i < end; ++i) {
        if (!visit(i)) return;
      }
    }
  }

 private:
  static constexpr std::size_t kLength = 64;  // a box costs about as much to look at as a triangle

  std::size_t count_;
  std::vector<Box> boxes_;
  Box bounds_;
};

inline const TriangleRuns& triangle_runs(const LoadedScene& loaded) {
  return looked_up<TriangleRuns>(loaded, [&] { return std::make_shared<const TriangleRuns>(loaded.scene.mesh); });
}

}  // namespace vantage::internal::app
